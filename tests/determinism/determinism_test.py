# SPDX-License-Identifier: Apache-2.0
"""The same drawing gives the same bytes of mask and mesh, whatever the number of threads and however often it is run.

KONTUR_DETERMINISM_CASES and _RUNS widen it: 20 and 3 are what docs/reliability.md states.
"""
import hashlib
import json
import math
import os
import random
import subprocess

import pytest

KONTUR = os.environ["KONTUR_CLI"]
CASES = int(os.environ.get("KONTUR_DETERMINISM_CASES", "4"))
RUNS = int(os.environ.get("KONTUR_DETERMINISM_RUNS", "1"))
THREADS = (1, 2, 3, 4, 8)
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


def digests(folder, words, threads):
    for name in ("o.nii", "o.stl"):
        (folder / name).unlink(missing_ok=True)
    subprocess.run([KONTUR, "segment", "a.json", "--spacing-mm", "2", "--output", "o.nii", "--mesh", "o.stl", "--threads", str(threads), *words],
                   cwd=folder, check=True, capture_output=True, timeout=400)
    return [hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in ("o.nii", "o.stl")]


@pytest.mark.parametrize("seed", range(CASES))
def test_any_number_of_threads_gives_the_same_bytes(tmp_path, seed):
    (tmp_path / "a.json").write_text(json.dumps(drawing(seed)))
    words = OPTIONS[seed % len(OPTIONS)]
    first = digests(tmp_path, words, THREADS[0])
    for run in range(RUNS):
        for threads in THREADS:
            assert digests(tmp_path, words, threads) == first, f"{threads} threads, run {run + 1}"
