# SPDX-License-Identifier: Apache-2.0
"""The method of Heckel, Konrad and Peitgen (2010) as printed, in NumPy, to check the C++ against.

Usage: numpy_reference.py CONTOURS.json GRID.txt OFFSET_MM FOLDER

Reads kontur's contour file and a grid (three sizes, then the twelve numbers of the index-to-mm matrix, row by row), and
writes FOLDER/centres.txt (x y z weight per line, mm), FOLDER/polynomial.txt and FOLDER/mask.bin (a byte per voxel, i
fastest). Weights belong to coordinates moved and scaled so that their smallest ball is
the unit ball.

Near-duplicate constraints make the system singular, which the paper does not treat. Rule: in the order of all boundary
constraints, then all normal constraints, one that lies within 0.06 % of the diameter of the contours' smallest ball of an earlier one is
left out, and a boundary constraint that is left out has no normal constraint.
"""

import json
import sys

import numpy as np
from scipy.linalg import lapack
from scipy.optimize import minimize
from scipy.spatial import ConvexHull

contours_file, grid_file, offset_mm, folder = sys.argv[1], sys.argv[2], float(sys.argv[3]), sys.argv[4]


def read_contours(path):
    """(points, plane normal, hole) of every contour, without points that repeat the one before."""
    contours = []
    for plane in json.load(open(path))["planes"]:
        normal = np.array(plane["normal"]) / np.linalg.norm(plane["normal"])
        for contour in plane["contours"]:
            points = np.array(contour["points"], float)
            repeated = (points == np.roll(points, 1, axis=0)).all(axis=1)
            contours.append((points[~repeated], normal, contour["hole"]))
    return contours


def smallest_ball(points):
    """Centre c and radius r by quadratic programming: least r^2 = t + |c|^2 with t >= |p|^2 - 2 p . c for every point p."""
    shift, size = points.mean(axis=0), np.ptp(points)
    p = np.unique((points - shift) / size, axis=0)
    p = p[ConvexHull(p).vertices]
    found = minimize(
        lambda x: x[3] + x[:3] @ x[:3],
        np.append(np.zeros(3), (p**2).sum(axis=1).max()),
        jac=lambda x: np.append(2 * x[:3], 1),
        constraints={
            "type": "ineq",
            "fun": lambda x: x[3] - (p**2).sum(axis=1) + 2 * p @ x[:3],
            "jac": lambda x: np.column_stack([2 * p, np.ones(len(p))]),
        },
        method="SLSQP",
        options={"ftol": 1e-16, "maxiter": 500},
    )
    centre = shift + size * found.x[:3]
    return centre, np.linalg.norm(points - centre, axis=1).max()


def subdivide(points):
    """Section 5.2: segments longer than twice the average get points at about the average length."""
    following = np.roll(points, -1, axis=0)
    lengths = np.linalg.norm(following - points, axis=1)
    average = lengths.mean()
    subdivided = []
    for start, end, length in zip(points, following, lengths):
        pieces = int(np.floor(length / average + 0.5)) if length > 2 * average else 1
        subdivided += [start + (end - start) * (piece / pieces) for piece in range(pieces)]
    return np.array(subdivided)


def segments_cross(a, b, c, d):
    def side(p, q, r):
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    return side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0


def outward_normals(points, plane_normal, hole):
    """Eq. 7, with the sign carried along the contour and flipped behind an odd number of crossings (section 5.1)."""
    n = len(points)
    edges = np.roll(points, -1, axis=0) - points
    normals = np.cross(plane_normal, edges) + np.cross(plane_normal, np.roll(edges, 1, axis=0))
    normals /= np.linalg.norm(normals, axis=1)[:, None]

    u = np.cross(plane_normal, np.eye(3)[np.argmin(np.abs(plane_normal))])
    u /= np.linalg.norm(u)
    flat = np.stack([points @ u, points @ np.cross(plane_normal, u)], axis=1)
    start = int(np.argmin(flat[:, 0]))
    sign = -1.0 if normals[start] @ u > 0 else 1.0  # outward at the point of smallest coordinate is towards smaller ones
    if hole:
        sign = -sign
    for step in range(n):
        i = (start + step) % n
        normals[i] *= sign
        crossings = sum(
            segments_cross(flat[i], flat[(i + 1) % n], flat[j], flat[(j + 1) % n])
            for j in range(n)
            if j not in (i, (i + 1) % n, (i - 1) % n)
        )
        if crossings % 2:
            sign = -sign
    return normals


def place(contours):
    """Centres and values: f = 0 on the contours, f = -offset at the offset outside."""
    diameter = 2 * smallest_ball(np.concatenate([c[0] for c in contours]))[1]
    points, normals = [], []
    for drawn, plane_normal, hole in contours:
        subdivided = subdivide(drawn)
        points.append(subdivided)
        normals.append(outward_normals(subdivided, plane_normal, hole))
    points, normals = np.concatenate(points), np.concatenate(normals)

    kept = np.empty((0, 3))
    values = []

    def try_to_keep(point, value):
        nonlocal kept
        if len(kept) and np.linalg.norm(kept - point, axis=1).min() < 6e-4 * diameter:
            return False
        kept = np.vstack([kept, point])
        values.append(value)
        return True

    on_boundary = [try_to_keep(point, 0.0) for point in points]
    for point, normal, is_kept in zip(points, normals, on_boundary):
        if is_kept:
            try_to_keep(point + offset_mm * normal, -offset_mm)
    return kept, np.array(values)


def solve(centres, values):
    """Eq. 6 by LAPACK's dsysv."""
    n = len(centres)
    matrix = np.zeros((n + 4, n + 4))
    matrix[:n, :n] = np.linalg.norm(centres[:, None] - centres[None], axis=2) ** 3
    matrix[:n, n] = matrix[n, :n] = 1
    matrix[:n, n + 1 :] = centres
    matrix[n + 1 :, :n] = centres.T
    _, _, solution, info = lapack.dsysv(matrix, np.concatenate([values, np.zeros(4)]))
    if info != 0:
        sys.exit(f"dsysv returned {info}")
    return solution[:n], solution[n:]


centres_mm, values = place(read_contours(contours_file))
middle, scale = smallest_ball(centres_mm)
centres = (centres_mm - middle) / scale
weights, polynomial = solve(centres, values)

numbers = np.array(open(grid_file).read().split(), float)
size, index_to_mm = numbers[:3].astype(int), numbers[3:].reshape(3, 4)
k, j, i = np.meshgrid(*(np.arange(s) for s in size[::-1]), indexing="ij")
voxels = np.stack([i.ravel(), j.ravel(), k.ravel()], axis=1) @ index_to_mm[:, :3].T + index_to_mm[:, 3]
voxels = (voxels - middle) / scale
f = polynomial[0] + voxels @ polynomial[1:]
for begin in range(0, len(voxels), 4096):
    part = voxels[begin : begin + 4096]
    f[begin : begin + 4096] += np.linalg.norm(part[:, None] - centres[None], axis=2) ** 3 @ weights

np.savetxt(f"{folder}/centres.txt", np.column_stack([centres_mm, weights]), fmt="%.17g")
np.savetxt(f"{folder}/polynomial.txt", polynomial, fmt="%.17g")
(f > 0).astype(np.uint8).tofile(f"{folder}/mask.bin")
