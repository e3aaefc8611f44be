#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Smooth bodies for simulated annotators, from every structure that organ_sources.py finds in a folder of scans.

Usage: bench/annotators/truths.py DATA OUTPUT --kontur build/release/bin/kontur

Each structure becomes OUTPUT/SET/NAME: `fine.nii.gz`, a mask of cubes of which 128 go along the structure's longest side, with
a margin of 24, for the annotator to cut; `distance.nii.gz`, on every second of its voxels the signed distance in mm to the mask's
border, positive inside. Voxel steps are no anatomy: masks are smoothed by half a coarse cube, and layers more than 1.8 times as
thick as wide are interpolated by shape. SET is `tune` and `report` in turn, by name. Parts below 5 % of the largest are left out.
Where there is an image, `image.nii.gz` is what of it lies within half of the longest side around the structure.
"""
import argparse
import functools
import pathlib
import subprocess
import sys
import tempfile

import nibabel
import numpy as np
from scipy import ndimage

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import organ_sources  # noqa: E402

CELLS, MARGIN = 64, 12  # coarse: along the longest side; on every side
LPS = np.diag([-1.0, -1.0, 1.0, 1.0])


def without_crumbs(mask, least=0.05):
    labels, count = ndimage.label(mask)
    if count < 2:
        return mask
    sizes = np.bincount(labels.ravel())[1:]
    return np.isin(labels, 1 + np.flatnonzero(sizes > least * sizes.max()))


def shape_field(mask, width):
    """Signed distance in mm within each layer along the last axis; beyond the ends as deep outside as the end is inside."""
    field = np.full(mask.shape, -60.0, np.float32)
    filled = mask.any(axis=(0, 1))
    for k in np.flatnonzero(filled):
        inside, outside = (ndimage.distance_transform_edt(m) for m in (mask[:, :, k], ~mask[:, :, k]))
        field[:, :, k] = np.clip((inside - outside) * width, -60, 60)
    for k in np.flatnonzero(~filled):
        neighbours = [j for j in (k - 1, k + 1) if 0 <= j < mask.shape[2] and filled[j]]
        if neighbours:
            field[:, :, k] = -field[:, :, neighbours[0]].max()
    return field


def smooth_field(mask, affine):
    """Positive inside, on cubes along the patient's axes; their affine to LPS mm and size."""
    found = np.argwhere(mask)
    low, high = np.maximum(found.min(axis=0) - 2, 0), found.max(axis=0) + 3
    mask = np.pad(mask[tuple(slice(a, b) for a, b in zip(low, high))], 2)
    affine = affine @ np.block([[np.eye(3), (low - 2.0)[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]])
    points = np.argwhere(mask) @ affine[:3, :3].T + affine[:3, 3]
    first, last = points.min(axis=0), points.max(axis=0)
    cube = (last - first).max() / CELLS
    shape = np.ceil((last - first) / cube).astype(int) + 1 + 2 * MARGIN
    grid = np.diag([cube, cube, cube, 1.0])
    grid[:3, 3] = first - MARGIN * cube
    to_index = np.linalg.inv(affine) @ grid
    index = (to_index[:3, :3] @ np.indices(shape).reshape(3, -1)) + to_index[:3, 3:]
    spacing = np.linalg.norm(affine[:3, :3], axis=0)
    if spacing[2] > 1.8 * spacing[0]:
        values = ndimage.map_coordinates(shape_field(mask, spacing[0]), index, order=1, mode="nearest")
        return ndimage.gaussian_filter(values.reshape(shape), 0.8), grid
    values = ndimage.map_coordinates(mask.astype(np.float32), index, order=1, cval=0).reshape(shape) - 0.5
    return ndimage.gaussian_filter(values, 0.6), grid


def fine_mask(field):
    index = np.indices([2 * n - 1 for n in field.shape]).reshape(3, -1) / 2.0
    fine = ndimage.map_coordinates(field, index, order=1).reshape([2 * n - 1 for n in field.shape])
    return without_crumbs(fine > 0)


def save(path, values, affine):
    image = nibabel.Nifti1Image(values, LPS @ affine)
    image.set_sform(LPS @ affine, 1)
    image.set_qform(None, 0)
    nibabel.save(image, path)


def write(folder, mask, affine):
    field, grid = smooth_field(without_crumbs(mask), affine)
    fine = fine_mask(field)
    half = grid @ np.diag([0.5, 0.5, 0.5, 1])
    step = half[0, 0]
    inside, outside = ndimage.distance_transform_edt(fine), ndimage.distance_transform_edt(~fine)
    distance = np.where(fine, inside - 0.5, 0.5 - outside) * step
    folder.mkdir(parents=True, exist_ok=True)
    save(folder / "fine.nii.gz", fine.astype(np.uint8), half)
    save(folder / "distance.nii.gz", distance[::2, ::2, ::2].astype(np.float32), grid)


@functools.cache
def read_image(file, frame, kontur):
    """Values along (x, y, z) and the affine to LPS mm."""
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder, "image.nii.gz")
        subprocess.run([kontur, "convert", file, copy, "--quiet", *([] if frame is None else ["--frame", str(frame)])], check=True)
        image = nibabel.load(copy)
        return np.asarray(image.dataobj), LPS @ image.affine


def write_image(folder, values, affine):
    """What lies around the body."""
    coarse = nibabel.load(folder / "distance.nii.gz")
    shape, grid = np.array(coarse.shape), LPS @ coarse.affine
    spare = CELLS // 2 - MARGIN
    corners = np.array(np.meshgrid(*[(-spare, n - 1 + spare) for n in shape])).reshape(3, -1)
    to_index = np.linalg.inv(affine) @ grid
    index = to_index[:3, :3] @ corners + to_index[:3, 3:]
    low = np.clip(np.floor(index.min(axis=1)).astype(int), 0, np.array(values.shape) - 2)
    high = np.clip(np.ceil(index.max(axis=1)).astype(int) + 1, low + 2, values.shape)
    shift = np.eye(4)
    shift[:3, 3] = low
    save(folder / "image.nii.gz", values[tuple(slice(a, b) for a, b in zip(low, high))], affine @ shift)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--kontur", required=True, type=lambda path: pathlib.Path(path).resolve())
    options = parser.parse_args()
    found = dict(organ_sources.label_maps(options.data, options.kontur))
    found |= organ_sources.structure_sets(options.data, options.kontur)
    for number, (name, (mask, affine, *_)) in enumerate(sorted(found.items())):
        folder = options.output / ("report" if number % 2 else "tune") / name
        if not folder.exists():
            write(folder, mask, affine)
        image = organ_sources.image_of(name, options.data)
        if image and not (folder / "image.nii.gz").exists():
            write_image(folder, *read_image(*image, options.kontur))
        print(folder, file=sys.stderr)


if __name__ == "__main__":
    main()
