#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A plot of the agreement with the truth by the number of planes, from `kontur_accuracy --counts`.

Usage: bench/agreement.py RESULTS.json PLOT.svg. Prints a table of Dice beside.
"""
import json
import math
import pathlib
import sys

from growth import line, text

COLOURS = {"axial": "#1b6ca8", "orthogonal": "#c4552d", "oblique": "#4a8f3c"}
METRICS = {
    "missed": ("1 - Dice", [0.001, 0.01, 0.1, 1], lambda c: 1 - c["dice"]),
    "hd95": ("HD95, mm", [0.1, 1, 10, 100], lambda c: c.get("hausdorff95_mm")),
    "mean": ("mean distance, mm", [0.01, 0.1, 1, 10, 100], lambda c: c.get("mean_surface_distance_mm")),
}
WIDTH, HEIGHT, LEFT, TOP, ACROSS, DOWN = 184, 150, 46, 34, 236, 194
FEWEST, MOST = 3, 20


def mean_over_series(rows, method, metric):
    """{planes: the metric's mean}; nothing where a mask is empty."""
    found = {}
    for row in rows:
        value = METRICS[metric][2](row[method])
        if value is not None:
            found.setdefault(row["planes"], []).append(value)
    return {planes: sum(values) / len(values) for planes, values in sorted(found.items())}


def panel(left, top, rows, metric, title):
    ticks = METRICS[metric][1]
    low, high = math.log10(ticks[0]), math.log10(ticks[-1])

    def x(planes):
        return left + WIDTH * (planes - FEWEST) / (MOST - FEWEST)

    def y(value):
        return top + HEIGHT * (high - min(max(math.log10(max(value, 1e-9)), low), high)) / (high - low)

    parts = [text(left + WIDTH / 2, top - 8, title, size=12)]
    for tick in ticks:
        parts += [line(left, y(tick), left + WIDTH, y(tick), "#ddd"), text(left - 5, y(tick) + 4, f"{tick:g}", "end", 10)]
    for planes in (3, 5, 10, 15, 20):
        parts += [line(x(planes), top, x(planes), top + HEIGHT, "#eee"), text(x(planes), top + HEIGHT + 13, planes, size=10)]
    for direction, colour in COLOURS.items():
        own = [row for row in rows if row["direction"] == direction]
        for method, extra in (("paper", 'stroke-width="1.2" stroke-dasharray="4 3"'), ("kontur", 'stroke-width="2.2"')):
            points = " ".join(f"{x(n):.1f},{y(v):.1f}" for n, v in mean_over_series(own, method, metric).items())
            parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" {extra}/>')
    return parts


def svg_of(width, height, parts):
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" fill="#222">'
        + f'<rect width="{width}" height="{height}" fill="white"/>' + "".join(parts) + "</svg>\n"
    )


def svg(rows):
    organs = list(dict.fromkeys(row["object"] for row in rows))
    width, height = LEFT + ACROSS * len(organs), TOP + DOWN * len(METRICS) + 34
    parts = []
    for column, organ in enumerate(organs):
        of_organ = [row for row in rows if row["object"] == organ]
        for k, (metric, (title, _, _)) in enumerate(METRICS.items()):
            parts += panel(LEFT + ACROSS * column, TOP + DOWN * k, of_organ, metric, f"{organ}: {title}")
    bottom = height - 12
    entries = [(name, colour, "") for name, colour in COLOURS.items()] + [("the paper's method", "#555", 'stroke-dasharray="4 3"')]
    for k, (name, colour, extra) in enumerate(entries):
        at = LEFT + 150 * k
        parts += [line(at, bottom - 4, at + 26, bottom - 4, colour, f'stroke-width="2.2" {extra}'), text(at + 32, bottom, name, "start")]
    parts.append(text(width - 20, bottom, "planes drawn", "end"))
    return svg_of(width, height, parts)


def table(rows):
    counts = [n for n in (3, 5, 8, 12, 20) if any(row["planes"] == n for row in rows)]
    lines = ["| organ | planes | " + " | ".join(str(n) for n in counts) + " |", "|---" * (len(counts) + 2) + "|"]
    for organ in dict.fromkeys(row["object"] for row in rows):
        for direction in COLOURS:
            own = [row for row in rows if row["object"] == organ and row["direction"] == direction]
            ours, papers = (mean_over_series(own, method, "missed") for method in ("kontur", "paper"))
            cells = " | ".join(f"{1 - ours[n]:.3f} ({1 - papers[n]:.3f})" for n in counts)
            lines.append(f"| {organ} | {direction} | {cells} |")
    return "\n".join(lines)


if __name__ == "__main__":
    results = json.loads(pathlib.Path(sys.argv[1]).read_text())
    pathlib.Path(sys.argv[2]).write_text(svg(results))
    print(table(results))
