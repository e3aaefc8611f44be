#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The method of Heckel et al. (2010) done plainly, in dense NumPy that shares nothing with kontur: a peer to be compared with.

Usage: bench/plain.py [--points N] [--smoothing S] SET=FOLDER... > plain.csv

FOLDER is as kontur_accuracy takes it. Prints the Dice of each drawing as CSV: set, structure, drawing, dice. Lengths are in
diameters of the drawing. Contours are resampled evenly; each point has a value of 0 and, beside it in its plane, 0.0045
outwards, one of -0.0045; r^3 with a linear polynomial, smoothed slightly; the mask is what is positive and connected to a
contour.
"""
import argparse
import csv
import json
import os
import pathlib
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is loaded

import nibabel
import numpy as np
from scipy import linalg, ndimage

OFFSET = 0.0045
LEAST_POINTS = 16  # of a contour
WHOLE_VOXELS = 300_000  # beyond these, every third voxel first, and all where the sign changes
LPS = np.diag([-1.0, -1.0, 1.0, 1.0])


def read_drawing(path):
    """For each plane: its origin, its axes as rows, its closed contours in the plane's coordinates."""
    planes = []
    for plane in json.loads(path.read_text())["planes"]:
        origin, axes = np.array(plane["origin"]), np.array([plane["u"], plane["v"]])
        planes.append((origin, axes, [(np.array(c["points"]) - origin) @ axes.T for c in plane["contours"]]))
    return planes


def read_truth(path):
    image = nibabel.load(path)
    return np.asarray(image.dataobj) > 0, LPS @ image.affine


def side_lengths(polygon):
    return np.linalg.norm(np.roll(polygon, -1, axis=0) - polygon, axis=1)


def resampled(polygon, step):
    closed = np.vstack([polygon, polygon[:1]])
    along = np.r_[0, np.cumsum(side_lengths(polygon))]
    count = max(LEAST_POINTS, round(along[-1] / step))
    at = np.arange(count) * along[-1] / count
    return np.column_stack([np.interp(at, along, closed[:, axis]) for axis in range(2)])


def inside(polygons, points):
    """By the even-odd rule."""
    found = np.zeros(len(points), bool)
    for polygon in polygons:
        for (x0, y0), (x1, y1) in zip(polygon, np.roll(polygon, -1, axis=0)):
            crosses = (y0 > points[:, 1]) != (y1 > points[:, 1])
            if crosses.any():
                found[crosses] ^= points[crosses, 0] < x0 + (points[crosses, 1] - y0) / (y1 - y0) * (x1 - x0)
    return found


def outward_normals(points, polygons, offset):
    """Of a resampled contour, in its plane; which side is outside is said by most of its points."""
    tangents = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
    normals = np.column_stack([tangents[:, 1], -tangents[:, 0]])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    return -normals if inside(polygons, points + offset / 2 * normals).mean() > 0.5 else normals


def constraints(planes, diameter, count):
    """Points on the contours and outward normals there, mm."""
    step = sum(side_lengths(polygon).sum() for _, _, polygons in planes for polygon in polygons) / count
    points, normals = [], []
    for origin, axes, polygons in planes:
        for polygon in polygons:
            even = resampled(polygon, step)
            points.append(origin + even @ axes)
            normals.append(outward_normals(even, polygons, OFFSET * diameter) @ axes)
    return np.vstack(points), np.vstack(normals)


def cubed_distances(a, b):
    squared = (a**2).sum(axis=1)[:, None] + (b**2).sum(axis=1) - 2 * a @ b.T
    np.maximum(squared, 0, out=squared)
    return squared * np.sqrt(squared)


def fitted(points, normals, smoothing):
    """f, positive inside; all in diameters. `smoothing` is the scatter that the points' values are granted."""
    centres = np.vstack([points, points + OFFSET * normals])
    values = np.r_[np.zeros(len(points)), np.full(len(points), -OFFSET)]
    linear = np.column_stack([np.ones(len(centres)), centres])
    kernel = cubed_distances(centres, centres) + smoothing**2 * np.eye(len(centres))
    system = np.block([[kernel, linear], [linear.T, np.zeros((4, 4))]])
    solution = linalg.solve(system, np.r_[values, np.zeros(4)], assume_a="sym")
    weights, plane = solution[:-4], solution[-4:]

    def function(places):
        pieces = np.array_split(places, len(places) // 400 + 1)
        return np.concatenate([cubed_distances(p, centres) @ weights + plane[0] + p @ plane[1:] for p in pieces])

    return function


def positive(function, shape):
    """Where f, a function of voxel indices, is positive; on a large grid it is taken everywhere only near a change of sign."""
    if np.prod(shape) <= WHOLE_VOXELS:
        return function(np.indices(shape).reshape(3, -1).T).reshape(shape) > 0
    some = tuple(slice(None, None, 3) for _ in shape)
    coarse_indices = np.stack([axis[some] for axis in np.indices(shape)])
    coarse = function(coarse_indices.reshape(3, -1).T).reshape(coarse_indices.shape[1:]) > 0
    mixed = ndimage.maximum_filter(coarse, 3) != ndimage.minimum_filter(coarse, 3)
    fine, mixed = (np.kron(a, np.ones((3, 3, 3), bool))[tuple(map(slice, shape))] for a in (coarse, mixed))
    fine[mixed] = function(np.argwhere(mixed)) > 0
    return fine


def touched(mask, indices):
    """The connected parts of a mask within a voxel of points, given as voxel indices."""
    near = np.zeros_like(mask)
    near[tuple(np.clip(np.rint(indices), 0, np.array(mask.shape) - 1).astype(int).T)] = True
    near = ndimage.binary_dilation(near, np.ones((3, 3, 3)))
    parts = ndimage.label(mask, np.ones((3, 3, 3)))[0]
    return np.isin(parts, np.setdiff1d(parts[near], 0))


def segment(planes, shape, index_to_mm, options):
    drawn = np.vstack([origin + polygon @ axes for origin, axes, polygons in planes for polygon in polygons])
    centre = (drawn.min(axis=0) + drawn.max(axis=0)) / 2
    diameter = 2 * np.linalg.norm(drawn - centre, axis=1).max()
    points, normals = constraints(planes, diameter, options.points)
    function = fitted((points - centre) / diameter, normals, options.smoothing)
    linear, first = index_to_mm[:3, :3], index_to_mm[:3, 3]
    mask = positive(lambda indices: function((indices @ linear.T + first - centre) / diameter), shape)
    return touched(mask, (points - first) @ np.linalg.inv(linear).T)


def dice(a, b):
    return 2 * (a & b).sum() / (a.sum() + b.sum())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sets", nargs="+", metavar="SET=FOLDER")
    parser.add_argument("--points", type=int, default=700)
    parser.add_argument("--smoothing", type=float, default=2e-4)
    options = parser.parse_args()
    table = csv.writer(sys.stdout)
    table.writerow(["set", "structure", "drawing", "dice"])
    for argument in options.sets:
        name, _, folder = argument.partition("=")
        for path in sorted(pathlib.Path(folder).glob("*/*.json")):
            truth, index_to_mm = read_truth(path.with_name("truth.nii.gz"))
            mask = segment(read_drawing(path), truth.shape, index_to_mm, options)
            table.writerow([name, path.parent.name, path.stem, f"{dice(mask, truth):.5f}"])
            sys.stdout.flush()


if __name__ == "__main__":
    main()
