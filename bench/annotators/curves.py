#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How fast simulated annotators come to the truth, way by way: a table and a plot of what kontur_annotators printed.

Usage: bench/annotators/curves.py PLOT.svg STATES.jsonl... [--hand exact] [--ways "suggestion" "axial" ...]

Only structures that were drawn in all of these ways count. A Dice that is not reached in 13 planes counts as reached with 14. A way
that ended early, having come above the highest target twice, keeps its last Dice. `accepted`: the annotator takes over the predicted
outline where it is right, and redraws what is off by more than 1 % of the diameter.
"""
import argparse
import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from agreement import svg_of  # noqa: E402
from growth import line, text  # noqa: E402

TARGETS, MOST = (0.95, 0.98), 13
COLOURS = {"suggestion": "#1b6ca8", "suggested slices": "#56b4e9", "axial": "#c4552d", "axial, re-spaced": "#e69f00",
           "orthogonal": "#4a8f3c", "random oblique": "#777777", "MITK's rule": "#cc79a7", "rule, then random": "#000000",
           "suggestion, image": "#0b3a5b"}
TICKS, WIDTH, HEIGHT, LEFT, TOP, ACROSS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5), 250, 180, 46, 30, 310


def read(paths, hand):
    """{structure: {way: states in the order of planes}}"""
    found = {}
    for path in paths:
        for row in map(json.loads, path.read_text(encoding="utf-8").splitlines()):
            if row["hand"] == hand:
                found.setdefault(row["structure"], {}).setdefault(row["way"], []).append(row)
    return found


def planes_to(states, target):
    return next((s["planes"] for s in states if s["dice"] >= target), MOST + 1)


def seconds_to(states, target, kind):
    return next((s[kind] for s in states if s["dice"] >= target), None)


def missed_after(states, planes):
    """1 - Dice; a way that ended keeps its last."""
    return 1 - next((s["dice"] for s in reversed(states) if s["planes"] <= planes), 0)


def missed_at(states, seconds, kind):
    return 1 - next((s["dice"] for s in reversed(states) if s[kind] <= seconds), 0)


def geometric_mean(values):
    return math.exp(sum(math.log(max(v, 1e-4)) for v in values) / len(values))


def mean(values):
    return sum(values) / len(values)


def rows_of(structures, ways):
    header = ["way", *(f"planes to {t}" for t in TARGETS), *(f"not reached, {t}" for t in TARGETS), "1 - Dice at 4", "at 6", "at 9",
              "s to 0.95", "accepted"]
    rows = []
    for way in ways:
        own = [s[way] for s in structures.values()]
        row = [way]
        row += [f"{mean([planes_to(s, t) for s in own]):.2f}" for t in TARGETS]
        row += [str(sum(planes_to(s, t) > MOST for s in own)) for t in TARGETS]
        row += [f"{geometric_mean([missed_after(s, n) for s in own]):.3f}" for n in (4, 6, 9)]
        for kind in ("drawing_s", "accepting_s"):
            reached = [seconds_to(s, 0.95, kind) or s[-1][kind] for s in own]
            row.append(f"{mean(reached):.0f}")
        rows.append(row)
    return header, rows


def markdown(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|---" * len(header) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def panel(left, title, structures, ways, last, ticks, missed):
    low, high = math.log(TICKS[0]), math.log(TICKS[-1])

    def place(at, value):
        up = (high - min(max(math.log(max(value, 1e-6)), low), high)) / (high - low)
        return left + WIDTH * at / last, TOP + HEIGHT * up

    parts = [text(left + WIDTH / 2, TOP - 10, title, size=12)]
    for tick in TICKS:
        y = place(0, tick)[1]
        parts += [line(left, y, left + WIDTH, y, "#ddd"), text(left - 5, y + 4, f"{tick:g}", "end", 10)]
    for tick in ticks:
        x = place(tick, 1)[0]
        parts += [line(x, TOP, x, TOP + HEIGHT, "#eee"), text(x, TOP + HEIGHT + 14, tick, size=10)]
    for way in ways:
        steps = [last * k / 60 for k in range(1, 61)] if last > MOST else range(1, last + 1)
        points = [place(at, geometric_mean([missed(s[way], at, way) for s in structures.values()])) for at in steps]
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        parts.append(f'<polyline points="{path}" fill="none" stroke="{COLOURS[way]}" stroke-width="2"/>')
    return parts


def plot(structures, ways):
    by_planes = panel(LEFT, "1 - Dice by planes drawn", structures, ways, MOST, (1, 4, 7, 10, 13), lambda s, at, way: missed_after(s, at))

    def at_seconds(states, at, way):
        return missed_at(states, at, "accepting_s" if way.startswith("sugg") else "drawing_s")

    by_seconds = panel(LEFT + ACROSS, "1 - Dice by seconds (model)", structures, ways, 240, (60, 120, 180, 240), at_seconds)
    bottom, parts = TOP + HEIGHT + 40, by_planes + by_seconds
    for n, way in enumerate(ways):
        x, y = LEFT + 150 * (n % 4), bottom + 18 * (n // 4)
        parts += [line(x, y - 4, x + 22, y - 4, COLOURS[way], 'stroke-width="2"'), text(x + 27, y, way, "start")]
    return svg_of(LEFT + ACROSS + WIDTH + 20, bottom + 18 * ((len(ways) - 1) // 4) + 12, parts)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("plot", type=pathlib.Path)
    parser.add_argument("states", nargs="+", type=pathlib.Path)
    parser.add_argument("--hand", default="exact", choices=("exact", "unsteady"))
    parser.add_argument("--ways", nargs="+", default=list(COLOURS), choices=list(COLOURS))
    options = parser.parse_args()
    structures = {name: ways for name, ways in read(options.states, options.hand).items() if set(options.ways) <= set(ways)}
    if not structures:
        sys.exit("curves.py: error: no structure was drawn in all of these ways")
    options.plot.write_text(plot(structures, options.ways), encoding="utf-8")
    print(f"{len(structures)} structures, {options.hand} hand\n")
    print(markdown(*rows_of(structures, options.ways)))
    saved = {t: 1 - mean([planes_to(s[options.ways[0]], t) for s in structures.values()]) /
             mean([planes_to(s["axial"], t) for s in structures.values()]) for t in TARGETS} if "axial" in options.ways else {}
    for target, share in saved.items():
        print(f"\n{options.ways[0]} to {target}: {100 * share:.1f} % fewer planes than axial")


if __name__ == "__main__":
    main()
