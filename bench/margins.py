#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How far the surfaces of margins around real organs are from where ITK's signed distance has them, and how long a margin takes.

Usage: bench/margins.py DATA OUTPUT.csv --kontur build/release/bin/kontur --itk build/release/bin/itk_distance

itk_distance is built where CMake is told to, with Debian's libinsighttoolkit5-dev: -DKONTUR_ITK_DISTANCE=ON.

with kontur's Python package on PYTHONPATH. Ten organs out of the label maps of DATA, evenly, each as kontur makes it of outlines on
every third slice and on two planes across. A margin of 5 mm outwards and 3 mm inwards begins at the function's surface, or at that
of its mask. ITK measures voxels a quarter as long, on which the same function is filled. A row has the distances of the margin's
points from ITK's surface, in lengths of a voxel across that surface: their mean, and the mean of what they are off.

The last row is the time of a margin of 5 mm on 512 x 512 x 300 voxels of 0.8 x 0.8 x 1 mm, of an organ of 1.5 l.
"""
import argparse
import csv
import pathlib
import subprocess
import sys
import tempfile
import time

import kontur
import nibabel
import numpy as np
from scipy import ndimage

import organ_sources
import structures

MAPS = ("abdomen", "brain", "cord", "torso")
ORGANS, FINER = 10, 4
MARGINS = {"5 mm outwards": ("+ 5 mm", 5.0), "3 mm inwards": ("- 3 mm", -3.0)}
MOST_FINE_VOXELS = 300e6


def cropped(mask, affine, margin_mm):
    """The part of a mask that a margin may reach, with voxels to spare; its affine."""
    spacing = np.linalg.norm(affine[:3, :3], axis=0)
    spare = np.ceil(margin_mm / spacing).astype(int) + 3
    places = np.argwhere(mask)
    low, high = places.min(0) - spare, places.max(0) + spare + 1
    part = np.zeros(high - low, np.uint8)
    inner = tuple(slice(max(0, a), min(n, b)) for a, b, n in zip(low, high, mask.shape))
    part[tuple(slice(one.start - a, one.stop - a) for one, a in zip(inner, low))] = mask[inner]
    affine = affine.copy()
    affine[:3, 3] += affine[:3, :3] @ low
    return part, affine


def outlines_of(part, grid):
    """On every third slice, and on two planes across the middle of what is inside."""
    mask = kontur.Mask(np.ascontiguousarray(part.transpose(2, 1, 0)), grid)
    affine, places = grid.affine("LPS"), np.argwhere(part)
    middle = affine[:3, :3] @ places.mean(0) + affine[:3, 3]
    normals = np.linalg.inv(affine[:3, :3])  # its rows are across slices
    slices = range(places[:, 2].min() + 1, places[:, 2].max(), 3)
    planes = [kontur.Plane(affine[:3, 3] + affine[:3, 2] * k, normals[2]) for k in slices]
    return kontur.trace(mask, planes + [kontur.Plane(middle, normals[axis]) for axis in (0, 1)])


def finer(grid):
    """The grid of which each voxel of `grid` is FINER voxels along each axis."""
    affine = grid.affine("LPS").copy()
    affine[:3, 3] -= affine[:3, :3] @ np.full(3, (FINER - 1) / (2 * FINER))
    affine[:3, :3] /= FINER
    return kontur.Grid([FINER * n for n in grid.size], affine, frame="LPS")


def itk_distances(mask, spacing, itk, folder):
    """On the divided voxels, mm, negative inside; by i, j, k."""
    nibabel.save(nibabel.Nifti1Image(mask.values.transpose(2, 1, 0), np.diag([*spacing / FINER, 1])), folder / "fine.nii")
    subprocess.run([itk, folder / "fine.nii", folder / "distances.nii"], check=True)
    return np.asarray(nibabel.load(folder / "distances.nii").dataobj)


def surface_points(rule, structure, affine):
    """Where the surface of what the rule makes crosses slices, in voxels."""
    contours = list(kontur.derive([f"X = A {rule}"], {"A": structure})["X"].outlines)
    if not contours:
        return np.empty((0, 3))
    points = np.concatenate([contour.points for contour in contours])
    return (points - affine[:3, 3]) @ np.linalg.inv(affine[:3, :3]).T


def errors(points, distances, by, spacing):
    """Signed, in lengths of a voxel across ITK's surface."""
    places = (points + 0.5) * FINER - 0.5
    found = ndimage.map_coordinates(distances, places.T, order=1, mode="nearest")
    slopes = np.stack([ndimage.map_coordinates(distances, (places + step).T, order=1, mode="nearest") -
                       ndimage.map_coordinates(distances, (places - step).T, order=1, mode="nearest") for step in FINER / 2 * np.eye(3)], 1)
    normals = slopes / spacing
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    return (found - by) / np.linalg.norm(normals * spacing, axis=1)


def rows_of(name, mask, affine, itk):
    spacing = np.linalg.norm(affine[:3, :3], axis=0)
    part, place = cropped(mask, affine, max(by for _, by in MARGINS.values()))
    if part.size * FINER**3 > MOST_FINE_VOXELS:
        return print(f"margins.py: {name} has too many voxels and is left out", file=sys.stderr)
    grid = kontur.Grid(part.shape, place, frame="LPS")
    outlines = outlines_of(part, grid)
    organ = kontur.segment(outlines, grid)
    with tempfile.TemporaryDirectory() as folder:
        distances = itk_distances(kontur.segment(outlines, finer(grid)).mask, spacing, itk, pathlib.Path(folder))
    for source, structure in (("function", organ), ("mask", organ.mask)):
        for margin, (rule, by) in MARGINS.items():
            points = surface_points(rule, structure, place)
            if len(points):
                off = errors(points, distances, by, spacing)
                yield {"structure": name, "source": source, "margin": margin, "points": len(points), "mean_voxels": f"{off.mean():.3f}",
                       "spacing_mm": " x ".join(f"{length:.2f}" for length in spacing), "mean_off_voxels": f"{abs(off).mean():.3f}"}


def timed(repeat=5):
    """Medians of wall time and of processor time of a margin on a large image."""
    k, j, i = np.ogrid[:300, :512, :512]
    body = ((i - 256) * 0.8 / 80) ** 2 + ((j - 256) * 0.8 / 70) ** 2 + ((k - 150) / 64.0) ** 2 < 1
    mask = kontur.Mask(body, kontur.Grid((512, 512, 300), np.diag([0.8, 0.8, 1.0, 1.0]), frame="LPS"))
    times = []
    for _ in range(repeat):
        start = time.perf_counter(), time.process_time()
        kontur.derive(["X = A + 5 mm"], {"A": mask})
        times.append((time.perf_counter() - start[0], time.process_time() - start[1]))
    wall, processors = np.median(times, axis=0)
    return {"structure": f"ellipsoid of {mask.volume_ml:.0f} ml", "source": "mask", "margin": "5 mm outwards", "spacing_mm": "0.80 x 0.80 x 1.00",
            "seconds": f"{wall:.2f}", "cpu_s": f"{processors:.2f}"}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--kontur", required=True)
    parser.add_argument("--itk", required=True, type=pathlib.Path)
    options = parser.parse_args()
    maps = structures.collect([f"{name}={options.data / organ_sources.LABEL_MAPS[name]}" for name in MAPS], [], options.kontur)
    names = sorted(maps)
    chosen = [names[n * len(names) // ORGANS] for n in range(ORGANS)]
    with open(options.output, "w", newline="") as output:
        writer = csv.DictWriter(output, ["structure", "source", "margin", "spacing_mm", "points", "mean_voxels", "mean_off_voxels", "seconds", "cpu_s"])
        writer.writeheader()
        for name in chosen:
            mask, affine, _ = maps[name]
            for row in rows_of(name, mask, affine, options.itk.resolve()):
                writer.writerow(row)
                output.flush()
        writer.writerow(timed())


if __name__ == "__main__":
    main()
