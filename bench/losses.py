#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Where masks are wrong, too much or missing, within the convex hull of what was drawn or beyond: those of kontur, of the plain
method, and of kontur with in-plane normals, between the two.

Usage: bench/losses.py DRAWINGS --kontur build/release/bin/kontur [--every N] [--methods METHOD...] > losses.csv

DRAWINGS is what organs.py has drawn, or a folder as kontur_accuracy takes it; of all structures every N-th is taken, of its
drawings the exact ones. Shares are of the truth's volume. A table of their means goes to stderr.
"""
import argparse
import csv
import json
import os
import pathlib
import statistics
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is loaded

import numpy as np
from scipy import spatial

import organs
import plain
from tables import table

METHODS = ["plain", "kontur", "in-plane normals"]
SHARES = ["too much within", "too much beyond", "missing within", "missing beyond"]


def within_hull(points, shape, affine):
    """Voxels whose centres lie in the convex hull of points, which must not all lie in one plane."""
    sides = spatial.ConvexHull(points).equations
    index_sides = sides[:, :3] @ affine[:3, :3], sides[:, :3] @ affine[:3, 3] + sides[:, 3]
    inside = np.ones(shape, bool)
    for normal, offset in zip(*index_sides):
        parts = [(normal[axis] * np.arange(shape[axis])).reshape([-1 if a == axis else 1 for a in range(3)]) for axis in range(3)]
        inside &= parts[0] + parts[1] + parts[2] + offset <= 1e-6
    return inside


def shares(mask, truth, within):
    volume = truth.sum()
    return [(wrong & where).sum() / volume for wrong in (mask & ~truth, truth & ~mask) for where in (within, ~within)]


def drawn_points(path):
    return np.array([p for plane in json.loads(path.read_text())["planes"] for c in plane["contours"] for p in c["points"]])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("drawings", type=pathlib.Path)
    parser.add_argument("--kontur", required=True, type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--methods", nargs="+", default=METHODS, choices=[*organs.KONTUR, "plain"])
    options = parser.parse_args()
    output = csv.writer(sys.stdout)
    output.writerow(["structure", "drawing", "method", "dice", *SHARES])
    found = {}
    for folder in sorted(path for path in options.drawings.iterdir() if path.is_dir())[::options.every]:
        truth, affine = plain.read_truth(folder / "truth.nii.gz")
        for path in sorted(path for path in folder.glob("*.json") if "." not in path.stem):
            within = within_hull(drawn_points(path), truth.shape, affine)
            for method in options.methods:
                mask = organs.segmented(method, path, truth, affine, [], options.kontur)
                row = [plain.dice(mask, truth), *shares(mask, truth, within)]
                found.setdefault((path.stem, method), []).append(row)
                output.writerow([folder.name, path.stem, method, *(f"{value:.5f}" for value in row)])
                sys.stdout.flush()
    rows = [[drawing, len(own), method, *(f"{statistics.fmean(column):.4f}" for column in zip(*own))]
            for (drawing, method), own in sorted(found.items())]
    print(table(["planes", "drawings", "method", "Dice", *SHARES], rows), file=sys.stderr)


if __name__ == "__main__":
    main()
