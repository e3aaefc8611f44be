# SPDX-License-Identifier: Apache-2.0
"""Solids of ten kinds whose truth is a formula, in random proportions: above 0 inside, about mm near the surface.

Each is about 1 large and has its middle at 0; `solid` scales it. `values` takes points of shape (n, 3).
"""
import dataclasses
import typing

import numpy as np
from scipy import spatial

LETTERS = {  # strokes between places of a square of 2, as pairs of (x, y)
    "A": [((-1, -1), (0, 1)), ((1, -1), (0, 1)), ((-0.5, 0), (0.5, 0))],
    "E": [((-0.8, -1), (-0.8, 1)), ((-0.8, -1), (0.8, -1)), ((-0.8, 0), (0.6, 0)), ((-0.8, 1), (0.8, 1))],
    "H": [((-0.8, -1), (-0.8, 1)), ((0.8, -1), (0.8, 1)), ((-0.8, 0), (0.8, 0))],
    "K": [((-0.8, -1), (-0.8, 1)), ((-0.8, 0), (0.7, 1)), ((-0.8, 0), (0.7, -1))],
    "N": [((-0.8, -1), (-0.8, 1)), ((-0.8, 1), (0.8, -1)), ((0.8, -1), (0.8, 1))],
    "S": [((-0.8, -1), (0.8, -1)), ((0.8, -1), (0.8, 0)), ((0.8, 0), (-0.8, 0)), ((-0.8, 0), (-0.8, 1)), ((-0.8, 1), (0.8, 1))],
    "T": [((0, -1), (0, 1)), ((-0.9, 1), (0.9, 1))],
}


@dataclasses.dataclass
class Solid:
    name: str
    bounds: np.ndarray  # shape (2, 3), mm
    values: typing.Callable


def ball(points, middle, radius):
    return radius - np.linalg.norm(points - middle, axis=1)


def box(points, half):
    """About 0, its faces across the axes."""
    off = np.abs(points) - half
    return -(np.linalg.norm(np.maximum(off, 0), axis=1) + np.minimum(off.max(axis=1), 0))


def capsule(points, start, end, radius):
    """Also in a plane."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    way = end - start
    part = np.clip((points - start) @ way / (way @ way), 0, 1)
    return radius - np.linalg.norm(points - start - part[:, None] * way, axis=1)


def slab(points, half):
    return half - np.abs(points[:, 2])


def union(*values):
    return np.max(values, axis=0)


def common(*values):
    return np.min(values, axis=0)


def turned(points, axis, angle):
    """About a main axis through 0; the points of the turned body in its own frame."""
    a, b = [(1, 2), (2, 0), (0, 1)][axis]
    result = points.copy()
    result[:, a] = np.cos(angle) * points[:, a] + np.sin(angle) * points[:, b]
    result[:, b] = -np.sin(angle) * points[:, a] + np.cos(angle) * points[:, b]
    return result


def shell(random):
    """Hollow, and every other one open like a bowl."""
    wall, rim = random.uniform(0.06, 0.16), random.choice([2.0, random.uniform(0, 0.25)])
    return lambda p: common(ball(p, 0, 0.5), -ball(p, 0, 0.5 - wall), rim - p[:, 2])


def helix(random):
    tube, pitch = random.uniform(0.05, 0.09), random.uniform(0.3, 0.45)
    angles = np.linspace(0, 2 * np.pi * random.uniform(1.5, 2.2), 1500)
    line = np.column_stack([0.36 * np.cos(angles), 0.36 * np.sin(angles), pitch * (angles - angles[-1] / 2) / (2 * np.pi)])
    tree = spatial.cKDTree(line)
    return lambda p: tube - np.minimum(tree.query(p, distance_upper_bound=3 * tube)[0], 3 * tube)


def comb(random):
    teeth, depth = random.integers(3, 6), random.uniform(0.08, 0.16)
    gap = 1 / (teeth - 0.5)
    middles = -0.5 + gap * (np.arange(teeth) + 0.25)
    back = np.array([0.0, -0.3, 0.0])
    return lambda p: union(box(p - back, (0.5, 0.1, depth)),
                           *(box(p - (x, 0.05, 0), (gap / 4, 0.4, depth)) for x in middles))


def star(random):
    points, inner, half = random.integers(4, 8), random.uniform(0.2, 0.3), random.uniform(0.1, 0.25)
    wedge = np.pi / points

    def values(p):
        angle = np.abs(np.mod(np.arctan2(p[:, 1], p[:, 0]) + wedge, 2 * wedge) - wedge)
        radius = np.hypot(p[:, 0], p[:, 1])
        at = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
        tip, notch = np.array([0.5, 0]), inner * np.array([np.cos(wedge), np.sin(wedge)])
        along = (notch - tip) / np.linalg.norm(notch - tip)
        return common((at - tip) @ (-along[1], along[0]), slab(p, half))

    return values


def wedge(random):
    slope, half = random.uniform(0.2, 0.5), random.uniform(0.2, 0.4)
    normal = np.array([slope, 0, 1]) / np.hypot(slope, 1)
    return lambda p: common(p[:, 2] + 0.25, 0.25 * slope - p @ normal, p[:, 0] + 0.5, 0.5 - p[:, 0],
                            half - np.abs(p[:, 1]))


def plate(random):
    half, tilt, spin = random.uniform(0.03, 0.08), random.uniform(0.3, 0.8), random.uniform(0, np.pi)
    return lambda p: box(turned(turned(p, 2, spin), 0, tilt), (0.45, 0.33, half))


def rings(random):
    """Two or three around one axis, one in another."""
    thick = random.uniform(0.04, 0.06)
    radii = np.linspace(0.16, 0.5 - thick, random.integers(2, 4))

    def ring(p, radius):
        return thick - np.hypot(np.hypot(p[:, 0], p[:, 1]) - radius, p[:, 2])

    return lambda p: union(*(ring(p, radius) for radius in radii))


def fan(random):
    """Blades that share an edge."""
    blades, half = random.integers(3, 6), random.uniform(0.025, 0.05)
    angles = np.linspace(-1, 1, blades) * random.uniform(0.5, 1.0)
    middle = np.array([0.35, 0, 0])
    return lambda p: union(*(box(turned(p + (0.35, 0, 0), 1, angle) - middle, (0.4, 0.3, half)) for angle in angles))


def hand(random):
    """A palm, four fingers and a thumb."""
    thick = random.uniform(0.05, 0.065)
    spread, lengths = random.uniform(0.4, 0.7), random.uniform(0.28, 0.4, 4)
    roots = np.linspace(-0.2, 0.2, 4)

    def values(p):
        palm = ball(p / (0.27, 0.27, 0.1) + (0, 0.18 / 0.27, 0), 0, 1) * 0.1
        fingers = [capsule(p, (x, -0.05, 0), (x * (1 + spread), 0.05 + length, 0.1 * length), thick)
                   for x, length in zip(roots, lengths)]
        return union(palm, *fingers, capsule(p, (0.15, -0.25, 0), (0.42, -0.05, -0.08), thick))

    return values


def letter(random):
    strokes = LETTERS[random.choice(sorted(LETTERS))]
    thick, half = random.uniform(0.06, 0.1), random.uniform(0.08, 0.2)
    return lambda p: common(union(*(capsule(p[:, :2], 0.4 * np.array(a), 0.4 * np.array(b), thick) for a, b in strokes)),
                            slab(p, half))


KINDS = {kind.__name__: kind for kind in (shell, helix, comb, star, wedge, plate, rings, fan, hand, letter)}


def solid(kind, size_mm, random):
    """A solid of the kind about `size_mm` large, its box found on a lattice."""
    unit = KINDS[kind](random)
    axis = np.linspace(-0.8, 0.8, 65)
    lattice = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
    near = lattice[unit(lattice) > -0.025]
    return Solid(kind, size_mm * np.array([near.min(axis=0) - 0.03, near.max(axis=0) + 0.03]),
                 lambda p: size_mm * unit(np.asarray(p) / size_mm))
