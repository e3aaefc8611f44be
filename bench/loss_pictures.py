#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Two solids cut in slices, on which kontur is behind one peer or the other: docs/losses.md.

Usage: bench/loss_pictures.py --kontur build/release/bin/kontur PICTURE.png. Prints the Dice of each.
"""
import argparse
import os
import pathlib
import tempfile

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is loaded

import numpy as np

import organs
import plain
import slices
import structures
from plots import METHOD_COLOURS, pyplot, save

METHODS = ("kontur", "plain", "shape-based")
STEP = 4  # of 3 mm


def coordinates(half):
    """x, y, z of voxels of 1 x 1 x 3 mm in a box of twice `half` mm around 0, and their affine."""
    spacing = np.array([1, 1, 3])
    affine = np.diag([*spacing, 1.0])
    affine[:3, 3] = -np.array(half)
    indices = np.indices(2 * np.array(half) // spacing + 1)
    return *(n * d - h for n, d, h in zip(indices, spacing, half)), affine


def cut_flat():
    x, y, z, affine = coordinates((50, 50, 48))
    return (x**2 + y**2 + (z + 12) ** 2 < 34**2) & (z > -24), affine


def slanted_plate():
    x, y, z, affine = coordinates((55, 45, 54))
    along, across = x * 0.5 + z * 0.866, x * 0.866 - z * 0.5
    return (np.abs(across) < 3) & (np.abs(y) < 22) & (np.abs(along) < 32), affine


CASES = [("cut off flat", cut_flat), ("a slanted plate of 6 mm", slanted_plate)]


def masks_of(truth, affine, kontur):
    """Of each method, and the heights of the slices that were kept, mm."""
    kept = slices.kept(truth, STEP)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        structures.write_truth(folder, truth, affine)
        structures.cut(kontur, folder, "slices", slices.slice_planes(kept, affine), 1.0)
        masks = {m: organs.segmented(m, folder / "slices.json", truth, affine, kept, kontur) for m in METHODS}
    return masks, affine[2, 3] + affine[2, 2] * kept


def show(axes, title, truth, affine, kontur):
    """The section at y = 0."""
    masks, heights = masks_of(truth, affine, kontur)
    across, _, up = (affine[a, 3] + affine[a, a] * np.arange(n) for a, n in enumerate(truth.shape))
    middle = truth.shape[1] // 2
    axes.contourf(across, up, truth[:, middle].T, levels=[0.5, 1.5], colors=["#ddd"])
    for height in heights:
        axes.axhline(height, color="#999", linewidth=0.6, linestyle=":")
    for method, mask in masks.items():
        axes.contour(across, up, mask[:, middle].T, levels=[0.5], colors=[METHOD_COLOURS[method]], linewidths=1.3)
        axes.plot([], [], color=METHOD_COLOURS[method], label=f"{method}: {plain.dice(mask, truth):.3f}")
        print(f"{title}: {method} {plain.dice(mask, truth):.4f}")
    axes.set(title=f"{title}, slices {STEP * affine[2, 2]:.0f} mm apart", aspect="equal")
    axes.set_axis_off()
    axes.legend(title="Dice", fontsize=8, title_fontsize=8, loc="upper right")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("picture")
    parser.add_argument("--kontur", required=True, type=lambda path: pathlib.Path(path).resolve())
    options = parser.parse_args()
    figure, panels = pyplot.subplots(1, len(CASES), figsize=(9, 4.2))
    for axes, (title, solid) in zip(panels, CASES):
        show(axes, title, *solid(), options.kontur)
    save(figure, options.picture)


if __name__ == "__main__":
    main()
