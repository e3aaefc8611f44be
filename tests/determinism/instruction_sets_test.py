# SPDX-License-Identifier: Apache-2.0
"""What differs between processors: the same drawing by the program with its hot loops for one level of x86-64 each.

An older level also gets the kernels of OpenBLAS and of the C library's mathematics that its processors would be given.
KONTUR_DETERMINISM_CASES widens it.
"""
import json
import os
import pathlib
import subprocess

import nibabel
import numpy
import pytest
from drawings import CASES, drawing, options
from scipy.spatial import cKDTree

HERE = os.environ["KONTUR_CLI"]
OTHERS = {
    3: {"OPENBLAS_CORETYPE": "Haswell"},
    1: {"OPENBLAS_CORETYPE": "Prescott", "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX512F,-AVX2,-AVX,-FMA"},
}
FLAGS = pathlib.Path("/proc/cpuinfo").read_text().split()


def mask_and_vertices(program, folder, words, environment=()):
    subprocess.run([program, "segment", "a.json", "--spacing-mm", "1", "--output", "o.nii", "--mesh", "o.stl", *words], cwd=folder,
                   env={**os.environ, **dict(environment)}, check=True, capture_output=True, timeout=400)
    triangles = numpy.frombuffer((folder / "o.stl").read_bytes()[84:], numpy.dtype([("normal", "<f4", 3), ("at", "<f4", (3, 3)), ("", "<u2")]))
    return numpy.array(nibabel.load(folder / "o.nii").dataobj), triangles["at"].reshape(-1, 3)


def distances_mm(a, b):
    """From each vertex to the nearest of the other mesh."""
    return numpy.concatenate([cKDTree(b).query(a)[0], cKDTree(a).query(b)[0]])


@pytest.mark.parametrize("level", OTHERS)
@pytest.mark.parametrize("tolerance, voxels, most_mm, worst_mm", [([], 2e-4, 0.05, 0.5), (["--tolerance-mm", "1e-6"], 0, 1e-3, 1e-2)], ids=["default", "1e-6"])
@pytest.mark.parametrize("seed", range(6, 6 + CASES))  # 6 is the worst of the first 20
def test_the_result_differs_within_the_tolerance(tmp_path, seed, level, tolerance, voxels, most_mm, worst_mm):
    if level == 3 and not {"avx2", "fma", "bmi2"} <= set(FLAGS):
        pytest.skip("this processor has no AVX2")
    (tmp_path / "a.json").write_text(json.dumps(drawing(seed)))
    words = [*options(seed), *tolerance]
    mask, vertices = mask_and_vertices(HERE, tmp_path, words)
    other_mask, other_vertices = mask_and_vertices(os.environ[f"KONTUR_OF_LEVEL_{level}"], tmp_path, words, OTHERS[level])
    differing, apart = numpy.count_nonzero(mask != other_mask), distances_mm(vertices, other_vertices)
    print(f"\n{differing} of {numpy.count_nonzero(mask)} voxels; vertices: 99.9 % within {numpy.quantile(apart, 0.999):.1e} mm, all within {apart.max():.1e} mm")
    assert differing <= voxels * numpy.count_nonzero(mask)
    assert numpy.quantile(apart, 0.999) < most_mm and apart.max() < worst_mm
