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
from plots import plain_ticks, pyplot, save  # noqa: E402
from tables import table  # noqa: E402

TARGETS, MOST = (0.95, 0.98), 13
COLOURS = {"suggestion": "#1b6ca8", "suggested slices": "#56b4e9", "axial": "#c4552d", "axial, re-spaced": "#e69f00",
           "orthogonal": "#4a8f3c", "random oblique": "#777777", "MITK's rule": "#cc79a7", "rule, then random": "#000000",
           "suggestion, image": "#0b3a5b"}
TICKS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5)
LONGEST = 240  # s in the plot


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


def panel(axes, title, structures, ways, steps, missed):
    for way in ways:
        values = [geometric_mean([missed(s[way], at, way) for s in structures.values()]) for at in steps]
        axes.semilogy(steps, values, color=COLOURS[way], label=way)
    axes.set(title=title, ylim=(TICKS[0], TICKS[-1]))
    plain_ticks(axes.yaxis, TICKS)


def at_seconds(states, at, way):
    return missed_at(states, at, "accepting_s" if way.startswith("sugg") else "drawing_s")


def plot(structures, ways, path):
    figure, (by_planes, by_seconds) = pyplot.subplots(1, 2, figsize=(7.6, 3.4))
    panel(by_planes, "1 - Dice by planes drawn", structures, ways, range(1, MOST + 1), lambda s, at, way: missed_after(s, at))
    by_planes.set_xticks((1, 4, 7, 10, 13))
    panel(by_seconds, "1 - Dice by seconds (model)", structures, ways, [LONGEST * k / 60 for k in range(1, 61)], at_seconds)
    save(figure, path, legend_of=by_planes)


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
    plot(structures, options.ways, options.plot)
    print(f"{len(structures)} structures, {options.hand} hand\n")
    print(table(*rows_of(structures, options.ways)))
    saved = {t: 1 - mean([planes_to(s[options.ways[0]], t) for s in structures.values()]) /
             mean([planes_to(s["axial"], t) for s in structures.values()]) for t in TARGETS} if "axial" in options.ways else {}
    for target, share in saved.items():
        print(f"\n{options.ways[0]} to {target}: {100 * share:.1f} % fewer planes than axial")


if __name__ == "__main__":
    main()
