# SPDX-License-Identifier: Apache-2.0
"""What cannot be used is refused in one sentence, with a documented exit code, and leaves nothing behind."""
import gzip
import os
import pathlib
import re
import resource
import shutil
import signal
import struct
import subprocess
import tempfile

import numpy
import pytest
from support import KONTUR, ball_array, ball_planes, circle, kontur, kontur_of_nobody, names, write_nifti, write_planes

IMAGE, OUT = "image.nii.gz", "out.nii.gz"


def segment(folder, contours="ball.json", image=IMAGE, output=OUT, more=()):
    """Segments in `folder`, checks that a refusal is one line and leaves no trace, and returns its exit code and sentence."""
    before = names(folder)
    result = kontur("segment", contours, "--image", image, "--output", output, *more, cwd=folder)
    assert names(folder) == before
    assert result.stdout == ""
    assert re.fullmatch(r"kontur: error: .+\n", result.stderr), result
    return result.returncode, result.stderr


@pytest.fixture
def folder(tmp_path):
    write_planes(tmp_path / "ball.json", ball_planes())
    write_nifti(tmp_path / IMAGE, ball_array())
    return tmp_path


def points_of(planes, number):
    return planes[number]["contours"][0]["points"]


def no_contour(planes):
    for plane in planes:
        plane["contours"] = []


def two_points(planes):
    del points_of(planes, 1)[2:]


def off_plane(planes):
    points_of(planes, 8)[3][2] += 2.5


def a_line_among_others(planes):
    planes[2]["contours"][0]["points"] = [[12, -7 + t, 10] for t in (0, 1, 2, 3, 1.5)]
    planes[2].update(circle("x", 0) | {"contours": planes[2]["contours"]})


def only_a_line(planes):
    a_line_among_others(planes)
    planes[:] = planes[2:3]


def far_away(planes):
    for plane in planes:
        plane["origin"][0] += 500
        for point in plane["contours"][0]["points"]:
            point[0] += 500


@pytest.mark.parametrize(
    "spoil, words",
    [
        (no_contour, ["no contour"]),
        (two_points, ["contour 2 has 2 points", "at least 3"]),
        (off_plane, ["contour 9", "2.5 mm", "limit"]),
        (only_a_line, ["contour 1", "no area"]),
        (far_away, ["360 contour points", "outside"]),
    ],
)
def test_contours_that_cannot_be_segmented(folder, spoil, words):
    planes = ball_planes()
    spoil(planes)
    write_planes(folder / "bad.json", planes)
    code, sentence = segment(folder, "bad.json")
    assert code == 65
    for word in words:
        assert word in sentence


def test_a_contour_without_area_is_left_out_where_others_show_the_object(folder):
    planes = ball_planes()
    a_line_among_others(planes)
    write_planes(folder / "line.json", planes)
    result = kontur("segment", "line.json", "--image", IMAGE, "--output", OUT, cwd=folder)
    assert result.returncode == 0, result.stderr
    said = result.stdout + result.stderr
    assert "contour 3 has no area" in said and "left out" in said


@pytest.mark.parametrize("command", [["segment", "-o", OUT], ["segment", "--image", IMAGE, "-o", OUT], ["suggest"], ["open", IMAGE, "--no-browser"]])
def test_a_contour_that_cannot_be_segmented_is_named_with_its_file(folder, command):
    planes = ball_planes()
    off_plane(planes)
    write_planes(folder / "bad.json", planes)
    name, *options = command
    result = kontur(name, "bad.json", *options, cwd=folder, env=os.environ | {"XDG_DATA_HOME": str(folder)})
    assert result.returncode == 65
    assert "kontur: error: bad.json: point 4 of contour 9 lies 2.5 mm off its plane; the limit is 0.01 mm" in result.stderr


def test_of_several_files_the_one_with_the_bad_contour_is_named(folder):
    planes = ball_planes()
    two_points(planes)
    write_planes(folder / "bad.json", planes)
    result = kontur("segment", "ball.json", "bad.json", "--image", IMAGE, "-o", OUT, cwd=folder)
    assert result.stderr == "kontur: error: bad.json: contour 2 has 2 points; at least 3 are needed\n"
    for plane in planes:
        plane["contours"][0]["hole"] = True
    planes[1:2] = []
    for name in ("holes.json", "more.json"):
        write_planes(folder / name, planes)
    result = kontur("segment", "holes.json", "more.json", "--image", IMAGE, "-o", OUT, cwd=folder)
    assert re.fullmatch(r"kontur: error: holes.json, more.json: all contours are holes \(\d+\); at least 1 must be none\n", result.stderr), result


def test_that_a_file_holds_no_contours_is_said_before_a_grid_is_asked_for(folder):
    (folder / "words.txt").write_text("hello")
    assert "words.txt holds no contours" in kontur("segment", "words.txt", "-o", OUT, cwd=folder).stderr
    assert "the mask has no grid; give --image or --spacing-mm" in kontur("segment", "ball.json", "-o", OUT, cwd=folder).stderr


def test_a_coordinate_beyond_what_can_be_drawn(folder):
    planes = ball_planes()
    points_of(planes, 0)[0][0] = 1e200
    write_planes(folder / "bad.json", planes)
    assert "point 1 of contour 1 has the coordinate 1e+200 mm; the limit is 1e+09 mm" in segment(folder, "bad.json")[1]


@pytest.mark.parametrize("value", ["NaN", "Infinity", "-Infinity", "1e999", '"12"', "null"])
def test_a_coordinate_that_is_no_number(folder, value):
    planes = ball_planes()
    points_of(planes, 0)[0][0] = 987654321
    write_planes(folder / "bad.json", planes)
    text = (folder / "bad.json").read_text()
    (folder / "bad.json").write_text(text.replace("987654321", value))
    code, sentence = segment(folder, "bad.json")
    assert code == 66
    assert "bad.json" in sentence


def truncate(path, part):
    path.write_bytes(path.read_bytes()[: int(path.stat().st_size * part)])


def test_an_empty_contour_file(folder):
    (folder / "ball.json").write_text("")
    code, sentence = segment(folder)
    assert code == 69
    assert "ball.json holds no contours" in sentence


@pytest.mark.parametrize("part", [0.01, 0.3, 0.9])
def test_a_truncated_contour_file(folder, part):
    truncate(folder / "ball.json", part)
    code, sentence = segment(folder)
    assert code == 66
    assert "ball.json" in sentence


@pytest.mark.parametrize("part", [0, 0.1, 0.5, 0.95])
def test_a_truncated_image(folder, part):
    truncate(folder / IMAGE, part)
    code, sentence = segment(folder, more=["--picture", "out.png"])
    assert code == 66
    assert IMAGE in sentence


@pytest.mark.parametrize("name", ["lying.nii", "lying.nii.gz"])
def test_a_header_that_claims_more_than_the_file_holds_is_refused_before_allocation(folder, name):
    write_nifti(folder / "small.nii", numpy.zeros((4, 4, 4), numpy.int16))
    content = bytearray((folder / "small.nii").read_bytes())
    struct.pack_into("<8h", content, 40, 3, 1024, 1024, 2000, 1, 1, 1, 1)
    (folder / name).write_bytes(gzip.compress(content) if name.endswith("gz") else content)
    before = names(folder)
    result = kontur("segment", "ball.json", "--image", name, "--output", OUT, "--picture", "out.png", cwd=folder)
    assert result.returncode == 66
    assert name in result.stderr
    assert names(folder) == before
    assert peak_memory_mb(folder, "inspect", name) < 300  # 4.2 GB are claimed


def peak_memory_mb(folder, *words):
    process = subprocess.Popen([KONTUR, *words], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, _, usage = os.wait4(process.pid, 0)
    process.returncode = 0
    return usage.ru_maxrss / 1024


@pytest.mark.parametrize("contours, image", [("missing.json", IMAGE), ("ball.json", "missing.nii.gz")])
def test_a_missing_file(folder, contours, image):
    code, sentence = segment(folder, contours, image)
    assert code == 74
    assert "missing" in sentence


@pytest.mark.parametrize(
    "words",
    [
        ["--mesh", "out.step"],
        ["--picture", "out.jpeg"],
        ["--report", "out.xml"],
    ],
)
def test_an_unknown_extension_is_refused_before_the_work(folder, words):
    code, sentence = segment(folder, "missing.json", more=words)
    assert code == 69
    assert words[1] in sentence


def test_an_unknown_extension_of_the_mask(folder):
    code, sentence = segment(folder, output="out.jpeg")
    assert code == 69
    assert "out.jpeg" in sentence


@pytest.mark.parametrize("flag", ["--output", "--mesh", "--picture", "--report"])
def test_a_folder_that_does_not_exist_is_refused_before_the_work(folder, flag):
    outputs = {"--output": OUT, "--mesh": "out.stl", "--picture": "out.png", "--report": "out.report.json"}
    outputs[flag] = "nowhere/" + outputs[flag]
    mask = outputs.pop("--output")
    code, sentence = segment(folder, output=mask, more=[word for pair in outputs.items() for word in pair])
    assert code == 74
    assert "nowhere" in sentence


@pytest.mark.parametrize("output", [IMAGE, "./" + IMAGE])
def test_an_output_never_replaces_an_input(folder, output):
    content = (folder / IMAGE).read_bytes()
    code, sentence = segment(folder, output=output)
    assert code == 65
    assert "input" in sentence
    assert (folder / IMAGE).read_bytes() == content


OPTIONS = [
    ["--quality", "0"],
    ["--quality", "1.5"],
    ["--normal-offset-mm", "0"],
    ["--normal-offset-mm", "-1"],
    ["--normal-offset-mm", "nan"],
    ["--label-value", "0"],
    ["--label-value", "70000"],
]


@pytest.mark.parametrize("words", OPTIONS)
def test_an_option_out_of_its_range(folder, words):
    code, sentence = segment(folder, more=words)
    assert code == 65
    assert re.search(r"\d", sentence)


@pytest.mark.parametrize("spacing", ["0", "-1", "1,2", "1,1,0", "1,1,1,1", "nan", "1e-9", "0.001"])
def test_a_spacing_that_makes_no_grid(folder, spacing):
    before = names(folder)
    result = kontur("segment", "ball.json", "--spacing-mm", spacing, "--output", OUT, cwd=folder)
    assert result.returncode == (77 if spacing in ("1e-9", "0.001") else 65)
    assert re.fullmatch(r"kontur: error: .+\n", result.stderr), result
    assert names(folder) == before


def limit_file_size(size):
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_DFL)  # which ends the process, as it does in a user's shell
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return limit


def all_outputs(folder):
    return ["--output", folder / "out.nii", "--mesh", folder / "out.stl", "--picture", folder / "out.png", "--report", folder / "out.json"]


def test_a_write_that_fails_half_way_leaves_the_old_files(folder):
    # The mask is written, the mesh exceeds what the process may write.
    (folder / "out.nii").write_text("old")
    before = names(folder)
    result = kontur("segment", "ball.json", "--image", IMAGE, *all_outputs(folder), cwd=folder, preexec_fn=limit_file_size(100_000))
    assert result.returncode == 74
    assert re.fullmatch(r"kontur: error: cannot write .*out\.(stl|png): .+\n", result.stderr), result
    assert names(folder) == before
    assert (folder / "out.nii").read_text() == "old"


@pytest.fixture
def full_disk(tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=96k", "none", disk], capture_output=True)
    if mount.returncode != 0:
        pytest.skip("no permission to mount a small disk")
    yield disk
    subprocess.run(["umount", disk], check=True)


def test_a_full_disk(folder, full_disk):
    result = kontur("segment", folder / "ball.json", "--image", folder / IMAGE, *all_outputs(full_disk))
    assert result.returncode == 74
    assert "No space left on device" in result.stderr
    assert names(full_disk) == []


def test_a_folder_without_permission(folder):
    with tempfile.TemporaryDirectory() as name:  # pytest's own folder is closed to others
        open_folder = pathlib.Path(name)
        open_folder.chmod(0o755)
        (open_folder / "closed").mkdir(mode=0o555)
        for file in ("ball.json", IMAGE):
            shutil.copy(folder / file, open_folder)
        words = ["segment", "ball.json", "--image", IMAGE, "--output", "closed/out.nii.gz"]
        result = kontur_of_nobody(*words, cwd=open_folder)
        assert result.returncode == 74
        assert result.stderr == "kontur: error: cannot write closed/out.nii.gz: Permission denied\n"


def test_a_standard_output_that_is_full(folder):
    with open("/dev/full", "w") as full:
        result = subprocess.run([KONTUR, "inspect", folder / "ball.json"], stdout=full, stderr=subprocess.PIPE, text=True)
    assert result.returncode == 74
    assert result.stderr == "kontur: error: standard output cannot be written\n"


def test_names_that_cannot_be_reached_are_input_that_cannot_be_read(folder):
    os.symlink("loop", folder / "loop")
    for name in ("n" * 300, "loop", "loop.nii.gz"):
        for words in (["inspect", name], ["convert", name, "out.nrrd"], ["segment", "ball.json", "--image", name, "--output", OUT]):
            result = kontur(*words, cwd=folder)
            assert result.returncode == 74 and re.fullmatch(r"kontur: error: .+\n", result.stderr), (words, result)
            assert "unexpected" not in result.stderr


@pytest.mark.parametrize("value", ["0", "-3", "65536", "70000"])
def test_a_label_value_that_cannot_be_written_is_refused_before_anything_is_read(folder, value):
    code, sentence = segment(folder, "missing.json", more=["--label-value", value])
    assert code == 65
    assert f"label value {value} cannot be written" in sentence


def test_a_name_that_is_no_utf8_is_refused_before_anything_is_read(folder):
    code, sentence = segment(folder, "missing.json", more=["--name", "Leb\udce4r"])
    assert code == 65
    assert "the name 'Leb?r' is not UTF-8" in sentence


@pytest.mark.parametrize("name", ["a.json", "a.mrk.json", "a.nii", "a.mhd", "a.nrrd", "a.dcm", "a.hdr", "a.mgz", "a.gipl", "a.stl",
                                  "a.vtk", "a.vtp", "a.csv", "a.kontur", "nameless"])
def test_a_pipe_is_refused_at_once_wherever_a_file_is_read(folder, name):
    """Opening one waits for its writer."""
    os.mkfifo(folder / name)
    commands = [["inspect", name], ["segment", name, "--image", IMAGE, "-o", OUT], ["segment", "ball.json", "--image", name, "-o", OUT],
                ["convert", name, "out.nii"], ["convert", name, "out.json"], ["trace", IMAGE, "--planes", name, "-o", "out.json"],
                ["trace", name, "--planes", "ball.json", "-o", "out.json"], ["compare", IMAGE, name], ["batch", name],
                ["open", "--no-browser", "--timeout", "1", name], ["open", "--no-browser", "--timeout", "1", "--project", name]]
    for words in commands:
        result = subprocess.run([KONTUR, *words], cwd=folder, capture_output=True, text=True, timeout=20, stdin=subprocess.DEVNULL)
        assert result.returncode in (64, 65, 66, 69, 74), (words, result)
        assert re.search(r"^kontur: error: ", result.stderr, re.MULTILINE), (words, result)


def test_a_structure_without_contours_is_named_with_its_file(folder):
    planes = [plane | {"contours": []} for plane in ball_planes()]
    write_planes(folder / "empty.json", planes)
    code, sentence = segment(folder, "empty.json", more=["--roi", "Ball"])
    assert code == 65
    assert "empty.json: the structure 'Ball' has no contour; at least 1 is needed" in sentence
