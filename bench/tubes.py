#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tubes drawn by few rings: Dice between rings far apart, and at ends that an empty plane or the other foot's plane follows.

Usage: PYTHONPATH=build/release/python bench/tubes.py COMMAND ...

table [--first N] [--count N] > FILE    each drawing in several proportions: tubes, arches, S-shapes, helices and stacks
document CSV PAGE.md    the table between the page's markers
compare BEFORE AFTER    the Dice of two such files by group

Rings are exact circles. What lies between a last ring and the plane beyond it does not count, nor the caps of an end without one.
"""
import argparse
import csv
import statistics
import sys

import kontur
import numpy as np
from scipy import spatial, stats

from tables import filled, table

GAPS = (3, 5, 6.5)  # radii between rings
BEYOND_MM = (1, 2, 4)  # from the last ring to the empty plane
TILTS = (0.0003, 0.001, 0.003, 0.01)  # of an arch's feet, radians
RING_POINTS = 32
CURVE_STEPS = 2000
STEPS = 4  # voxels to a radius
MARGIN = 2.5  # radii of the grid beyond the curve
FIELDS = ["group", "shape", "radii_apart", "beyond_mm", "tilt", "number", "radius_mm", "rings", "dice", "sentences"]


def straight(_, length, random):
    return lambda t: np.column_stack([0 * t, 0 * t, length * t])


def arch(_, length, random, angle=None):
    angle = angle or np.pi * random.uniform(0.6, 1.05)
    return lambda t: length / angle * np.column_stack([np.cos(angle * t), 0 * t, np.sin(angle * t)])


def half_turn(radius, length, random):
    return arch(radius, length, random, np.pi)


def s_shape(_, length, random):
    """One wave of a sine, its length found by scaling."""
    height = random.uniform(0.08, 0.15)

    def unit(t):
        return np.column_stack([height * np.sin(6 * t), 0 * t, t])
    scale = length / curve_length(unit)
    return lambda t: scale * unit(t)


def helix(radius, length, random):
    """Its turns are 6 to 9 radii of the tube apart, and as wide as 5.5 to 8 of them."""
    width, pitch = radius * random.uniform(5.5, 8), radius * random.uniform(6, 9) / (2 * np.pi)
    angle = length / np.hypot(width, pitch)
    return lambda t: np.column_stack([width * np.cos(angle * t), width * np.sin(angle * t), pitch * angle * t])


def curve_length(curve):
    return np.linalg.norm(np.diff(curve(np.linspace(0, 1, CURVE_STEPS + 1)), axis=0), axis=1).sum()


def at_even_ways(curve, count):
    """The parameters of `count` places at even distances along the curve."""
    t = np.linspace(0, 1, CURVE_STEPS + 1)
    way = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(curve(t), axis=0), axis=1))])
    return np.interp(np.linspace(0, way[-1], count), way, t)


def turned_curve(curve, turn):
    return lambda t: curve(np.atleast_1d(t)) @ turn.T


def direction(curve, t):
    along = curve(t + 1e-5) - curve(t - 1e-5)
    return (along / np.linalg.norm(along))[0]


def rings_of(curve, radius, count, tilt, across):
    """The contours; the first and the last ring are tilted towards each other about `across`."""
    contours = []
    angles = 2 * np.pi * np.arange(RING_POINTS) / RING_POINTS
    for n, t in enumerate(at_even_ways(curve, count)):
        normal = direction(curve, t)
        turn = tilt * ((n == 0) - (n == count - 1.0))
        normal = np.cos(turn) * normal + np.sin(turn) * np.cross(normal, across)
        plane = kontur.Plane(curve(t)[0], normal)
        contours.append(kontur.Contour(plane.from_uv(radius * np.column_stack([np.cos(angles), np.sin(angles)])), plane=plane))
    return contours


def grid_around(places, radius):
    low, high = places.min(axis=0) - MARGIN * radius, places.max(axis=0) + MARGIN * radius
    step = radius / STEPS
    return kontur.Grid.from_spacing([int(n) for n in np.ceil((high - low) / step) + 1], [step] * 3, low)


def measure(curve, radius, contours, beyond_mm):
    """(Dice where the truth is known, number of the check's sentences)."""
    line = curve(np.linspace(0, 1, CURVE_STEPS + 1))
    ends = [(line[0], -direction(curve, 0.0)), (line[-1], direction(curve, 1.0))]
    empty = [kontur.Plane(place + beyond_mm * out, out) for place, out in ends] if beyond_mm else []
    made = kontur.segment(kontur.ContourSet(contours, empty_planes=empty), grid_around(line, radius), threads=1)
    grid = made.mask.grid
    axes = [grid.index_to_mm[a, 3] + grid.index_to_mm[a, a] * np.arange(grid.size[a]) for a in range(3)]
    places = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).transpose(2, 1, 0, 3).reshape(-1, 3)
    away, nearest = spatial.cKDTree(line).query(places)
    truth, found = away < radius, np.asarray(made.mask.values).ravel() > 0
    is_cap = (nearest == 0) | (nearest == CURVE_STEPS)
    truth &= ~is_cap
    counts = ~is_cap
    for place, out in ends:  # beyond an empty plane nothing is right
        counts |= (beyond_mm > 0) & is_cap & ((places - place) @ out > beyond_mm)
    both = (truth & found & counts).sum()
    return 2 * both / (truth.sum() + (found & counts).sum()), len(made.report.section_check.sentences)


def row(group, shape, number, curve_of, rings, *, gap=4.0, beyond_mm=0, tilt=0.0):
    random = np.random.default_rng([number, len(shape), rings])
    radius = float(np.round(random.uniform(4, 9), 2))
    turn = stats.special_ortho_group.rvs(3, random_state=random)
    curve = turned_curve(curve_of(radius, (rings - 1) * gap * radius, random), turn)
    contours = rings_of(curve, radius, rings, tilt, turn @ (0, 1, 0))
    dice, said = measure(curve, radius, contours, beyond_mm)
    return {"group": group, "shape": shape, "radii_apart": gap, "beyond_mm": beyond_mm, "tilt": tilt, "number": number,
            "radius_mm": radius, "rings": rings, "dice": f"{dice:.4f}", "sentences": said}


SHAPES = {"straight": (straight, 6), "arch": (arch, 6), "S": (s_shape, 8), "helix": (helix, 13)}


def rows(numbers):
    for number in numbers:
        for shape, (curve_of, rings) in SHAPES.items():
            for gap in GAPS:
                yield row("gaps", shape, number, curve_of, rings, gap=gap)
            for beyond_mm in BEYOND_MM:
                yield row("empty", shape, number, curve_of, rings, beyond_mm=beyond_mm)
        for beyond_mm in BEYOND_MM:
            yield row("empty", "stack", number, SHAPES["straight"][0], 5, gap=0.7, beyond_mm=beyond_mm)
        for tilt in TILTS:
            yield row("feet", "arch", number, half_turn, 6, tilt=tilt)


def column(one):
    """What a drawing is, apart from its shape."""
    if one["group"] == "gaps":
        return f"{float(one['radii_apart']):g} radii"
    if one["group"] == "empty":
        return f"empty: {one['beyond_mm']} mm"
    return "feet"


def by_drawing(some):
    """The mean Dice by shape."""
    shapes = [*SHAPES, "stack"]
    columns = list(dict.fromkeys(map(column, some)))
    lines = []
    for name in columns:
        cells = []
        for shape in shapes:
            found = [float(one["dice"]) for one in some if one["shape"] == shape and column(one) == name]
            cells.append(f"{statistics.mean(found):.3f}" if found else "")
        lines.append([name, *cells])
    return table(["drawing", *shapes], lines).replace(" | ", "|")


def compared(before, after):
    lines = []
    for name in dict.fromkeys((one["shape"], column(one)) for one in before):
        means = [statistics.mean(float(one["dice"]) for one in some if (one["shape"], column(one)) == name)
                 for some in (before, after)]
        lines.append([*name, *(f"{mean:.4f}" for mean in means), f"{means[1] - means[0]:+.4f}"])
    return table(["shape", "drawing", "before", "after", "change"], lines)


def read(name):
    with open(name, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True)
    at_random = commands.add_parser("table")
    at_random.add_argument("--first", type=int, default=0, help="of the proportions' numbers")
    at_random.add_argument("--count", type=int, default=2, help="of proportions")
    document = commands.add_parser("document")
    document.add_argument("csv")
    document.add_argument("page")
    compare = commands.add_parser("compare")
    compare.add_argument("before")
    compare.add_argument("after")
    options = parser.parse_args()
    if options.command == "table":
        writer = csv.DictWriter(sys.stdout, FIELDS)
        writer.writeheader()
        for one in rows(range(options.first, options.first + options.count)):
            writer.writerow(one)
            sys.stdout.flush()
    elif options.command == "compare":
        print(compared(read(options.before), read(options.after)))
    else:
        with open(options.page, encoding="utf-8") as file:
            text = file.read()
        with open(options.page, "w", encoding="utf-8") as file:
            file.write(filled(text, read(options.csv), {"tubes": by_drawing}))


if __name__ == "__main__":
    main()
