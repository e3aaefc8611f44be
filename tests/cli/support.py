# SPDX-License-Identifier: Apache-2.0
"""Runs kontur and makes small analytic input for it: a ball, its mask, an image of it and contours on it. LPS mm."""
import atexit
import functools
import json
import math
import os
import pathlib
import shutil
import subprocess
import tempfile

import nibabel
import numpy
import pytest

KONTUR = os.environ["KONTUR_CLI"]
SANITIZED = bool(os.environ.get("KONTUR_SANITIZED"))  # needs several times the memory
CENTER = (12.0, -7.0, 5.0)
RADIUS = 10.0
AXES = {"x": ((1, 0, 0), (0, 1, 0), (0, 0, 1)), "y": ((0, 1, 0), (0, 0, 1), (1, 0, 0)), "z": ((0, 0, 1), (1, 0, 0), (0, 1, 0))}


def kontur(*words, **options):
    """The finished process; the words may be paths or numbers."""
    return run_program(KONTUR, words, **options)


def run_program(program, words, **options):
    return subprocess.run(
        [program, *map(str, words)], capture_output=True, text=True, timeout=400, stdin=subprocess.DEVNULL, **options
    )


def succeed(*words, **options):
    """The same, with an assertion that it went well without a word on stderr."""
    result = kontur(*words, **options)
    assert (result.returncode, result.stderr) == (0, ""), result
    return result.stdout


def names(folder):
    """Everything in a folder, hidden files included."""
    return sorted(path.name for path in folder.iterdir())


def circle(axis, offset, points=40, center=CENTER, radius=RADIUS):
    """The plane entry of a contour file: the ball cut at `offset` mm from its centre across the axis x, y or z."""
    normal, u, v = (numpy.array(a, float) for a in AXES[axis])
    origin = numpy.array(center) + offset * normal
    r = math.sqrt(radius**2 - offset**2)
    angles = 2 * math.pi * numpy.arange(points) / points
    ring = origin + r * (numpy.cos(angles)[:, None] * u + numpy.sin(angles)[:, None] * v)
    contour = {"closed": True, "hole": False, "points": ring.tolist()}
    return {"origin": origin.tolist(), "normal": normal.tolist(), "u": u.tolist(), "v": v.tolist(), "contours": [contour]}


def ball_planes():
    return [circle(axis, offset) for axis in "xyz" for offset in (-5.0, 0.0, 5.0)]


def write_planes(path, planes):
    path.write_text(json.dumps({"frame": "LPS mm", "structure": "ball", "planes": planes}))
    return path


def lps_affine(spacing=1.0, origin=(-8.0, -27.0, -15.0)):
    affine = numpy.diag([spacing, spacing, spacing, 1.0])
    affine[:3, 3] = origin
    return affine


def voxel_centers(shape, affine):
    index = numpy.stack(numpy.meshgrid(*(numpy.arange(n) for n in shape), indexing="ij"), -1)
    return index @ affine[:3, :3].T + affine[:3, 3]


def ball_array(shape=(40, 40, 40), affine=None, radius=RADIUS, center=CENTER):
    centers = voxel_centers(shape, lps_affine() if affine is None else affine)
    return (numpy.linalg.norm(centers - numpy.array(center), axis=-1) < radius).astype(numpy.uint8)


def write_nifti(path, array, affine=None):
    """NIfTI's frame is RAS: the first two rows change sign."""
    ras = numpy.diag([-1.0, -1.0, 1.0, 1.0]) @ (lps_affine() if affine is None else affine)
    nibabel.save(nibabel.Nifti1Image(array, ras), path)
    return path


def read_nifti(path):
    return numpy.asarray(nibabel.load(path).dataobj)


def real_data(name):
    """A file or folder of the real data sets; without it the test is skipped."""
    folder = os.environ.get("KONTUR_TEST_DATA") or os.environ.get("KONTUR_TEST_DATA_DEFAULT", "")
    path = pathlib.Path(folder) / name
    if not path.exists():
        pytest.skip(f"real data not found: {path} (set KONTUR_TEST_DATA)")
    return path


def become_nobody():
    os.setgroups([])
    os.setgid(65534)
    os.setuid(65534)


@functools.cache
def program_for_all():
    """A copy that every user may run: the build may lie in a folder that others may not enter, as root's own is."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="kontur-"))
    atexit.register(shutil.rmtree, folder)
    folder.chmod(0o755)
    return shutil.copy(KONTUR, folder)


def kontur_of_nobody(*words, **options):
    """kontur(), run by a user who may not read and write everything, as root may."""
    if os.geteuid() != 0:
        return kontur(*words, **options)
    return run_program(program_for_all(), words, preexec_fn=become_nobody, **options)


def dice(a, b):
    return 2 * numpy.count_nonzero(a & b) / (numpy.count_nonzero(a) + numpy.count_nonzero(b))
