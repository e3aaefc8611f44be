#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Structures of real scans, drawn in many ways and segmented by kontur and by its peers: docs/accuracy/organs.md.

Usage: bench/organs.py DATA OUTPUT --kontur build/release/bin/kontur [--hands-every 4] [--jobs N] [--seed TEXT] [--keep]

Three stages, of which --only runs one. `draw` writes OUTPUT/drawings/STRUCTURE: the truth; five sets of planes through it, drawn
exactly and, of every --hands-every-th structure of a group, by three hands (hands.py); every second, fourth and eighth slice.
Real structure sets have their own contours on slices alone. `measure` segments all of them and writes OUTPUT/results.csv.
`report` writes OUTPUT/tables.md and plots. The same arguments give the same files.

With another --seed every plane has another place and direction and every hand another tremble: what was tuned to one seed's
drawings does not help on another's.
"""
import argparse
import csv
import json
import multiprocessing
import os
import pathlib
import subprocess
import sys
import tempfile

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is loaded

import nibabel
import numpy as np
from scipy import ndimage, spatial

import hands
import organ_sources
import organs_report
import plain
import shape_groups
import slices
import structures

INDEX_FIELDS = ["structure", "group", "source", "voxels", "volume_ml", "elongation", "fill", "parts", "at_border", "coarsened"]
RESULT_FIELDS = ["structure", "group", "drawing", "hand", "method", "dice", "dice_left_out", "hausdorff95_mm", "mean_mm"]
KONTUR = {
    "kontur": [],
    "in-plane normals": ["--normals", "in-plane", "--smoothing", "1e-5"],  # all else as the defaults have it
    "r^3": ["--kernel", "triharmonic"],
    "paper": ["--kernel", "triharmonic", "--normals", "in-plane", "--normal-offset-mm", "1", "--solver", "cholesky"],
}
PEERS = {"shape-based": slices.shape_based, "nearest slice": slices.repeated}  # on slices alone
METHODS = ["kontur", "plain", *PEERS]
PLAIN = argparse.Namespace(points=700, smoothing=2e-4)  # as plain.py's own


def voxel_of(affine):
    return np.linalg.norm(affine[:3, :3], axis=0).min()


def leave_out_if_flat(file):
    """What lies in fewer than two planes is no drawing of a body: the planes missed it, or its section was below a voxel."""
    if sum(bool(plane["contours"]) for plane in json.loads(file.read_text())["planes"]) < 2:
        file.unlink()


def draw_planes(folder, name, points, affine, options, with_hands):
    """The five sets of planes, exactly and by each hand."""
    voxel = voxel_of(affine)
    for drawing, planes in structures.PLANE_SETS.items():
        random = structures.random_for(*filter(None, (options.seed, name, drawing)))
        cut = structures.turned(drawing, points, random) if options.seed else planes(points, random)
        structures.cut(options.kontur, folder, drawing, cut, voxel**2)
        exact = json.loads((folder / f"{drawing}.json").read_text())
        for hand in hands.HANDS if with_hands else ():
            drawn = hands.by_hand(exact, hand, voxel, structures.random_for(options.seed, name, drawing, hand))
            (folder / f"{drawing}.{hand}.json").write_text(json.dumps(drawn))
        for file in folder.glob(f"{drawing}*.json"):
            leave_out_if_flat(file)


def draw_slices(folder, truth, affine, kontur):
    for step in slices.STEPS:
        kept = slices.kept(truth, step)
        if len(kept):
            structures.cut(kontur, folder, f"slices{step}", slices.slice_planes(kept, affine), voxel_of(affine) ** 2)
            leave_out_if_flat(folder / f"slices{step}.json")


def draw_real_slices(folder, truth, affine, planes):
    """The contours that were drawn by hand on the kept slices."""
    at = slices.slice_numbers(planes, affine)
    for step in slices.STEPS:
        kept = slices.kept(truth, step)
        drawn = [plane for plane, number in zip(planes, at) if np.abs(kept - number).min(initial=1) < 0.25]
        if len(drawn) > 1:
            (folder / f"slices{step}.json").write_text(json.dumps({"frame": "LPS mm", "planes": drawn}))


def described(name, group, source, truth, affine, factors, mask):
    elongation, fill = shape_groups.measures(truth, affine)
    volume = truth.sum() * abs(np.linalg.det(affine[:3, :3])) / 1000
    parts = ndimage.label(truth, np.ones((3, 3, 3)))[1]
    return [name, group, pathlib.Path(source).name, truth.sum(), f"{volume:.2f}", f"{elongation:.2f}", f"{fill:.3f}", parts,
            int(structures.touches_border(mask)), "x".join(map(str, factors))]


def draw(options):
    drawings = options.output / "drawings"
    drawn_by_group = dict.fromkeys(organs_report.GROUPS, 0)
    with open(options.output / "structures.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(INDEX_FIELDS)
        for name, (mask, affine, source) in organ_sources.label_maps(options.data, options.kontur).items():
            truth, grid, factors = structures.truth_of(mask, affine)
            group = shape_groups.group(truth, grid)
            structures.write_truth(drawings / name, truth, grid)
            with_hands = drawn_by_group[group] % options.hands_every == 0
            draw_planes(drawings / name, name, structures.voxel_points(truth, grid), grid, options, with_hands)
            draw_slices(drawings / name, truth, grid, options.kontur)
            drawn_by_group[group] += 1
            table.writerow(described(name, group, source, truth, grid, factors, mask))
            print(f"drawn {name}", file=sys.stderr)
        for name, (mask, affine, source, planes) in organ_sources.structure_sets(options.data, options.kontur).items():
            truth, grid, factors = structures.truth_of(mask, affine)
            structures.write_truth(drawings / name, truth, grid)
            draw_real_slices(drawings / name, truth, grid, planes)
            table.writerow(described(name, "real drawing", source, truth, grid, factors, mask))
            print(f"drawn {name}", file=sys.stderr)


def surface_points(mask, affine):
    return np.argwhere(mask & ~ndimage.binary_erosion(mask)) @ affine[:3, :3].T


def surface_distances(a, b, affine):
    """The 95th percentile and the mean of the distances from either mask's border voxels to the other's, mm."""
    first, second = (surface_points(mask, affine) for mask in (a, b))
    if not len(first) or not len(second):
        return np.inf, np.inf
    both = np.concatenate([spatial.cKDTree(second).query(first)[0], spatial.cKDTree(first).query(second)[0]])
    return np.percentile(both, 95), both.mean()


def kontur_mask(kontur, drawing, truth_file, extra):
    """Empty where kontur refuses the drawing, which is said."""
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder, "mask.nii")
        done = subprocess.run([kontur, "segment", drawing, "--image", truth_file, "--output", output, "--threads", "1", "--quiet",
                               *extra], capture_output=True, text=True)
        if done.returncode:
            print(f"{drawing.parent.name}/{drawing.stem}: {done.stderr.strip()}", file=sys.stderr)
            return np.zeros(nibabel.load(truth_file).shape, bool)
        return np.asarray(nibabel.load(output).dataobj) > 0


def segmented(method, drawing, truth, affine, kept, kontur):
    truth_file = drawing.with_name("truth.nii.gz")
    if method in KONTUR:
        return kontur_mask(kontur, drawing, truth_file, KONTUR[method])
    if method == "plain":
        return plain.segment(plain.read_drawing(drawing), truth.shape, affine, PLAIN)
    return PEERS[method](truth, kept, np.linalg.norm(affine[:3, :3], axis=0))


def measured(mask, truth, affine, kept):
    """Dice; on slices also that of the layers left out between the first and the last kept; and distances of the surfaces."""
    left_out = [k for k in range(kept[0], kept[-1]) if k not in kept] if len(kept) else []
    inner = f"{plain.dice(mask[:, :, left_out], truth[:, :, left_out]):.5f}" if left_out else ""
    return [f"{plain.dice(mask, truth):.5f}", inner, *(f"{d:.3f}" for d in surface_distances(mask, truth, affine))]


def measure_structure(task):
    """Rows of all drawings of one structure."""
    folder, group, options = task
    part = options.output / "results" / f"{folder.name}.csv"
    if options.keep and part.exists():
        return part
    truth, affine = plain.read_truth(folder / "truth.nii.gz")
    rows = []
    for drawing in sorted(folder.glob("*.json")):
        planes, _, hand = drawing.stem.partition(".")
        step = int(planes.removeprefix("slices")) if planes.startswith("slices") else 0
        kept = slices.kept(truth, step) if step else []
        for method in options.methods:
            if step or method not in PEERS:
                mask = segmented(method, drawing, truth, affine, kept, options.kontur)
                rows.append([folder.name, group, planes, hand or "exact", method, *measured(mask, truth, affine, kept)])
    with open(part, "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows(rows)
    return part


def measure(options):
    with open(options.output / "structures.csv", newline="", encoding="utf-8") as file:
        listed = list(csv.DictReader(file))
    real = [row for row in listed if row["group"] == "real drawing"]
    some = [row for row in listed if row not in real][::options.every]
    tasks = [(options.output / "drawings" / row["structure"], row["group"], options) for row in (*some, *real)]
    (options.output / "results").mkdir(exist_ok=True)
    with multiprocessing.Pool(options.jobs) as pool:
        parts = []
        for part in pool.imap(measure_structure, tasks):
            parts.append(part)
            print(f"measured {part.stem}, {len(parts)} of {len(tasks)}", file=sys.stderr)
    with open(options.output / "results.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerow(RESULT_FIELDS)
        for part in parts:
            file.write(part.read_text(encoding="utf-8"))


def report(options):
    organs_report.write(options.output / "results.csv", options.output)


def main():
    stages = {"draw": draw, "measure": measure, "report": report}
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--kontur", required=True, type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("--hands-every", type=int, default=4, metavar="N", help="which share of the structures hands draw")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="measure every N-th structure of the label maps only")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--seed", default="", help="any text: other planes, other hands")
    parser.add_argument("--keep", action="store_true", help="do not measure again what has been measured in OUTPUT")
    parser.add_argument("--methods", nargs="+", default=METHODS, choices=[*KONTUR, "plain", *PEERS])
    parser.add_argument("--only", choices=stages)
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    for name, stage in stages.items():
        if options.only in (None, name):
            stage(options)


if __name__ == "__main__":
    main()
