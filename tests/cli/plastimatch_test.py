# SPDX-License-Identifier: Apache-2.0
"""RT structure sets as plastimatch rasterizes them, a radiotherapy program of its own: its masks are those that kontur writes. Skipped
where plastimatch is not installed."""
import shutil
import subprocess

import numpy
import pytest
from support import ball_array, circle, kontur, read_nifti, real_data, write_nifti, write_planes

pytestmark = pytest.mark.skipif(not shutil.which("plastimatch"), reason="plastimatch is not installed")


def plastimatch(*words):
    result = subprocess.run(["plastimatch", "convert", *map(str, words)], capture_output=True, text=True)
    assert result.returncode == 0, result


@pytest.fixture(scope="module")
def images(tmp_path_factory):
    """A DICOM series of 1 mm that plastimatch wrote."""
    folder = tmp_path_factory.mktemp("images")
    write_nifti(folder / "ct.nii.gz", ball_array().astype(numpy.int16) * 150)
    plastimatch("--input", folder / "ct.nii.gz", "--output-dicom", folder / "dicom", "--patient-id", "P1")
    return folder / "dicom"


def shell_contours(path):
    """A ball with a cavity, on nine planes."""
    planes = [circle(axis, offset, radius=9) for axis in "xyz" for offset in (-3, 0, 3)]
    for plane, (axis, offset) in zip(planes, ((a, o) for a in "xyz" for o in (-3, 0, 3))):
        plane["contours"] += [c | {"hole": True} for c in circle(axis, offset, radius=5)["contours"]]
    return write_planes(path, planes)


def masks_of(folder, contours, images, holes, *words):
    """kontur's mask and plastimatch's of the structure set that kontur wrote beside it."""
    kontur("segment", contours, "--image", images, "--output", folder / "mask.nii.gz", "--rtstruct", folder / "rs.dcm", "--holes", holes)
    kontur("convert", images, folder / "ct.nii.gz")
    plastimatch("--input", folder / "rs.dcm", "--fixed", folder / "ct.nii.gz", "--output-prefix", folder / "out",
                "--prefix-format", "nii.gz", *words)
    [theirs] = (folder / "out").iterdir()
    return read_nifti(folder / "mask.nii.gz") != 0, read_nifti(theirs) != 0


@pytest.mark.parametrize("holes, words", [("keyhole", []), ("nested", ["--xor-contours"])])
def test_a_cavity_is_the_same_to_the_voxel(tmp_path, images, holes, words):
    ours, theirs = masks_of(tmp_path, shell_contours(tmp_path / "shell.json"), images, holes, *words)
    assert ours.sum() > 2000
    assert numpy.array_equal(ours, theirs)


def test_a_tumour_is_the_same_to_the_voxel(tmp_path):
    folder = real_data("03_sarcoma_STS_002/CT")
    ours, theirs = masks_of(tmp_path, folder / "RTSTRUCT_RS.dcm", folder / "image", "keyhole")
    assert ours.sum() > 10000
    assert numpy.array_equal(ours, theirs)
