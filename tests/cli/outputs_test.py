# SPDX-License-Identifier: Apache-2.0
"""What is written replaces nothing that was read, and what stood there before stays when something goes wrong."""
import fcntl
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import pytest
from support import KONTUR, ball_array, ball_planes, circle, kontur, kontur_of_nobody, names, write_nifti, write_planes

SUPPORT = pathlib.Path(__file__).parent.parent / "support"
COARSE = ["--spacing-mm", 4]


@pytest.fixture(scope="module")
def series(tmp_path_factory):
    """A DICOM series of 9 axial slices, and contours on it."""
    folder = tmp_path_factory.mktemp("series")
    subprocess.run([sys.executable, SUPPORT / "make_dicom_series.py", "axial", folder / "axial"], check=True)
    return folder / "axial" / "dicom"


@pytest.fixture
def scene(tmp_path, series):
    """A folder with contours, a mask on the images, and a copy of the images in `dicom`."""
    shutil.copytree(series, tmp_path / "dicom")
    write_planes(tmp_path / "ball.json", [circle(a, d, center=(-15.0, -25.0, 110.0), radius=3.5) for a in "xyz" for d in (-1, 1)])
    assert kontur("segment", "ball.json", "--image", "dicom", "--output", "mask.nii.gz", cwd=tmp_path).returncode == 0
    return tmp_path


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.mark.parametrize("image", ["dicom", "dicom/{slice}"])
@pytest.mark.parametrize(
    "words",
    [
        ["segment", "ball.json", "--image", "{image}", "--output", "dicom/{slice}"],
        ["segment", "ball.json", "--image", "{image}", "--output", "out.nii.gz", "--rtstruct", "dicom/{slice}"],
        ["trace", "mask.nii.gz", "--image", "{image}", "--output", "dicom/{slice}"],
        ["convert", "mask.nii.gz", "dicom/{slice}", "--image", "{image}"],
    ],
)
def test_a_slice_of_the_image_is_never_replaced(scene, words, image):
    before = contents(scene / "dicom")
    first, last = (names(scene / "dicom")[n] for n in (0, -1))
    image = image.format(slice=first)
    result = kontur(*(word.format(slice=last, image=image) for word in words), cwd=scene)
    assert result.returncode == 65, result
    assert f"dicom/{last} is a slice of the input {image}" in result.stderr
    assert contents(scene / "dicom") == before


def test_a_new_file_beside_the_slices_is_welcome_and_can_be_made_again(scene):
    """The reader of the series leaves it out."""
    before = contents(scene / "dicom")
    for output in ("mask.dcm", "mask.nii.gz"):
        for _ in range(2):
            result = kontur("segment", "ball.json", "--image", "dicom", "--output", "dicom/" + output, cwd=scene)
            assert result.returncode == 0, result
    after = contents(scene / "dicom")
    assert set(after) - set(before) == {"mask.dcm", "mask.nii.gz"}
    assert {name: after[name] for name in before} == before


def test_outputs_of_the_module_of_3d_slicer_replace_no_input(tmp_path):
    write_nifti(tmp_path / "image.nii.gz", ball_array())
    write_planes(tmp_path / "ball.json", ball_planes())
    assert kontur("convert", "ball.json", "ball.mrk.json", cwd=tmp_path).returncode == 0
    before = contents(tmp_path)
    words = ["slicer", "--reference", "image.nii.gz", "--contour", "ball.mrk.json"]
    for code, more in [
        (65, ["--mask", "image.nii.gz"]),
        (65, ["--mask", "out.nrrd", "--returnparameterfile", "ball.mrk.json"]),
        (74, ["--mask", "nowhere/out.nrrd"]),
    ]:
        result = kontur(*words, *more, cwd=tmp_path)
        assert result.returncode == code
        assert more[-1] in result.stderr
        assert result.stdout == ""  # before any work
        assert contents(tmp_path) == before


@pytest.mark.parametrize("second", ["out.dcm", "./out.dcm", "link.dcm"])
def test_two_outputs_in_one_file_are_refused(scene, second):
    (scene / "link.dcm").symlink_to("out.dcm")
    before = names(scene)
    result = kontur("segment", "ball.json", "--image", "dicom", "--output", "out.dcm", "--rtstruct", second, cwd=scene)
    assert result.returncode == 65
    assert result.stderr == f"kontur: error: {second} is named for two outputs; each needs a file of its own\n"
    assert names(scene) == before


@pytest.fixture
def open_folder():
    """A folder that every user may enter; pytest's own is closed to others."""
    if os.geteuid() != 0:
        pytest.skip("needs root, to be another user")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        folder.chmod(0o1777)
        write_planes(folder / "ball.json", ball_planes())
        yield folder


def test_an_output_that_cannot_be_moved_takes_the_others_back(open_folder):
    """In a folder with the sticky bit only its owner may replace a file."""
    (open_folder / "b.nii").write_text("old")
    os.chown(open_folder / "b.nii", 65534, 65534)
    (open_folder / "c.stl").write_text("of root")
    (open_folder / "c.stl").chmod(0o666)
    before = contents(open_folder)
    for mask in ("a.nii", "b.nii"):
        words = ["segment", "ball.json", *COARSE, "--output", mask, "--mesh", "c.stl"]
        result = kontur_of_nobody(*words, cwd=open_folder)
        assert result.returncode == 74
        assert "c.stl: Operation not permitted" in result.stderr
        assert contents(open_folder) == before


def test_a_write_protected_file_is_not_replaced(open_folder):
    open_folder.chmod(0o777)
    (open_folder / "a.nii").write_text("final")
    (open_folder / "a.nii").chmod(0o444)
    before = contents(open_folder)
    result = kontur_of_nobody("segment", "ball.json", *COARSE, "--output", "a.nii", cwd=open_folder)
    assert result.returncode == 74
    assert result.stderr == "kontur: error: cannot write a.nii: Permission denied\n"
    assert contents(open_folder) == before


def test_a_link_is_followed_even_to_where_nothing_is_yet(tmp_path):
    write_planes(tmp_path / "ball.json", ball_planes())
    (tmp_path / "far").mkdir()
    (tmp_path / "near.nii").symlink_to("far/link.nii")
    (tmp_path / "far" / "link.nii").symlink_to("mask.nii")
    assert kontur("segment", "ball.json", *COARSE, "--output", "near.nii", cwd=tmp_path).returncode == 0
    assert (tmp_path / "near.nii").is_symlink() and (tmp_path / "far" / "link.nii").is_symlink()
    assert names(tmp_path / "far") == ["link.nii", "mask.nii"]


def test_links_in_a_circle_are_refused_before_the_work(tmp_path):
    (tmp_path / "a.nii").symlink_to("b.nii")
    (tmp_path / "b.nii").symlink_to("a.nii")
    result = kontur("segment", "missing.json", *COARSE, "--output", "a.nii", cwd=tmp_path)
    assert result.returncode == 74
    assert result.stderr == "kontur: error: cannot write a.nii: Too many levels of symbolic links\n"


def killed_while_it_writes(folder, output):
    """Ends kontur as kill -9 does, once it has a hidden folder."""
    command = [KONTUR, "segment", "ball.json", "--spacing-mm", "0.15", "--output", output]
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while not (hidden := [name for name in names(folder) if name.startswith(".kontur-")]):
        assert process.poll() is None, "it ended before it could be killed"
        time.sleep(0.001)
    process.send_signal(signal.SIGKILL)
    assert process.wait() == -signal.SIGKILL
    return hidden


def test_what_a_killed_run_left_is_cleared_by_the_next(tmp_path):
    write_planes(tmp_path / "ball.json", ball_planes())
    left, = killed_while_it_writes(tmp_path, "a.nii.gz")
    assert (tmp_path / left).is_dir()
    assert kontur("segment", "ball.json", *COARSE, "--output", "b.nii", cwd=tmp_path).returncode == 0
    assert names(tmp_path) == ["b.nii", "ball.json"]


def is_locked(folder):
    opened = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        fcntl.flock(opened, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return False
    except BlockingIOError:
        return True
    finally:
        os.close(opened)


def test_the_hidden_folder_of_a_run_at_work_stays(tmp_path):
    write_planes(tmp_path / "ball.json", ball_planes())
    command = [KONTUR, "segment", "ball.json", "--spacing-mm", "0.15", "--output", "a.nii.gz"]
    process = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while not any(name.startswith(".kontur-") and is_locked(tmp_path / name) for name in names(tmp_path)):
        assert process.poll() is None
        time.sleep(0.001)
    process.send_signal(signal.SIGSTOP)
    try:
        hidden = [name for name in names(tmp_path) if name.startswith(".kontur-")]
        assert len(hidden) == 1
        assert kontur("segment", "ball.json", *COARSE, "--output", "b.nii", cwd=tmp_path).returncode == 0
        assert names(tmp_path) == [*hidden, "b.nii", "ball.json"]
    finally:
        process.send_signal(signal.SIGCONT)
        assert process.wait() == 0
    assert names(tmp_path) == ["a.nii.gz", "b.nii", "ball.json"]


def test_folders_of_users_and_kept_files_are_no_leftovers(tmp_path):
    write_planes(tmp_path / "ball.json", ball_planes())
    for name, mode in ((".kontur-mine", 0o700), (".kontur-abcdef", 0o755), (".kontur-keeper", 0o700), (".kontur-ghijkl", 0o700)):
        (tmp_path / name).mkdir()
        (tmp_path / name).chmod(mode)
    (tmp_path / ".kontur-keeper" / ".replaced-0").write_text("what stood at a target")
    (tmp_path / ".kontur-ghijkl" / "mask.nii").write_text("half a mask")
    (tmp_path / ".kontur-linked").symlink_to(".kontur-mine")
    assert kontur("segment", "ball.json", *COARSE, "--output", "b.nii", cwd=tmp_path).returncode == 0
    assert names(tmp_path) == [".kontur-abcdef", ".kontur-keeper", ".kontur-linked", ".kontur-mine", "b.nii", "ball.json"]
