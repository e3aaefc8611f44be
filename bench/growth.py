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

COLOURS = {"parallel": "#1b6ca8", "orthogonal, by hand": "#c4552d"}
STAGE_COLOURS = ["#4c78a8", "#9ecae9", "#f58518", "#ffbf79", "#54a24b", "#b279a2", "#bab0ac"]
WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 330, 260, 52, 34, 46
STAGES = ["neighbours", "factors", "matrix", "products", "preconditioning", "check", "other"]


def stage_seconds(row):
    """Seconds by stage; what no stage accounts for is "other"."""
    known = {name: row["stages_of_last_run"].get(name, 0) for name in STAGES[:-1]}
    return known | {"other": max(0, row["seconds"] - sum(known.values()))}


def text(x, y, content, anchor="middle", size=11, extra=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size}" {extra}>{content}</text>'


def line(x1, y1, x2, y2, colour, extra=""):
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" {extra}/>'


def power(exponent):
    return f'10<tspan dy="-4" font-size="8">{exponent}</tspan>'


class LogPlot:
    """A panel with logarithmic axes."""

    def __init__(self, left, title, unit, xs, ys):
        self.left = left
        self.x_range = math.floor(math.log10(min(xs))), math.ceil(math.log10(max(xs)))
        self.y_range = math.floor(math.log10(min(ys))), math.ceil(math.log10(max(ys)))
        self.parts = [text(left + WIDTH / 2, TOP - 14, f"{title}, {unit}", size=13)]
        for e in range(self.x_range[0], self.x_range[1] + 1):
            x = self.x(10**e)
            self.parts += [line(x, TOP, x, TOP + HEIGHT, "#ddd"), text(x, TOP + HEIGHT + 16, power(e))]
        for e in range(self.y_range[0], self.y_range[1] + 1):
            y = self.y(10**e)
            self.parts += [line(left, y, left + WIDTH, y, "#ddd"), text(left - 6, y + 4, power(e), "end")]
        self.parts.append(text(left + WIDTH / 2, TOP + HEIGHT + 36, "constraints"))

    def x(self, value):
        low, high = self.x_range
        return self.left + WIDTH * (math.log10(value) - low) / max(high - low, 1)

    def y(self, value):
        low, high = self.y_range
        return TOP + HEIGHT * (1 - (math.log10(value) - low) / max(high - low, 1))

    def curve(self, points, colour, extra=""):
        places = [(self.x(x), self.y(y)) for x, y in points if y > 0]
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
        self.parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2" {extra}/>')
        if "dash" not in extra:
            self.parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in places]

    def legend(self, entries):
        for k, (name, colour, extra) in enumerate(entries):
            y = TOP + 14 + 16 * k
            self.parts += [
                line(self.left + 10, y, self.left + 34, y, colour, f'stroke-width="2" {extra}'),
                text(self.left + 40, y + 4, name, "start"),
            ]


def shares(left, rows):
    """Stacked bars: the share of each stage."""
    parts = [text(left + WIDTH / 2, TOP - 14, "share of each stage, parallel", size=13)]
    step = WIDTH / len(rows)
    for k, row in enumerate(rows):
        stages = stage_seconds(row)
        total, top = sum(stages.values()), TOP
        for stage, colour in zip(STAGES, STAGE_COLOURS):
            height = HEIGHT * stages[stage] / total
            parts.append(
                f'<rect x="{left + k * step + 2:.1f}" y="{top:.1f}" width="{step - 4:.1f}" height="{height:.1f}" fill="{colour}"/>'
            )
            top += height
        x = left + (k + 0.5) * step
        parts.append(text(x, TOP + HEIGHT + 16, f"{row['n'] / 1000:.0f}k", size=9))
    for k, (stage, colour) in enumerate(zip(STAGES, STAGE_COLOURS)):
        y = TOP + 10 + 18 * k
        parts.append(f'<rect x="{left + WIDTH + 10}" y="{y - 9}" width="11" height="11" fill="{colour}"/>')
        parts.append(text(left + WIDTH + 26, y, stage, "start"))
    parts.append(text(left + WIDTH / 2, TOP + HEIGHT + 36, "constraints"))
    return parts


def svg(rows):
    sets = {drawn: [row for row in rows if row["drawn"] == drawn] for drawn in COLOURS}
    sets = {drawn: found for drawn, found in sets.items() if found}
    sizes = [row["n"] for row in rows]
    dash = 'stroke-dasharray="5 4"'
    limits = [row["products_at_peak_s"] for row in rows]
    time = LogPlot(LEFT, "time to solve", "s", sizes, [row["seconds"] for row in rows] + limits)
    memory = LogPlot(2 * LEFT + WIDTH + 20, "memory added", "MB", sizes, [max(row["added_mb"], 1) for row in rows])
    for drawn, found in sets.items():
        time.curve([(row["n"], row["seconds"]) for row in found], COLOURS[drawn])
        time.curve([(row["n"], row["products_at_peak_s"]) for row in found], COLOURS[drawn], dash)
        memory.curve([(row["n"], max(row["added_mb"], 1)) for row in found], COLOURS[drawn])
    time.legend([(drawn, COLOURS[drawn], "") for drawn in sets] + [("its products at peak rate", "#555", dash)])
    width, height = 3 * (WIDTH + LEFT) + 180, TOP + HEIGHT + BOTTOM
    parts = time.parts + memory.parts + shares(3 * LEFT + 2 * WIDTH + 20, sets["parallel"])
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
        f'font-family="sans-serif" fill="#222"><rect width="100%" height="100%" fill="white"/>\n' + "\n".join(parts) + "\n</svg>\n"
    )


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
    pathlib.Path(sys.argv[2]).write_text(svg(rows), encoding="utf-8")
    if len(sys.argv) < 4:
        print(growth_table(rows))
        return
    document = pathlib.Path(sys.argv[3])
    before, rest = document.read_text(encoding="utf-8").split("<!-- begin growth -->", 1)
    after = rest.split("<!-- end growth -->", 1)[1]
    table = f"<!-- begin growth -->\n{growth_table(rows)}\n<!-- end growth -->"
    document.write_text(before + table + after, encoding="utf-8")


if __name__ == "__main__":
    main()
