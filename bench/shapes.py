#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Solids of ten kinds, drawn by planes: the agreement with the truth, and whether the section check speaks where it should.

Usage: PYTHONPATH=build/release/python bench/shapes.py COMMAND ...

table > shapes.csv             each kind in three sizes by parallel, orthogonal and oblique planes
document CSV PAGE.md           the tables between the page's markers
random N [--seed N] > FILE     N random drawings of those kinds, one row each; a summary goes to stderr

A drawn section is wrong where the result has another side than the solid, 0.5 % of its size off its surface: `wrong` is the largest
share of any section, `island` that of what touches nothing drawn, `named` the share that the check sees. `low_ml` and `high_ml` are
the volume's interval, empty where the program has none. `seconds` is processor time of one thread, `ball_seconds` that of a ball by
as many planes and points.
"""
import argparse
import csv
import functools
import hashlib
import statistics
import sys
import time

import kontur
import numpy as np
from scipy import ndimage

import phantom_sections
import solids
from tables import filled, table

SIZES_MM = (15, 60, 240)
PLANES = ("parallel", "orthogonal", "oblique")
VOXELS, MARGIN = 56, 0.25  # across a solid; beyond it, of its extent
LATTICE = 160  # places across a solid where a section is looked for
SMALLEST = 5e-4  # section that is drawn, of the size's square
FIELDS = ["kind", "size_mm", "planes", "contours", "points", "dice", "truth_ml", "volume_ml", "low_ml", "high_ml", "wrong", "island",
          "named", "sentences", "sentence", "warnings", "warning", "seconds", "ball_seconds"]
DEEP = 0.005  # of the size: places so near to the solid's surface are neither right nor wrong
WRONG, RIGHT, RIGHT_ISLAND = 0.1, 0.02, 0.005  # of a section


def random_for(*names):
    digest = hashlib.sha256("/".join(map(str, names)).encode()).digest()
    return np.random.default_rng(int.from_bytes(digest[:8], "little"))


def turned_plane(place, normal):
    return kontur.Plane(place, normal / np.linalg.norm(normal))


def parallel(solid, count, random):
    """At equal distances, up to 20 degrees off a main axis."""
    normal = np.eye(3)[random.integers(3)] + random.uniform(-0.2, 0.2, 3)
    normal /= np.linalg.norm(normal)
    corners = np.array(np.meshgrid(*solid.bounds.T)).reshape(3, -1).T @ normal
    heights = corners.min() + np.ptp(corners) * (np.arange(count) + 0.9) / (count + 0.8)
    middle = solid.bounds.mean(axis=0)
    return [turned_plane(middle + (height - middle @ normal) * normal, normal) for height in heights]


def orthogonal(solid, count, random):
    low, extent = solid.bounds[0], np.ptp(solid.bounds, axis=0)
    return [turned_plane(np.where(np.arange(3) == axis, low + extent * part, solid.bounds.mean(axis=0)), np.eye(3)[axis])
            for axis in range(3) for part in (np.arange(count // 3) + random.uniform(0.3, 0.7)) / (count // 3)]


def oblique(solid, count, random):
    """In random directions through random places inside."""
    made = []
    while len(made) < count:
        place = random.uniform(*solid.bounds, (200, 3))
        place = place[solid.values(place) > 0][:1]
        if len(place):
            made.append(turned_plane(place[0], random.normal(size=3)))
    return made


def drawn(solid, size_mm, way, count, random):
    """(planes, the ContourSet in them)."""
    planes = {"parallel": parallel, "orthogonal": orthogonal, "oblique": oblique}[way](solid, count, random)
    return planes, exact_sections(solid, size_mm, planes)


def exact_sections(solid, size_mm, planes):
    step = size_mm / LATTICE
    lines = [line for plane in planes for line, _ in phantom_sections.closed_lines(solid, plane, step, SMALLEST * size_mm**2)]
    length = sum(np.linalg.norm(np.diff(line, axis=0, append=line[:1]), axis=1).sum() for line in lines)
    points = max(round(length / (size_mm / 60)), 12 * len(lines))
    return phantom_sections.sections(solid, planes, points, step, SMALLEST * size_mm**2)


def grid_around(solid):
    low, high = solid.bounds
    step = (high - low).max() / VOXELS
    margin = MARGIN * (high - low).max()
    size = np.ceil((high - low + 2 * margin) / step).astype(int) + 1
    return kontur.Grid.from_spacing([int(n) for n in size], [float(step)] * 3, [float(x) for x in low - margin])


def truth_mask(solid, grid):
    """Shape (z, y, x)."""
    affine = grid.index_to_mm
    axes = [affine[a, 3] + affine[a, a] * np.arange(grid.size[a]) for a in range(3)]
    kept = [np.flatnonzero((axis > low) & (axis < high)) for axis, low, high in zip(axes, *solid.bounds)]
    points = np.stack(np.meshgrid(*(axis[k] for axis, k in zip(axes, kept)), indexing="ij"), axis=-1)
    mask = np.zeros(tuple(grid.size), bool)
    mask[np.ix_(*kept)] = (solid.values(points.reshape(-1, 3)) > 0).reshape(points.shape[:3])
    return mask.transpose(2, 1, 0)


def is_made(made, places):
    """Whether the result has the places: f is above 0 there, and the mask has a voxel beside them."""
    grid = made.mask.grid
    mask = ndimage.binary_dilation(np.asarray(made.mask.values) > 0, np.ones((3, 3, 3)))
    index = np.rint((places - grid.index_to_mm[:3, 3]) @ np.linalg.inv(grid.index_to_mm[:3, :3]).T).astype(int)
    index = np.clip(index, 0, np.array(grid.size) - 1)
    is_in = mask[index[:, 2], index[:, 1], index[:, 0]]
    if is_in.any():
        is_in[is_in] = np.asarray(made.function.values(places[is_in], threads=1)) > 0
    return is_in


def worst_section(solid, planes, made, size_mm):
    """(share of the section that is worst which the result has on the other side, the same of islands alone). Sections so small that
    they may not be drawn do not count."""
    corners = np.array(np.meshgrid(*solid.bounds.T)).reshape(3, -1).T
    step, worst, island = size_mm / LATTICE, 0.0, 0.0
    for plane in planes:
        uv = plane.to_uv(corners)
        low, high = uv.min(axis=0), uv.max(axis=0)
        margin = 0.1 * size_mm
        u, v = (np.arange(a - margin, b + margin, step) for a, b in zip(low, high))
        places = plane.from_uv(np.column_stack([axis.ravel() for axis in np.meshgrid(u, v)]))
        truth = solid.values(places)
        inside = truth > 0
        if inside.sum() * step**2 < 4 * SMALLEST * size_mm**2:
            continue
        found = is_made(made, places)
        wrong = (found != inside) & (np.abs(truth) > DEEP * size_mm)
        worst = max(worst, wrong.sum() / inside.sum())
        parts = ndimage.label(found.reshape(len(v), len(u)))[0].ravel()
        apart = wrong & found & np.isin(parts, np.unique(parts[inside]), invert=True)
        island = max(island, apart.sum() / inside.sum())
    return float(worst), float(island)


def timed(contours, grid):
    start = time.process_time()
    made = kontur.segment(contours, grid, threads=1)
    return made, time.process_time() - start


@functools.cache
def ball_seconds(planes, points):
    """Processor time of a ball by so many planes and points, mm and voxels as a solid of 60 mm has."""
    unit = solids.Solid("ball", np.array([[-31.0] * 3, [31.0] * 3]), lambda p: 30 - np.linalg.norm(p, axis=1))
    contours = phantom_sections.sections(unit, parallel(unit, planes, np.random.default_rng(0)), points)
    return min(timed(contours, grid_around(unit))[1] for _ in range(2))


def measure(kind, size_mm, way, count, random):
    solid = solids.solid(kind, size_mm, random)
    planes, contours = drawn(solid, size_mm, way, count, random)
    return measured(kind, size_mm, way, solid, planes, contours)


def measured(kind, size_mm, way, solid, planes, contours):
    made, seconds = timed(contours, grid_around(solid))
    truth, mask = truth_mask(solid, made.mask.grid), np.asarray(made.mask.values) > 0
    check, band = made.report.section_check, made.report.uncertainty
    voxel_ml = made.mask.grid.voxel_volume_mm3 / 1000
    wrong, island = worst_section(solid, planes, made, size_mm)
    points = sum(len(contour.points) for contour in contours.contours)
    near = max(250, 250 * round(points / 250))
    return {"kind": kind, "size_mm": size_mm, "planes": way, "contours": len(contours.contours), "points": points,
            "dice": f"{2 * (truth & mask).sum() / max(truth.sum() + mask.sum(), 1):.4f}",
            "truth_ml": f"{truth.sum() * voxel_ml:.4g}", "volume_ml": f"{mask.sum() * voxel_ml:.4g}",
            "low_ml": f"{band.volume_low_ml:.4g}" if band.is_known else "",
            "high_ml": f"{band.volume_high_ml:.4g}" if band.is_known else "",
            "wrong": f"{wrong:.4f}", "island": f"{island:.4f}",
            "named": f"{check.largest_wrong_share:.4f}", "sentences": len(check.sentences),
            "sentence": check.sentences[0] if check.sentences else "",
            "warnings": len(made.report.warnings), "warning": made.report.warnings[0] if made.report.warnings else "",
            "seconds": f"{seconds:.3f}", "ball_seconds": f"{ball_seconds(9, near):.3f}"}


def is_silent(row):
    return float(row["wrong"]) > WRONG and not int(row["sentences"])


def table_rows():
    for kind in solids.KINDS:
        for size_mm in SIZES_MM:
            for way in PLANES:
                yield measure(kind, size_mm, way, 12 if way == "orthogonal" else 10, random_for(kind, size_mm, way))


def random_rows(count, seed):
    for number in range(count):
        random = random_for("random", seed, number)
        kind, way = random.choice(sorted(solids.KINDS)), random.choice(PLANES)
        size_mm = float(np.round(np.exp(random.uniform(np.log(10), np.log(300))), 1))
        planes = 3 * int(random.integers(2, 6)) if way == "orthogonal" else int(random.integers(5, 15))
        yield {"number": number} | measure(kind, size_mm, way, planes, random)


def summary(rows):
    right = [row for row in rows if float(row["wrong"]) <= RIGHT and float(row["island"]) <= RIGHT_ISLAND]
    slow = [float(row["seconds"]) / float(row["ball_seconds"]) for row in rows]
    return (f"{len(rows)} drawings: {sum(map(is_silent, rows))} wrong by more than a tenth and silent; of {len(right)} right ones "
            f"{sum(int(row['sentences']) > 0 for row in right)} spoken of; at most {max(slow):.1f} times the time of a ball")


def written(rows, fields):
    """The rows, printed as they are measured."""
    writer = csv.DictWriter(sys.stdout, fields)
    writer.writeheader()
    kept = []
    for row in rows:
        writer.writerow(row)
        sys.stdout.flush()
        kept.append(row)
    print(summary(kept), file=sys.stderr)


def cell(row):
    """Dice, the worst section in percent, and whether the check spoke."""
    said = " said" if int(row["sentences"]) else ""
    return f"{float(row['dice']):.3f}, {100 * float(row['wrong']):.0f} %{said}"


def volumes(rows):
    """By planes: the error of the volume in the median and at most, and how often the interval holds the truth."""
    lines = []
    for way in PLANES:
        some = [row for row in rows if row["planes"] == way]
        errors = [abs(float(row["volume_ml"]) / float(row["truth_ml"]) - 1) for row in some]
        held = sum(bool(row["low_ml"]) and float(row["low_ml"]) <= float(row["truth_ml"]) <= float(row["high_ml"]) for row in some)
        lines.append([way, f"{100 * statistics.median(errors):.1f} %", f"{100 * max(errors):.0f} %", f"{held} of {len(some)}"])
    return table(["planes", "median error", "largest", "in its interval"], lines)


def by_kind(rows, of_row):
    found = {(row["kind"], float(row["size_mm"]), row["planes"]): of_row(row) for row in rows}
    return table(["kind", "mm", *PLANES], [[kind, size, *(found[kind, float(size), way] for way in PLANES)]
                                           for kind in solids.KINDS for size in SIZES_MM])


TABLES = {"kinds": lambda rows: by_kind(rows, cell), "kinds_volume": volumes}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("table")
    document = commands.add_parser("document")
    document.add_argument("csv")
    document.add_argument("page")
    drawn_at_random = commands.add_parser("random")
    drawn_at_random.add_argument("count", type=int)
    drawn_at_random.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    if options.command == "table":
        written(table_rows(), FIELDS)
    elif options.command == "random":
        written(random_rows(options.count, options.seed), ["number", *FIELDS])
    else:
        with open(options.csv, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        with open(options.page, encoding="utf-8") as file:
            text = file.read()
        with open(options.page, "w", encoding="utf-8") as file:
            file.write(filled(text, rows, TABLES))


if __name__ == "__main__":
    main()
