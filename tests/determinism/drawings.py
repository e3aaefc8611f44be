# SPDX-License-Identifier: Apache-2.0
"""Drawings that every run makes alike, and the options that they are segmented with."""
import math
import os
import random

CASES = int(os.environ.get("KONTUR_DETERMINISM_CASES", "4"))
OPTIONS = [[], ["--voxelizer", "tracked"], ["--conflicts", "exact"], ["--kernel", "biharmonic"], ["--normals", "in-plane"],
           ["--solver", "cholesky"], ["--voxelizer", "exhaustive"], ["--quality", "0.5"]]


def drawing(seed):
    """Sections of a wavy ellipsoid by planes in one, two or three directions, with an unsteady hand."""
    rng = random.Random(seed)
    half = [rng.uniform(15, 40) for _ in range(3)]
    wave, hand = rng.uniform(0, 0.1), rng.uniform(0, 0.3)
    planes = []
    for axis in range(1 + seed % 3):
        for n in range(rng.randint(4, 9)):
            offset = half[axis] * (-0.8 + 1.6 * n / 8)
            scale = math.sqrt(1 - (offset / half[axis]) ** 2)
            u, v = (axis + 1) % 3, (axis + 2) % 3
            points = []
            for k in range(rng.choice((40, 90, 160))):
                angle = 2 * math.pi * k / 90 if k < 90 else 0
                radius = scale * (1 + wave * math.sin(5 * angle)) + rng.uniform(-hand, hand) / half[u]
                p = [0.0, 0.0, 0.0]
                p[axis], p[u], p[v] = offset, half[u] * radius * math.cos(angle), half[v] * radius * math.sin(angle)
                points.append(p)
            normal = [float(a == axis) for a in range(3)]
            planes.append({"origin": [offset * a for a in normal], "normal": normal, "contours": [{"closed": True, "points": points[:90]}]})
    return {"frame": "LPS mm", "structure": f"body {seed}", "planes": planes}


def options(seed):
    return OPTIONS[seed % len(OPTIONS)]
