# SPDX-License-Identifier: Apache-2.0
"""What the commands say about DICOM folders as interrupted copies, archives and other programs leave them."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy
import pydicom
import pytest
from support import kontur, kontur_of_nobody, read_nifti

SUPPORT = pathlib.Path(__file__).parents[1] / "support"


def make(script, case, folder):
    subprocess.run([sys.executable, SUPPORT / script, case, folder], check=True)
    return folder / "dicom"


@pytest.fixture(scope="module")
def series(tmp_path_factory):
    return make("make_dicom_series.py", "axial", tmp_path_factory.mktemp("axial"))


@pytest.fixture
def images(series, tmp_path):
    return pathlib.Path(shutil.copytree(series, tmp_path / "images"))


def last_slice(folder):
    return max(folder.glob("*.dcm"), key=lambda path: pydicom.dcmread(path).ImagePositionPatient[2])


@pytest.mark.parametrize("size", [0, 100])
def test_an_empty_slice_is_a_warning_that_quiet_does_not_swallow(tmp_path, images, size):
    last = last_slice(images)
    last.write_bytes(last.read_bytes()[:size])
    sentence = f"left out 1 file, named like the slices but no DICOM: {last.name} ({size} bytes); the volume may lack a slice"
    for words in (["convert", images, tmp_path / "o.nii"], ["convert", images, tmp_path / "o.nii", "--quiet"], ["inspect", images]):
        result = kontur(*words)
        assert (result.returncode, result.stderr) == (0, f"kontur: warning: {sentence}\n"), result
    [facts] = json.loads(kontur("inspect", images, "--json").stdout)
    assert facts["warnings"] == [sentence] and facts["notes"] == []
    assert read_nifti(tmp_path / "o.nii").shape[2] == 8
    (tmp_path / "ball.json").write_text(json.dumps({"frame": "LPS mm", "planes": [{
        "origin": [-15, -25, 110], "normal": [0, 0, 1],
        "contours": [{"points": [[-17, -27, 110], [-13, -27, 110], [-13, -23, 110], [-17, -23, 110]]}]}]}))
    words = ["convert", tmp_path / "ball.json", tmp_path / "rs.dcm", "--image", images, "--quiet"]
    assert kontur(*words).stderr == f"kontur: warning: {sentence}\n", "images that are only referred to"


@pytest.fixture
def open_folder():
    """A folder that every user may enter; pytest's own is closed to others."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        folder.chmod(0o777)
        yield folder


@pytest.mark.parametrize("what", ["a slice", "a folder below"])
def test_what_may_not_be_read_is_an_error_everywhere(open_folder, series, what):
    images = pathlib.Path(shutil.copytree(series, open_folder / "disk" / "ct"))
    target = last_slice(images)
    if what == "a folder below":
        images = open_folder / "disk"
        target = images / "secret"
        target.mkdir()
    target.chmod(0)
    try:
        for words in (["convert", images, open_folder / "o.nii"], ["inspect", images]):
            result = kontur_of_nobody(*words)
            assert result.returncode == 74 and f"cannot read {target}: Permission denied" in result.stderr, result
    finally:
        target.chmod(0o755)


def test_series_in_folders_below_are_read_digested_and_kept_from_outputs(tmp_path, images):
    below = tmp_path / "disk" / "DICOM" / "SE01"
    below.mkdir(parents=True)
    for path in images.iterdir():
        path.rename(below / path.name)
    result = kontur("convert", tmp_path / "disk", tmp_path / "o.nrrd")
    assert (result.returncode, result.stderr) == (0, ""), result
    first = kontur("inspect", tmp_path / "o.nrrd", "--json").stdout
    last = last_slice(below)
    content = bytearray(last.read_bytes())
    content[-1] ^= 1
    last.write_bytes(content)
    assert kontur("convert", tmp_path / "disk", tmp_path / "o.nrrd").returncode == 0
    digests = [json.loads(text)[0]["provenance"]["source_sha256"] for text in (first, kontur("inspect", tmp_path / "o.nrrd", "--json").stdout)]
    assert digests[0] != digests[1]
    (tmp_path / "ball.json").write_text("{}")
    result = kontur("convert", tmp_path / "ball.json", last, "--image", tmp_path / "disk")
    assert result.returncode == 65 and "is a slice of the input" in result.stderr, result
    assert last.read_bytes() == content


def test_a_newer_syntax_is_unsupported_and_named(tmp_path):
    images = make("make_dicom_series.py", "htj2k", tmp_path / "htj2k")
    result = kontur("convert", images, tmp_path / "o.nii")
    assert result.returncode == 69 and "'High-Throughput JPEG 2000 (Lossless Only)' is not supported" in result.stderr, result


def test_a_dose_is_an_image_with_pydicoms_values(tmp_path):
    dose = make("make_rtdose.py", "relative", tmp_path / "dose") / "dose0.dcm"
    result = kontur("convert", dose, tmp_path / "o.nii")
    assert (result.returncode, result.stderr) == (0, "kontur: note: a dose; its unit is GY\n"), result
    read = pydicom.dcmread(dose)
    truth = read.pixel_array * float(read.DoseGridScaling)
    assert numpy.allclose(read_nifti(tmp_path / "o.nii").T, truth, rtol=1e-6)


def test_a_batch_sees_changed_slices_in_folders_below(tmp_path, images):
    below = tmp_path / "disk" / "SE01"
    below.parent.mkdir()
    images.rename(below)
    (tmp_path / "c.json").write_text(json.dumps({"frame": "LPS mm", "planes": [{
        "origin": [-15, -25, z], "normal": [0, 0, 1],
        "contours": [{"points": [[-17, -27, z], [-13, -27, z], [-13, -23, z], [-17, -23, z]]}]} for z in (105, 107.5, 110)]}))
    (tmp_path / "t.csv").write_text("case,contours,image,output\na,c.json,disk,a.nii\n")
    assert kontur("batch", tmp_path / "t.csv").returncode == 0
    assert "a: " not in kontur("batch", tmp_path / "t.csv").stdout
    os.utime(last_slice(below), (1, 1))
    assert "a: " in kontur("batch", tmp_path / "t.csv").stdout
