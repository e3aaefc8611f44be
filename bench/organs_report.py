#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tables and plots of what organs.py measured. Means are over drawings; `behind` counts losses of more than 0.002 of Dice.

Usage: bench/organs_report.py results.csv FOLDER [DOCUMENT.md]...: tables.md and plots into FOLDER; a document's tables, between
the markers that tables.md has, are replaced.
"""
import csv
import math
import pathlib
import statistics
import sys

from agreement import svg_of
from growth import line, text
from tables import table
from versus import BEHIND

GROUPS = ("compact", "elongated", "thin or branched")  # shape_groups.py
HANDS = ("exact", "wave", "jitter", "coarse")
HAND_COLOURS = dict(zip(HANDS, ("#1b6ca8", "#c4552d", "#4a8f3c", "#8a5fb0")))
PEERS = ("nearest slice", "shape-based", "plain")
METHOD_COLOURS = {"nearest slice": "#999", "shape-based": "#c4552d", "plain": "#4a8f3c", "kontur": "#1b6ca8", "paper": "#8a5fb0"}
WORST = 6


def read(path):
    """One entry for each drawing: its structure, group, drawing and hand, and for each method what was measured."""
    found = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            key = {name: row[name] for name in ("structure", "group", "drawing", "hand")}
            entry = found.setdefault(tuple(key.values()), key | {"by": {}})
            entry["by"][row["method"]] = {name: float(row[name] or "nan") for name in ("dice", "dice_left_out", "hausdorff95_mm", "mean_mm")}
    return list(found.values())


def is_slices(entry):
    return entry["drawing"].startswith("slices")


def mean(entries, method, what="dice"):
    return statistics.fmean(entry["by"][method][what] for entry in entries)


def gains(entries, peer="plain"):
    return [entry["by"]["kontur"]["dice"] - entry["by"][peer]["dice"] for entry in entries]


def versus_cells(entries):
    gained = gains(entries)
    return [len(entries), f"{mean(entries, 'plain'):.4f}", f"{mean(entries, 'kontur'):.4f}",
            f"{sum(gain > 0 for gain in gained) / len(gained):.0%}", f"{sum(gain < -BEHIND for gain in gained) / len(gained):.0%}",
            f"{min(gained):+.3f}"]


VERSUS = ["drawings", "plain: Dice", "kontur: Dice", "ahead", "behind", "worst"]


def sets_of(entries):
    """{name: entries} of drawings on planes: by set of planes, then by shape; sets without drawings are left out."""
    on_planes = [entry for entry in entries if not is_slices(entry)]
    sets = {drawing: [entry for entry in on_planes if entry["drawing"] == drawing] for drawing in sorted({e["drawing"] for e in on_planes})}
    sets |= {group: [entry for entry in on_planes if entry["group"] == group] for group in GROUPS}
    return {name: own for name, own in sets.items() if own}


def planes_table(entries):
    """All drawings by an exact hand."""
    rows = [[name, *versus_cells([entry for entry in own if entry["hand"] == "exact"])] for name, own in sets_of(entries).items()]
    return table(["planes or shape", *VERSUS], rows)


def hands_table(entries):
    """Of the structures that hands drew: mean Dice of the plain method and of kontur, hand by hand."""
    by_hands = {entry["structure"] for entry in entries if entry["hand"] != "exact"}
    rows = []
    for name, own in sets_of([entry for entry in entries if entry["structure"] in by_hands]).items():
        drawn = [[entry for entry in own if entry["hand"] == hand] for hand in HANDS]
        rows.append([name, len(drawn[0]), *(f"{mean(some, 'plain'):.4f}, {mean(some, 'kontur'):.4f}" for some in drawn)])
    return table(["planes or shape", "drawings", *HANDS], rows)


def slice_sets(entries):
    """(group, step, entries), the real drawings last."""
    for group in (*GROUPS, "real drawing"):
        for step in (2, 4, 8):
            own = [entry for entry in entries if (entry["group"], entry["drawing"]) == (group, f"slices{step}")]
            if own:
                yield group, step, own


def slices_table(entries):
    """Mean Dice over all slices, and over those left out between kept ones."""
    methods = ["shape-based", "plain", "kontur"]
    rows = [[group, step, len(own), *(f"{mean(own, method):.4f}, {mean(own, method, 'dice_left_out'):.4f}" for method in methods)]
            for group, step, own in slice_sets(entries)]
    return table(["structures", "kept: one in", "drawings", *methods], rows)


def best_peer(entry):
    return max((method for method in entry["by"] if method in PEERS), key=lambda method: entry["by"][method]["dice"])


def worst_table(entries):
    rows = []
    for entry in sorted(entries, key=lambda entry: gains([entry], best_peer(entry))[0])[:WORST]:
        peer = best_peer(entry)
        rows.append([entry["structure"], entry["group"], f"{entry['drawing']}, {entry['hand']}", peer,
                     f"{entry['by'][peer]['dice']:.3f}", f"{entry['by']['kontur']['dice']:.3f}"])
    return table(["structure", "shape", "drawing", "best peer", "its Dice", "kontur"], rows)


TABLES = {"planes": planes_table, "hands": hands_table, "slices": slices_table, "worst": worst_table}


def quantile(values, share):
    ordered = sorted(values)
    at = share * (len(ordered) - 1)
    low = math.floor(at)
    return ordered[low] + (at - low) * (ordered[min(low + 1, len(ordered) - 1)] - ordered[low])


def gains_panel(left, top, width, height, entries, title):
    """Boxes from the lower to the upper quartile of kontur's gain, lines from the 5th to the 95th percentile."""
    limit = 0.05

    def y(gain):
        return top + height / 2 * (1 - max(-1.0, min(1.0, gain / limit)))

    parts = [text(left + width / 2, top - 8, title, size=12)]
    for tick in (-0.04, -0.02, 0, 0.02, 0.04):
        parts += [line(left, y(tick), left + width, y(tick), "#888" if tick == 0 else "#ddd"),
                  text(left - 5, y(tick) + 4, f"{tick:+.2f}" if tick else "0", "end", 10)]
    drawings = sorted({entry["drawing"] for entry in entries})
    for n, drawing in enumerate(drawings):
        middle = left + width * (n + 0.5) / len(drawings)
        parts.append(text(middle, top + height + 14, drawing, size=10))
        for k, hand in enumerate(HANDS):
            gained = gains([entry for entry in entries if (entry["drawing"], entry["hand"]) == (drawing, hand)])
            if not gained:
                continue
            x = middle + 13 * (k - 1.5)
            low, first, centre, third, high = (y(quantile(gained, share)) for share in (0.05, 0.25, 0.5, 0.75, 0.95))
            colour = HAND_COLOURS[hand]
            parts += [line(x, low, x, high, colour), line(x - 5, centre, x + 5, centre, "white", 'stroke-width="2"')]
            parts.insert(-1, f'<rect x="{x - 5:.1f}" y="{third:.1f}" width="10" height="{max(first - third, 0.5):.1f}" fill="{colour}"/>')
    return parts


def gains_svg(entries):
    width, height, left, top = 500, 150, 56, 34
    parts = []
    for n, group in enumerate(GROUPS):
        own = [entry for entry in entries if entry["group"] == group and not is_slices(entry)]
        if own:
            parts += gains_panel(left, top + n * (height + 58), width, height, own, f"{group}: Dice of kontur less that of the plain method")
    bottom = top + len(GROUPS) * (height + 58)
    for k, hand in enumerate(HANDS):
        parts += [f'<rect x="{left + 110 * k}" y="{bottom - 16}" width="10" height="10" fill="{HAND_COLOURS[hand]}"/>',
                  text(left + 16 + 110 * k, bottom - 7, hand, "start")]
    return svg_of(left + width + 14, bottom + 8, parts)


MISSED_TICKS = (0.02, 0.05, 0.1, 0.2, 0.5)


def slices_panel(left, top, width, height, steps, what, title):
    """What is missed, by how many slices were kept; `steps` are (step, entries)."""
    low, high = math.log(MISSED_TICKS[0]), math.log(MISSED_TICKS[-1])

    def y(missed):
        return top + height * (high - max(low, min(high, math.log(max(missed, 1e-9))))) / (high - low)

    parts = [text(left + width / 2, top - 10, title, size=12)]
    for tick in MISSED_TICKS:
        parts += [line(left, y(tick), left + width, y(tick), "#ddd"), text(left - 5, y(tick) + 4, f"{tick:g}", "end", 10)]
    places = [left + width * (k + 0.5) / len(steps) for k in range(len(steps))]
    parts += [text(x, top + height + 15, f"1 in {step}", size=10) for x, (step, _) in zip(places, steps)]
    for method in (*PEERS, "kontur"):
        points = [(x, y(1 - mean(own, method, what))) for x, (_, own) in zip(places, steps)]
        path = " ".join(f"{px:.1f},{py:.1f}" for px, py in points)
        colour = METHOD_COLOURS[method]
        parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2"/>')
        parts += [f'<circle cx="{px:.1f}" cy="{py:.1f}" r="2.5" fill="{colour}"/>' for px, py in points]
    return parts


def slices_svg(entries):
    """Above all slices, below those left out between kept ones."""
    width, height, left, top, across, down = 170, 150, 50, 34, 232, 212
    groups = list(dict.fromkeys(group for group, _, _ in slice_sets(entries)))
    parts = []
    for n, group in enumerate(groups):
        steps = [(step, own) for name, step, own in slice_sets(entries) if name == group]
        for k, (what, title) in enumerate((("dice", "1 - Dice"), ("dice_left_out", "1 - Dice, left out"))):
            parts += slices_panel(left + n * across, top + k * down, width, height, steps, what, f"{group}: {title}")
    bottom = top + down + height + 44
    for k, method in enumerate((*PEERS, "kontur")):
        parts += [line(left + 120 * k, bottom - 4, left + 120 * k + 24, bottom - 4, METHOD_COLOURS[method], 'stroke-width="2"'),
                  text(left + 120 * k + 30, bottom, method, "start")]
    return svg_of(left + across * len(groups), bottom + 12, parts)


def marked(name, made):
    return f"<!-- begin organs {name} -->\n{made}\n<!-- end organs {name} -->\n"


def filled(document, entries):
    """A document with each table that it has markers for in its place."""
    for name, make in TABLES.items():
        head, begin, rest = document.partition(f"<!-- begin organs {name} -->\n")
        if begin:
            document = head + marked(name, make(entries)) + rest.split(f"<!-- end organs {name} -->\n", 1)[1]
    return document


def write(results, folder, documents=()):
    """tables.md and the plots in `folder`; and the tables in documents."""
    entries = read(results)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "tables.md").write_text("\n".join(marked(name, make(entries)) for name, make in TABLES.items()), encoding="utf-8")
    (folder / "organs_gains.svg").write_text(gains_svg(entries), encoding="utf-8")
    (folder / "organs_slices.svg").write_text(slices_svg(entries), encoding="utf-8")
    for document in documents:
        document.write_text(filled(document.read_text(encoding="utf-8"), entries), encoding="utf-8")


if __name__ == "__main__":
    write(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), [pathlib.Path(document) for document in sys.argv[3:]])
