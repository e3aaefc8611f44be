# SPDX-License-Identifier: Apache-2.0
"""With an image, too, the same drawing gives the same bytes, whichever kernels OpenBLAS takes and for any number of threads."""
import hashlib
import json
import math
import os
import subprocess

import nibabel
import numpy
import pytest

KONTUR = os.environ["KONTUR_CLI"]
CORES = ("Haswell", "SkylakeX", "Prescott")  # what OpenBLAS would choose on processors with AVX2, AVX-512 and neither
SPACING_MM = 1.5
HALF_MM = 45.0


def radius_mm(x, y, z):
    """Of a body with bumps, most of which lie between the drawn planes, in a direction from its centre."""
    return 26 * (1 + 0.12 * numpy.sin(3 * numpy.arctan2(y, x)) * numpy.cos(6 * z / (numpy.sqrt(x * x + y * y + z * z) + 1e-9)))


def drawing():
    planes = []
    for offset in (-16.0, -5.0, 5.0, 16.0):
        points = []
        for k in range(80):
            angle = 2 * math.pi * k / 80
            r = 20.0
            for _ in range(50):
                r = math.sqrt(max(1.0, radius_mm(r * math.cos(angle), r * math.sin(angle), offset) ** 2 - offset**2))
            points.append([r * math.cos(angle), r * math.sin(angle), offset])
        planes.append({"origin": [0, 0, offset], "normal": [0, 0, 1], "contours": [{"closed": True, "points": points}]})
    return {"frame": "LPS mm", "structure": "bumps", "planes": planes}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("image")
    (folder / "a.json").write_text(json.dumps(drawing()))
    axis = numpy.arange(-HALF_MM, HALF_MM + 0.1, SPACING_MM)
    x, y, z = numpy.meshgrid(axis, axis, axis, indexing="ij")
    inside = x * x + y * y + z * z < radius_mm(x, y, z) ** 2
    noise = numpy.random.default_rng(7).normal(0, 12, inside.shape)
    affine = numpy.diag([-SPACING_MM, -SPACING_MM, SPACING_MM, 1])
    affine[:3, 3] = HALF_MM, HALF_MM, -HALF_MM
    nibabel.save(nibabel.Nifti1Image((40 + 60 * inside + noise).astype(numpy.int16), affine), folder / "image.nii")
    return folder


def digests(folder, core, threads):
    """Of mask and mesh; and the image was used."""
    subprocess.run([KONTUR, "segment", "a.json", "--image", "image.nii", "--output", "o.nii", "--mesh", "o.stl", "--report", "o.json", "--threads", str(threads)],
                   cwd=folder, env={**os.environ, "OPENBLAS_CORETYPE": core}, check=True, capture_output=True, timeout=400)
    assert json.loads((folder / "o.json").read_text())["image"]["verdict"] == "used"
    return [hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in ("o.nii", "o.stl")]


def test_the_image_gives_the_same_bytes_whichever_kernels_blas_takes(folder):
    first = digests(folder, CORES[0], 1)
    for core, threads in ((CORES[1], 1), (CORES[2], 1), (CORES[2], 3)):
        assert digests(folder, core, threads) == first, f"{core}, {threads} threads"
