# SPDX-License-Identifier: Apache-2.0
"""What every command says of faults: the nearest name for a slip of the fingers, options as they are typed, the input and never the output
for a fault of the input, and one sentence for many equal doubts."""
import json
import math
import re
import subprocess
import sys
import pathlib

import nibabel
import numpy
import pytest
from support import ball_array, ball_planes, kontur, succeed, write_nifti, write_planes

SUPPORT = pathlib.Path(__file__).parent.parent / "support"


def commands():
    text = succeed("--help")
    listed = text[text.index("Subcommands:"):].split("\n\n")[0]
    return re.findall(r"^  ([a-z-]+) ", listed, re.MULTILINE)


COMMANDS = commands()


def options(command):
    return sorted(set(re.findall(r"(?<![\w-])--[a-z][a-z0-9_-]+", kontur(command, "--help").stdout.split("Example:")[0])))


def slips(word):
    """Each way to swap two neighbouring letters of a word."""
    return {word[:n] + word[n + 1] + word[n] + word[n + 2:] for n in range(len(word) - 1) if word[n] != word[n + 1]} - {word}


def test_the_commands_are_found():
    assert {"segment", "fill", "correct", "open", "slicer-fill"} <= set(COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_a_slip_in_a_command_is_told_it(command):
    for word in sorted(slips(command))[:3]:
        result = kontur(word, "a", "b")
        assert result.returncode == 64 and result.stderr.endswith(f"; did you mean {command}?\n"), result


@pytest.mark.parametrize("command", COMMANDS)
def test_a_slip_in_any_option_is_told_it(command):
    known = options(command)
    assert "--help" in known
    for option in known:
        word = "--" + sorted(slips(option[2:]) - {name[2:] for name in known})[0]
        result = kontur(command, word, "a", "b")
        assert result.returncode == 64, result
        assert result.stderr == f"kontur: error: there is no option {word}; did you mean {option}?\n"


def cut(path, part=0.6):
    path.write_bytes(path.read_bytes()[: int(path.stat().st_size * part)])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Of each kind of input one that is sound and some that are not. No command of these tests writes there."""
    tmp_path = tmp_path_factory.mktemp("inputs")
    write_planes(tmp_path / "ball.json", ball_planes())
    write_nifti(tmp_path / "mask.nii.gz", ball_array())
    write_nifti(tmp_path / "sparse.nii.gz", ball_array() * (numpy.arange(40) % 5 == 0).astype(numpy.uint8))
    write_nifti(tmp_path / "float.nii.gz", ball_array() * numpy.float32(0.5))
    write_nifti(tmp_path / "frames.nii.gz", numpy.stack([ball_array()] * 2, axis=-1))
    write_nifti(tmp_path / "two.nii.gz", ball_array() + ball_array(radius=4))
    write_nifti(tmp_path / "empty.nii.gz", ball_array() * 0)
    for name in ("mask", "ball"):
        source = next(tmp_path.glob(name + ".*"))
        (tmp_path / ("cut_" + source.name)).write_bytes(source.read_bytes())
        cut(tmp_path / ("cut_" + source.name))
    torn = nibabel.load(tmp_path / "mask.nii.gz")
    torn.set_qform(torn.affine + numpy.pad([[7.0]], ((0, 3), (3, 0))), code=1)
    nibabel.save(torn, tmp_path / "torn.nii.gz")
    planes = ball_planes()
    planes[8]["contours"][0]["points"][3][2] += 2.5
    write_planes(tmp_path / "bent.json", planes)
    write_planes(tmp_path / "nothing.json", [plane | {"contours": []} for plane in ball_planes()])
    for case, name in (("axial", "dicom"), ("missing", "gaps"), ("other_series", "series")):
        subprocess.run([sys.executable, SUPPORT / "make_dicom_series.py", case, tmp_path / case], check=True)
        (tmp_path / case / "dicom").rename(tmp_path / name)
    for name in ("far.stl", "open.stl"):
        corners = [(0, 0, 0), (9, 0, 0), (0, 9, 0), (0, 0, 9)]
        faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)][: 4 if name == "far.stl" else 3]
        offset = 5000 if name == "far.stl" else 0
        text = "".join("facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {' '.join(str(c + offset) for c in corners[v])}\n" for v in face)
                       + "endloop\nendfacet\n" for face in faces)
        (tmp_path / name).write_text(f"solid x\n{text}endsolid x\n")
    return tmp_path


# Words with a fault of an input, and the input.
FAULTS = [
    ("segment cut_ball.json --image mask.nii.gz", "cut_ball.json"), ("segment bent.json --image mask.nii.gz", "bent.json"),
    ("segment nothing.json --image mask.nii.gz", "nothing.json"), ("segment none.json --image mask.nii.gz", "none.json"),
    ("segment ball.json --image cut_mask.nii.gz", "cut_mask.nii.gz"), ("segment ball.json --image frames.nii.gz", "frames.nii.gz"),
    ("segment ball.json --image none.nii.gz", "none.nii.gz"),
    ("trace cut_mask.nii.gz", "cut_mask.nii.gz"), ("trace float.nii.gz", "float.nii.gz"), ("trace two.nii.gz", "two.nii.gz"),
    ("trace mask.nii.gz --planes cut_ball.json", "cut_ball.json"),
    ("trace frames.nii.gz", "frames.nii.gz"), ("trace none.nii.gz", "none.nii.gz"),
    ("fill cut_mask.nii.gz", "cut_mask.nii.gz"), ("fill float.nii.gz", "float.nii.gz"), ("fill empty.nii.gz", "empty.nii.gz"),
    ("fill none.nii.gz", "none.nii.gz"), ("fill sparse.nii.gz --image cut_mask.nii.gz", "cut_mask.nii.gz"),
    ("correct cut_mask.nii.gz ball.json", "cut_mask.nii.gz"), ("correct mask.nii.gz cut_ball.json", "cut_ball.json"),
    ("correct mask.nii.gz bent.json", "bent.json"), ("correct two.nii.gz ball.json", "two.nii.gz"),
    ("correct float.nii.gz ball.json", "float.nii.gz"), ("correct none.nii.gz ball.json", "none.nii.gz"),
    ("suggest cut_ball.json", "cut_ball.json"), ("suggest bent.json", "bent.json"), ("suggest nothing.json", "nothing.json"),
    ("convert float.nii.gz OUT.seg.nrrd", "float.nii.gz"), ("convert cut_mask.nii.gz OUT.nrrd", "cut_mask.nii.gz"),
    ("convert frames.nii.gz OUT.nrrd", "frames.nii.gz"), ("convert float.nii.gz OUT.dcm --image dicom", "float.nii.gz"),
    ("convert mask.nii.gz OUT.dcm --image dicom", "mask.nii.gz"), ("convert cut_ball.json OUT.mrk.json", "cut_ball.json"),
    ("convert open.stl OUT.nii.gz --image mask.nii.gz", "open.stl"), ("convert far.stl OUT.nii.gz --image mask.nii.gz", "far.stl"),
    ("convert none.stl OUT.ply", "none.stl"),
    ("convert bent.json OUT.dcm --image dicom", "bent.json"), ("convert bent.json OUT.mrk.json", "bent.json"),
    ("convert nothing.json OUT.dcm --image dicom", "nothing.json"),
    ("compare cut_mask.nii.gz mask.nii.gz", "cut_mask.nii.gz"), ("compare mask.nii.gz float.nii.gz", "float.nii.gz"),
    ("inspect cut_mask.nii.gz", "cut_mask.nii.gz"), ("batch none.csv", "none.csv"),
    ("slicer --reference mask.nii.gz --contour bent.json --mask OUT.nrrd", "bent.json"),
    ("slicer-fill --labels cut_mask.nii.gz --filled OUT.nrrd", "cut_mask.nii.gz"),
]
ENDINGS = {"segment": "-o OUT.nii.gz", "trace": "-o OUT.json", "fill": "-o OUT.nii.gz", "correct": "-o OUT.nii.gz", "suggest": "-o OUT.json"}


@pytest.mark.parametrize("words, name", FAULTS)
def test_a_fault_of_an_input_names_it_and_not_the_output(folder, words, name):
    words = words.split() + ENDINGS.get(words.split()[0], "").split()
    result = kontur(*words, cwd=folder)
    made = list(folder.glob("OUT*"))
    for path in made:
        path.unlink()
    # An image of which the header alone is sound still gives the grid, with a warning.
    assert result.returncode in ((0,) if "--image cut_mask" in " ".join(words) or "--image frames" in " ".join(words) else (65, 66, 69, 74)), result
    assert name in result.stderr and "OUT." not in result.stderr, result.stderr
    assert not made or result.returncode == 0
    assert "the option " not in result.stderr, "options are named as they are typed"


@pytest.mark.parametrize("words", ["segment ball.json --image frames.nii.gz -o a.nii", "trace two.nii.gz -o a.json", "convert frames.nii.gz a.nrrd",
                                   "compare two.nii.gz mask.nii.gz", "compare frames.nii.gz mask.nii.gz", "fill frames.nii.gz -o a.nii",
                                   "correct two.nii.gz ball.json -o a.nii", "correct frames.nii.gz ball.json -o a.nii",
                                   "convert mask.nii.gz a.dcm --image dicom", "segment ball.json --image gaps -o a.nii",
                                   "trace mask.nii.gz --image gaps -o a.json", "convert gaps a.nii",
                                   "trace mask.nii.gz --image series -o a.json", "fill sparse.nii.gz --image series -o a.nii"])
def test_what_leads_on_is_an_option_that_the_command_has(folder, words):
    words = words.split()
    said = kontur(*words, cwd=folder).stderr
    for path in folder.glob("a.*"):
        path.unlink()
    named = re.findall(r"(?<!kontur segment )--[a-z-]+", said)
    assert named, said
    assert set(named) <= set(options(words[0])), said


@pytest.mark.parametrize("words", ["slicer-fill --labels frames.nii.gz --filled a.nrrd",
                                   "slicer-fill --labels sparse.nii.gz --image frames.nii.gz --filled a.nrrd",
                                   "slicer --reference torn.nii.gz --contour ball.json --mask a.nrrd"])
def test_what_a_command_cannot_choose_another_does(folder, words):
    words = words.split()
    result = kontur(*words, cwd=folder)
    [named] = re.findall(r"kontur convert (--[a-z-]+)", result.stdout + result.stderr)
    assert named not in options(words[0]) and named in options("convert"), result
    assert set(re.findall(r"--[a-z-]+", result.stderr)) == {named}, result


def test_only_a_drawing_that_says_where_its_planes_are_keeps_what_lies_off_them(folder, tmp_path):
    for name in ("bent.json", "nothing.json"):
        succeed("convert", folder / name, tmp_path / name)


def ring(x, y, z, radius, points=40, start=0.0):
    angles = [start + 2 * math.pi * n / points for n in range(points)]
    return {"closed": True, "hole": False, "points": [[x + radius * math.cos(a), y + radius * math.sin(a), z] for a in angles]}


def with_hole_mark(contour):
    return contour | {"hole": True}


def spiked(contour):
    points = contour["points"]
    tip = [2 * points[5][0] - points[25][0] * 0.8 - points[5][0] * 0.2, points[5][1], points[5][2]]
    return contour | {"points": points[:6] + [tip] + points[5:]}


DOUBTS = {
    "overlapping": lambda z: [ring(0, 0, z, 20), ring(32, 0, z, 20)],
    "doubled": lambda z: [ring(0, 0, z, 20), ring(0, 0, z, 20, start=0.05)],
    "repeated": lambda z: [ring(0, 0, z, 20), ring(0, 0, z, 20)],
    "spiked": lambda z: [spiked(ring(0, 0, z, 20))],
    "stray_holes": lambda z: [ring(0, 0, z, 20), with_hole_mark(ring(80, 0, z, 5))],
    "unmarked_holes": lambda z: [ring(0, 0, z, 20), ring(0, 0, z, 8)],
    "lines": lambda z: [ring(0, 0, z, 20), {"closed": True, "hole": False, "points": [[30, t, z] for t in (0, 1, 2, 3)]}],
    "specks": lambda z: [ring(0, 0, z, 20), ring(40, 0, z, 0.002)],
    "open": lambda z: [ring(0, 0, z, 20) | {"closed": False}],
    "islands": lambda z: [ring(0, 0, z, 20), ring(0, 0, z, 12), ring(0, 0, z, 5)],
    "contradicting": lambda z: [ring(0, 0, z, 20)],
}


def kinds_of(text):
    """The sentences without numbers: two that are equal say the same of different things."""
    sentences = [re.sub(r"[-+]?\d+(\.\d+)?(e[-+]?\d+)?", "N", line) for line in text.splitlines() if "warning" in line or "note" in line]
    return sentences


@pytest.mark.parametrize("name", DOUBTS)
def test_many_equal_doubts_are_one_sentence(tmp_path, name):
    planes = [{"origin": [0, 0, z], "normal": [0, 0, 1], "u": [1, 0, 0], "v": [0, 1, 0], "contours": DOUBTS[name](z)} for z in range(0, 60, 3)]
    if name == "contradicting":
        for x in range(-15, 20, 5):
            points = [[x, p[1] * 1.25, 28.5 + p[0] * 1.4] for p in ring(0, 0, 0, 20)["points"]]
            planes.append({"origin": [x, 0, 28.5], "normal": [1, 0, 0], "contours": [{"closed": True, "hole": False, "points": points}]})
    (tmp_path / "a.json").write_text(json.dumps({"frame": "LPS mm", "planes": planes}))
    for words in ("segment a.json --spacing-mm 3 -o a.nii.gz", "suggest a.json", "convert a.json a.mrk.json"):
        result = kontur(*words.split(), cwd=tmp_path)
        assert result.returncode in (0, 65), result
        said = kinds_of(result.stdout + result.stderr)
        assert len(said) == len(set(said)), result.stderr
        assert len(said) <= 8, result.stderr
