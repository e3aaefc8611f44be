#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Stacks of slices that begin anywhere in a gap: how far an object goes on beyond the last one is not to be judged by one place.

Usage: bench/starts.py draw DATA FOLDER --kontur build/release/bin/kontur
       bench/starts.py table KONTUR.json [OTHER.json]...

`draw` writes FOLDER/tune, FOLDER/report (structures of label maps that no image cuts off) and FOLDER/real (structure sets, whose
contours are those that people drew), as kontur_accuracy takes them: one slice in two from the first and the second on, one in
four from each of the first four, one in eight from the second, fourth, sixth and eighth. DATA is laid out as organ_sources.py
says. `table` prints the means of files of kontur_accuracy over the structures, of each the mean over its starts.
"""
import argparse
import collections
import json
import pathlib

import numpy as np

import organ_sources
import slices
import structures

STARTS = {2: (0, 1), 4: (0, 1, 2, 3), 8: (1, 3, 5, 7)}


def kept_slices(truth):
    """(drawing, slices) for every step and start that leave two slices and more."""
    for step, starts in STARTS.items():
        for start in starts:
            kept = slices.kept(truth, step, start)
            if len(kept):
                yield f"slices{step}_from{start}", kept


def draw_maps(options):
    for number, (name, (mask, affine, _)) in enumerate(organ_sources.label_maps(options.data, options.kontur).items(), 1):
        if structures.touches_border(mask):
            continue
        truth, grid, _ = structures.truth_of(mask, affine)
        folder = options.output / ("report" if number % 2 else "tune") / name
        structures.write_truth(folder, truth, grid)
        least_area = np.linalg.norm(grid[:3, :3], axis=0).min() ** 2
        for drawing, kept in kept_slices(truth):
            structures.cut(options.kontur, folder, drawing, slices.slice_planes(kept, grid), least_area)


def draw_real(options):
    for name, (mask, affine, _, planes) in organ_sources.structure_sets(options.data, options.kontur).items():
        truth, grid, _ = structures.truth_of(mask, affine)
        folder = options.output / "real" / name
        structures.write_truth(folder, truth, grid)
        at = slices.slice_numbers(planes, grid)
        for drawing, kept in kept_slices(truth):
            drawn = [plane for plane, number in zip(planes, at) if np.abs(kept - number).min() < 0.25]
            if len(drawn) > 1:
                (folder / f"{drawing}.json").write_text(json.dumps({"frame": "LPS mm", "planes": drawn}))


def draw(options):
    draw_maps(options)
    draw_real(options)


def mean(values):
    return sum(values) / len(values)


def dice_by_structure(rows):
    found = collections.defaultdict(list)
    for row in rows:
        found[row["object"]].append(row["kontur"]["dice"])
    return found


def means(rows):
    """{column: mean Dice}."""
    columns = {}
    for step in STARTS:
        some = [row for row in rows if row["drawing"].startswith(f"slices{step}_")]
        if some:
            columns[f"1 in {step}"] = mean([mean(dice) for dice in dice_by_structure(some).values()])
    return columns


def table(options):
    for n, file in enumerate(options.files):
        columns = means(json.loads(file.read_text()))
        if n == 0:
            print(f"| | {' | '.join(columns)} |\n|---{'|--:' * len(columns)}|")
        print(f"| {file.stem} | {' | '.join(f'{dice:.4f}' for dice in columns.values())} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(required=True)
    command = commands.add_parser("draw")
    command.add_argument("data", type=pathlib.Path)
    command.add_argument("output", type=pathlib.Path)
    command.add_argument("--kontur", required=True, type=lambda path: pathlib.Path(path).resolve())
    command.set_defaults(run=draw)
    command = commands.add_parser("table")
    command.add_argument("files", nargs="+", type=pathlib.Path)
    command.set_defaults(run=table)
    options = parser.parse_args()
    options.run(options)


if __name__ == "__main__":
    main()
