#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A plot and a table of how solving grows, from `kontur_bench --growth`.

Usage: bench/growth.py RESULTS.json PLOT.svg [DOCUMENT.md]. The table is printed or, with a document, replaces what stands
between its markers <!-- begin growth --> and <!-- end growth --> there.
"""
import json
import math
import pathlib
import sys

import tables
from plots import BLUE, GREY, RED, pyplot, save

COLOURS = {"parallel": BLUE, "orthogonal, by hand": RED}
STAGE_COLOURS = ["#4c78a8", "#9ecae9", "#f58518", "#ffbf79", "#54a24b", "#b279a2", "#bab0ac"]
STAGES = ["neighbours", "factors", "matrix", "products", "preconditioning", "check", "other"]


def stage_seconds(row):
    """Seconds by stage; what no stage accounts for is "other"."""
    known = {name: row["stages_of_last_run"].get(name, 0) for name in STAGES[:-1]}
    return known | {"other": max(0, row["seconds"] - sum(known.values()))}


def time_and_memory(time, memory, rows):
    """Each set of drawings in its colour; dashed what its products would take at the rate of the fastest cache."""
    for drawn, colour in COLOURS.items():
        found = [row for row in rows if row["drawn"] == drawn]
        sizes = [row["n"] for row in found]
        time.loglog(sizes, [row["seconds"] for row in found], "o-", color=colour, label=drawn)
        time.loglog(sizes, [row["products_at_peak_s"] for row in found], "--", color=colour)
        memory.loglog(sizes, [max(row["added_mb"], 1) for row in found], "o-", color=colour)
    time.plot([], [], "--", color=GREY, label="its products at peak rate")
    time.set(title="time to solve, s", xlabel="constraints")
    memory.set(title="memory added, MB", xlabel="constraints")
    for axes in (time, memory):
        axes.minorticks_off()
    time.legend()


def stage_shares(axes, rows):
    """Stacked bars."""
    total = [sum(stage_seconds(row).values()) for row in rows]
    bottom = [0.0] * len(rows)
    for stage, colour in zip(STAGES, STAGE_COLOURS):
        share = [stage_seconds(row)[stage] / whole for row, whole in zip(rows, total)]
        axes.bar([f"{row['n'] // 1000}k" if row["n"] < 1e6 else "1M" for row in rows], share, bottom=bottom, color=colour, label=stage)
        bottom = [low + more for low, more in zip(bottom, share)]
    axes.set(title="share of each stage, parallel", xlabel="constraints")
    axes.grid(False)
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5))


def plot(rows, path):
    figure, (time, memory, shares) = pyplot.subplots(1, 3, figsize=(12.4, 3.4))
    time_and_memory(time, memory, rows)
    stage_shares(shares, [row for row in rows if row["drawn"] == "parallel"])
    save(figure, path)


def growth_table(rows):
    """Sizes near a power of ten."""
    lines = []
    for row in rows:
        if abs(math.log10(row["n"]) - round(math.log10(row["n"]))) > 0.01:
            continue
        stages = stage_seconds(row)
        slowest = max(stages, key=stages.get)
        lines.append([
            row["drawn"], tables.count(row["n"]), tables.seconds(row["seconds"]), tables.seconds(row["cpu_s"]),
            f"{row['added_mb']:.0f}", row["iterations"], f"{row['residual_mm']:.4f}",
            f"{slowest} ({100 * stages[slowest] / sum(stages.values()):.0f} %)",
        ])
    header = ["drawn", "n", "seconds", "CPU s", "MB added", "iterations", "largest residual, mm", "longest stage"]
    return tables.table(header, lines)


def main():
    rows = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))["growth"]["rows"]
    plot(rows, sys.argv[2])
    if len(sys.argv) < 4:
        print(growth_table(rows))
        return
    document = pathlib.Path(sys.argv[3])
    document.write_text(tables.filled(document.read_text(encoding="utf-8"), rows, {"growth": growth_table}), encoding="utf-8")


if __name__ == "__main__":
    main()
