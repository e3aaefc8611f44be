#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How the agreement with the truth depends on what is drawn: on the number of planes, on where a stack begins, on how a drawing is
stored. docs/accuracy/drawings.md and organs.md.

Usage: PYTHONPATH=build/release/python bench/agreement.py COMMAND ... (measurements as CSV; tables go to stderr)

counts          the phantom's organs cut by 3 to 20 axial, orthogonal and random planes, by kontur's defaults and by the paper's method
plot CSV PLOT [DOCUMENT.md]  a plot of what `counts` printed, SVG or PNG; a table of kontur's Dice, printed or in its place there
phases          the organs across each axis in about 6 and 12 gaps, the first plane .1, .3, .5, .7 and .9 of a gap inside
stored FOLDER   drawings (folders as kontur_accuracy takes them) stored backwards, begun elsewhere, mirrored, turned
"""
import argparse
import csv
import pathlib
import statistics
import sys

import kontur
import numpy as np

import phantom_sections
from plots import BLUE, GREEN, GREY, RED, plain_ticks, pyplot, save
from tables import filled, table

PAPER = {"kernel": "triharmonic", "normals": "in-plane", "normal_offset_mm": 1.0, "solver": "cholesky"}
MEASURES = ["dice", "hausdorff95_mm", "mean_surface_distance_mm"]
COUNTS = (3, 4, 5, 6, 7, 8, 10, 12, 14, 17, 20)
SERIES = 3  # of random planes
DIRECTIONS = ("axial", "orthogonal", "oblique")
PHASES = (0.1, 0.3, 0.5, 0.7, 0.9)
GAPS = (6, 12)  # about, across an organ
UNEVEN = 0.618  # of a gap: else both ends of an organ would be as far from their last planes, together
STORED_FIELDS = ["object", "drawing", "way", "dice", "dice_with_truth_changes", "rms_mm", "most_mm"]


def agreement(mask, truth):
    """Dice and the distances, which are nan where a mask is empty."""
    found = kontur.compare(mask, truth)
    distances = [getattr(found.surface, name) if found.surface else float("nan") for name in MEASURES[1:]]
    return [f"{found.dice:.5f}", *(f"{mm:.3f}" for mm in distances)]


def across(box, axis, count):
    """Evenly spaced across an axis, as far from the ends of the box as it is dense."""
    heights = box[0, axis] + (box[1] - box[0])[axis] * (np.arange(count) + 0.9) / (count + 0.8)
    return [kontur.Plane(np.where(np.arange(3) == axis, height, box.mean(axis=0)), np.eye(3)[axis]) for height in heights]


def orthogonal(box, count):
    return [plane for axis in range(3) for plane in across(box, axis, (count + axis) // 3)]


def oblique(box, count, series):
    """In random directions through random points of the middle half. More planes are the same ones and others."""
    random = np.random.default_rng(series)
    places = [(random.normal(size=3), random.uniform(-0.25, 0.25, 3)) for _ in range(count)]
    return [kontur.Plane(box.mean(axis=0) + at * (box[1] - box[0]), normal / np.linalg.norm(normal)) for normal, at in places]


def drawn_planes(box, count):
    """(direction, series, planes)"""
    yield "axial", 1, across(box, 2, count)
    yield "orthogonal", 1, orthogonal(box, count)
    for series in range(1, SERIES + 1):
        yield "oblique", series, oblique(box, count, series)


def rows_by_count(organs, counts=COUNTS, points_per_plane=120):
    for organ in organs:
        for count in counts:
            print(f"{organ.name}, {count} planes", file=sys.stderr)
            for direction, series, planes in drawn_planes(organ.box, count):
                contours = phantom_sections.sections(organ.body, planes, points_per_plane * count)
                for method, options in (("kontur", {}), ("paper", PAPER)):
                    mask = kontur.segment(contours, organ.truth.grid, **options).mask
                    yield [organ.name, direction, series, count, len(contours), method, *agreement(mask, organ.truth)]


COUNT_FIELDS = ["organ", "direction", "series", "planes", "contours", "method", *MEASURES]


def stack(box, axis, gap, phase):
    """Planes across an axis, the first one a share of a gap above the lowest point."""
    heights = np.arange(box[0, axis] + phase * gap, box[1, axis], gap)
    return [kontur.Plane(np.where(np.arange(3) == axis, height, box.mean(axis=0)), np.eye(3)[axis]) for height in heights]


def beyond_ends(mask, truth, contours, axis):
    """Volumes too much and too little beyond the first and the last contour, in percent of the organ's."""
    drawn = np.concatenate([contour.points for contour in contours])[:, axis]
    affine = truth.grid.index_to_mm  # along the axes
    heights = affine[axis, 3] + affine[axis, axis] * np.arange(truth.grid.size[axis])
    outside = ((heights < drawn.min()) | (heights > drawn.max())).reshape([-1 if 2 - k == axis else 1 for k in range(3)])
    made, true = mask.values > 0, truth.values > 0
    return [f"{100 * (wrong & outside).sum() / true.sum():.3f}" for wrong in (made & ~true, true & ~made)]


def rows_by_phase(organs, gaps=GAPS, points_per_plane=200):
    for organ in organs:
        for axis in range(3):
            for count in gaps:
                print(f"{organ.name} across {'xyz'[axis]}, {count} gaps", file=sys.stderr)
                gap = (organ.box[1] - organ.box[0])[axis] / (count + UNEVEN)
                for phase in PHASES:
                    planes = stack(organ.box, axis, gap, phase)
                    contours = phantom_sections.sections(organ.body, planes, points_per_plane * len(planes))
                    mask = kontur.segment(contours, organ.truth.grid).mask
                    yield [organ.name, "xyz"[axis], count, phase, len(contours), *agreement(mask, organ.truth),
                           *beyond_ends(mask, organ.truth, contours, axis)]


PHASE_FIELDS = ["organ", "axis", "gaps", "phase", "contours", *MEASURES, "too_much_beyond_percent", "too_little_beyond_percent"]


def rotation(normal):
    """Columns: two directions of the plane and its normal."""
    plane = kontur.Plane([0, 0, 0], np.array(normal) / np.linalg.norm(normal))
    return np.column_stack([plane.u, plane.v, plane.normal])


def motion(linear, translation=(0, 0, 0)):
    return np.block([[np.array(linear, float), np.array(translation, float)[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]])


def with_points(contours, change):
    """The set with each closed contour's points changed."""
    return kontur.ContourSet([kontur.Contour(change(c.points), plane=c.plane, closed=True, hole=c.hole) if c.closed else c
                              for c in contours])


def begun_later(share):
    return lambda contours: with_points(contours, lambda points: np.roll(points, -int(share * len(points)), axis=0))


def in_another_order(contours):
    """Every third of them, then the others."""
    return kontur.ContourSet([c for first in (2, 0, 1) for c in list(contours)[first::3]])


def ways():
    """(name, how it is stored, motion of the drawing as of the image)"""
    still, same = np.eye(4), lambda contours: contours
    return [("reversed", lambda contours: with_points(contours, lambda points: points[::-1]), still),
            ("begun_a_third_later", begun_later(1 / 3), still), ("begun_one_later", begun_later(0.03), still),
            ("in_another_order", in_another_order, still), ("mirrored", same, motion(np.diag([-1, 1, 1]))),
            ("axes_exchanged", same, motion([[0, 0, 1], [1, 0, 0], [0, 1, 0]])),
            ("turned", same, motion(rotation([0.3, -0.5, 0.8]), (70, -200, 900)))]


def moved(contours, by):
    if np.array_equal(by, np.eye(4)):
        return contours
    at, turn = (lambda points: points @ by[:3, :3].T + by[:3, 3]), by[:3, :3]
    return kontur.ContourSet([kontur.Contour(at(c.points), plane=kontur.Plane(at(c.plane.origin), turn @ c.plane.normal),
                                             closed=c.closed, hole=c.hole) for c in contours])


def rows_by_way(contours, truth):
    """Dice with the mask as the drawing came, by how much the Dice with the truth changes, and how far the function at the drawn
    points is off (root mean square, most), mm."""
    points = np.concatenate([contour.points for contour in contours])
    first = kontur.segment(contours, truth.grid)
    here, dice = first.function.values(points), kontur.compare(first.mask, truth).dice
    for name, stored, by in ways():
        grid = kontur.Grid(truth.grid.size, by @ truth.grid.index_to_mm, "LPS")
        other = kontur.segment(moved(stored(contours), by), grid)
        off = np.abs(other.function.values(points @ by[:3, :3].T + by[:3, 3]) - here)
        mask = kontur.Mask(other.mask.values, truth.grid)
        yield [name, f"{kontur.compare(mask, first.mask).dice:.7f}", f"{kontur.compare(mask, truth).dice - dice:.7f}",
               f"{np.sqrt(np.mean(off**2)):.6f}", f"{off.max():.6f}"]


def rows_by_storage(folders):
    for path in sorted(path for folder in folders for path in folder.rglob("*.json")):
        print(f"{path.parent.name} {path.stem}", file=sys.stderr)
        for row in rows_by_way(kontur.read_contours(path), kontur.read_mask(path.with_name("truth.nii.gz"))):
            yield [path.parent.name, path.stem, *row]


def mean_over_series(rows, measure):
    """{planes: the measure's mean}; what is not a number is left out."""
    found = {}
    for row in rows:
        value = float(row[measure])
        if not np.isnan(value):
            found.setdefault(int(row["planes"]), []).append(value)
    return {planes: statistics.fmean(values) for planes, values in sorted(found.items())}


def plot(rows, path):
    panels = [("1 - Dice", "dice", (0.001, 0.01, 0.1, 1)), ("HD95, mm", "hausdorff95_mm", (0.1, 1, 10, 100)),
              ("mean distance, mm", "mean_surface_distance_mm", (0.01, 0.1, 1, 10, 100))]
    names = list(dict.fromkeys(row["organ"] for row in rows))
    figure, grid = pyplot.subplots(len(panels), len(names), figsize=(2.5 * len(names), 7), squeeze=False)
    for row, (title, measure, ticks) in zip(grid, panels):
        for axes, name in zip(row, names):
            for direction, colour in zip(DIRECTIONS, (BLUE, RED, GREEN)):
                for method, style in (("paper", "--"), ("kontur", "-")):
                    some = [r for r in rows if (r["organ"], r["direction"], r["method"]) == (name, direction, method)]
                    own = mean_over_series(some, measure)
                    values = [1 - v for v in own.values()] if measure == "dice" else own.values()
                    axes.semilogy(own.keys(), [max(v, ticks[0]) for v in values], style, color=colour,
                                  label=direction if method == "kontur" else None)
            axes.set(title=f"{name}: {title}", ylim=(ticks[0], ticks[-1]))
            plain_ticks(axes.yaxis, ticks)
    grid[-1][0].plot([], [], "--", color=GREY, label="the paper's method")
    save(figure, path, legend_of=grid[-1][0])


def count_table(rows):
    """Dice of kontur in the three directions."""
    counts = [n for n in (3, 5, 8, 12, 20) if any(int(row["planes"]) == n for row in rows)]
    lines = []
    for name in dict.fromkeys(row["organ"] for row in rows):
        means = [mean_over_series([r for r in rows if (r["organ"], r["direction"], r["method"]) == (name, direction, "kontur")], "dice")
                 for direction in DIRECTIONS]
        lines.append([name, *(", ".join(f"{mean[n]:.3f}".removeprefix("0") for mean in means) for n in counts)])
    return table(["planes", *counts], lines)


def phase_table(rows):
    """Mean Dice by where the stack begins."""

    def mean(own):
        return f"{statistics.fmean(float(row[PHASE_FIELDS.index('dice')]) for row in own):.4f}"
    lines = [[name, *(mean([row for row in rows if row[0] == name and row[3] == phase]) for phase in PHASES),
              mean([row for row in rows if row[0] == name])] for name in dict.fromkeys(row[0] for row in rows)]
    return table(["organ", *PHASES, "all"], lines)


def write(fields, rows):
    """CSV to stdout, row by row; returns the rows."""
    output, all_rows = csv.writer(sys.stdout, lineterminator="\n"), []
    output.writerow(fields)
    for row in rows:
        output.writerow(row)
        sys.stdout.flush()
        all_rows.append(row)
    return all_rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    for name in ("counts", "phases"):
        commands.add_parser(name)
    command = commands.add_parser("plot")
    command.add_argument("csv", type=pathlib.Path)
    command.add_argument("plot", type=pathlib.Path)
    command.add_argument("document", type=pathlib.Path, nargs="?")
    commands.add_parser("stored").add_argument("folders", nargs="+", type=pathlib.Path)
    options = parser.parse_args()
    if options.command == "plot":
        with open(options.csv, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        plot(rows, options.plot)
        if options.document:
            text = options.document.read_text(encoding="utf-8")
            options.document.write_text(filled(text, rows, {"counts": count_table}), encoding="utf-8")
        else:
            print(count_table(rows))
    elif options.command == "stored":
        write(STORED_FIELDS, rows_by_storage(options.folders))
    else:
        organs = phantom_sections.organs()
        if options.command == "counts":
            write(COUNT_FIELDS, rows_by_count(organs))
        else:
            print(phase_table(write(PHASE_FIELDS, rows_by_phase(organs))), file=sys.stderr)


if __name__ == "__main__":
    main()
