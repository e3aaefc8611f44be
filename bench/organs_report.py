#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tables and plots of what organs.py measured. Means are over drawings; `behind` counts losses of more than 0.002 of Dice.

Usage: bench/organs_report.py results.csv FOLDER [DOCUMENT.md]...: plots into FOLDER, and tables.md or, with a document, its tables
between the markers that tables.md has.
"""
import csv
import pathlib
import statistics
import sys

from plots import BLUE, GREEN, METHOD_COLOURS, RED, VIOLET, plain_ticks, pyplot, save
from tables import filled, table
from versus import BEHIND

GROUPS = ("compact", "elongated", "thin or branched")  # shape_groups.py
HANDS = ("exact", "wave", "jitter", "coarse")
HAND_COLOURS = dict(zip(HANDS, (BLUE, RED, GREEN, VIOLET)))
PEERS = ("nearest slice", "shape-based", "plain")
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


TABLES = {"organs planes": planes_table, "organs hands": hands_table, "organs slices": slices_table,
          "organs worst": worst_table}


def gains_panel(axes, entries, title):
    """Boxes from the lower to the upper quartile of kontur's gain, lines from the 5th to the 95th percentile."""
    drawings = sorted({entry["drawing"] for entry in entries})
    for k, hand in enumerate(HANDS):
        gained = [gains([entry for entry in entries if (entry["drawing"], entry["hand"]) == (drawing, hand)]) for drawing in drawings]
        axes.boxplot(gained, positions=[n + 0.18 * (k - 1.5) for n in range(len(drawings))], widths=0.13, whis=(5, 95), showfliers=False,
                     showcaps=False, patch_artist=True, manage_ticks=False, medianprops={"color": "white"},
                     boxprops={"color": HAND_COLOURS[hand], "facecolor": HAND_COLOURS[hand]},
                     whiskerprops={"color": HAND_COLOURS[hand]})
    axes.axhline(0, color="#888888", linewidth=0.8)
    axes.set(title=title, ylim=(-0.05, 0.05), xlim=(-0.5, len(drawings) - 0.5))
    axes.set_xticks(range(len(drawings)), drawings)
    axes.grid(axis="x", visible=False)


def gains_plot(entries, path):
    sets = {group: own for group, own in sets_of(entries).items() if group in GROUPS}
    figure, panels = pyplot.subplots(len(sets), 1, figsize=(6.2, 2.2 * len(sets) + 0.8), squeeze=False)
    for axes, (group, own) in zip(panels[:, 0], sets.items()):
        gains_panel(axes, own, f"{group}: Dice of kontur less that of the plain method")
    for hand in HANDS:
        panels[-1, 0].plot([], [], "s", color=HAND_COLOURS[hand], markersize=7, label=hand)
    save(figure, path, legend_of=panels[-1, 0])


def slices_panel(axes, steps, what, title):
    """What is missed, by how many slices were kept; `steps` are (step, entries)."""
    for method in (*PEERS, "kontur"):
        missed = [1 - mean(own, method, what) for _, own in steps]
        axes.semilogy([f"1 in {step}" for step, _ in steps], missed, "o-", color=METHOD_COLOURS[method], label=method)
    axes.set(title=title, ylim=(0.02, 0.5))
    plain_ticks(axes.yaxis, (0.02, 0.05, 0.1, 0.2, 0.5))


def slices_plot(entries, path):
    """Above all slices, below those left out between kept ones."""
    groups = list(dict.fromkeys(group for group, _, _ in slice_sets(entries)))
    figure, panels = pyplot.subplots(2, len(groups), figsize=(2.6 * len(groups), 5), squeeze=False)
    for row, (what, title) in zip(panels, (("dice", "1 - Dice"), ("dice_left_out", "1 - Dice, left out"))):
        for axes, group in zip(row, groups):
            slices_panel(axes, [(step, own) for name, step, own in slice_sets(entries) if name == group], what, f"{group}: {title}")
    save(figure, path, legend_of=panels[1][0])


PLOTS = {"organs_gains.svg": gains_plot, "organs_slices.svg": slices_plot}


def write(results, folder, documents=()):
    """tables.md and the plots in `folder`; with documents the tables in these, instead of tables.md."""
    entries = read(results)
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in PLOTS.items():
        make(entries, folder / name)
    if not documents:
        (folder / "tables.md").write_text(filled("".join(f"<!-- begin {name} --><!-- end {name} -->\n" for name in TABLES), entries, TABLES), encoding="utf-8")
    for document in documents:
        document.write_text(filled(document.read_text(encoding="utf-8"), entries, TABLES), encoding="utf-8")


if __name__ == "__main__":
    write(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), [pathlib.Path(document) for document in sys.argv[3:]])
