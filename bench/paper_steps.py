#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What lies between kontur's implementation of the paper's method and plain.py's, one change at a time.

Usage: bench/paper_steps.py --kontur build/release/bin/kontur [--every N] [--variants NAME...] FOLDER... > steps.csv

FOLDER is as kontur_accuracy takes it; of all structures, sorted by name, every N-th is taken. Prints the Dice of each drawing
and variant as CSV. `docs/accuracy/organs.md` says what came out.
"""
import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is loaded

import nibabel
import numpy as np

import plain

PAPER = ["--kernel", "triharmonic", "--normals", "in-plane", "--solver", "cholesky"]
FIXED_OFFSET = ["--normal-offset-mm", "1"]
SCATTER = ["--smoothing", "3.2e-7"]  # plain's: the square of 0.02 % of the diameter, its r^3 in radii instead of diameters
EVERYWHERE = ["--voxelizer", "exhaustive"]
# (options of kontur, whether its contours are resampled as plain.py does)
OURS = {
    "kontur's": (FIXED_OFFSET, False),
    "kontur's, offset 0.45 %": ([], False),
    "kontur's, scatter": ([*FIXED_OFFSET, *SCATTER], False),
    "kontur's, plain's points": (FIXED_OFFSET, True),
    "kontur's, all that is positive": ([*FIXED_OFFSET, *EVERYWHERE], False),
    "kontur's, offset and scatter": (SCATTER, False),
    "kontur's, offset and points": ([], True),
    "kontur's, offset, points and scatter": (SCATTER, True),
}


def evenly(drawing, count):
    """A contour file's content with its contours resampled as plain.constraints resamples them."""
    lines = [np.array(contour["points"]) for plane in drawing["planes"] for contour in plane["contours"]]
    step = sum(plain.side_lengths(points).sum() for points in lines) / count
    planes = []
    for plane in drawing["planes"]:
        origin, axes = np.array(plane["origin"]), np.array([plane["u"], plane["v"]])
        contours = [contour | {"points": (origin + plain.resampled((np.array(contour["points"]) - origin) @ axes.T, step) @ axes).tolist()}
                    for contour in plane["contours"]]
        planes.append(plane | {"contours": contours})
    return {"frame": "LPS mm", "planes": planes}


def kontur_mask(path, kontur, extra, resample):
    with tempfile.TemporaryDirectory() as folder:
        drawing, output = pathlib.Path(folder, "drawing.json"), pathlib.Path(folder, "mask.nii")
        contents = json.loads(path.read_text())
        drawing.write_text(json.dumps(evenly(contents, 700) if resample else contents))
        subprocess.run([kontur, "segment", drawing, "--image", path.with_name("truth.nii.gz"), "--output", output, "--quiet",
                        "--threads", "1", *PAPER, *extra], check=True, capture_output=True)
        return np.asarray(nibabel.load(output).dataobj) > 0


def plain_mask(path, truth, affine, points=700, smoothing=2e-4, offset_mm=None, touched=True):
    planes = plain.read_drawing(path)
    drawn = np.vstack([origin + polygon @ axes for origin, axes, polygons in planes for polygon in polygons])
    diameter = 2 * np.linalg.norm(drawn - (drawn.min(axis=0) + drawn.max(axis=0)) / 2, axis=1).max()
    saved = plain.OFFSET, plain.touched
    try:
        plain.OFFSET = offset_mm / diameter if offset_mm else plain.OFFSET
        plain.touched = plain.touched if touched else lambda mask, indices: mask
        return plain.segment(planes, truth.shape, affine, argparse.Namespace(points=points, smoothing=smoothing))
    finally:
        plain.OFFSET, plain.touched = saved


PLAINS = {
    "plain": {},
    "plain, offset 1 mm": {"offset_mm": 1},
    "plain, no scatter": {"smoothing": 0},
    "plain, 1400 points": {"points": 1400},
    "plain, all that is positive": {"touched": False},
    "plain, offset 1 mm, no scatter": {"offset_mm": 1, "smoothing": 0},
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", type=pathlib.Path)
    parser.add_argument("--kontur", required=True, type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--variants", nargs="+", choices=[*OURS, *PLAINS], default=[*OURS, *PLAINS])
    options = parser.parse_args()
    table = csv.writer(sys.stdout)
    table.writerow(["structure", "drawing", "variant", "dice"])
    structures = sorted((path for folder in options.folders for path in folder.iterdir() if path.is_dir()), key=lambda path: path.name)
    for path in (drawing for structure in structures[::options.every] for drawing in sorted(structure.glob("*.json"))):
        truth, affine = plain.read_truth(path.with_name("truth.nii.gz"))
        for variant in options.variants:
            mask = (plain_mask(path, truth, affine, **PLAINS[variant]) if variant in PLAINS
                    else kontur_mask(path, options.kontur, *OURS[variant]))
            table.writerow([path.parent.name, path.stem, variant, f"{plain.dice(mask, truth):.5f}"])
            sys.stdout.flush()


if __name__ == "__main__":
    main()
