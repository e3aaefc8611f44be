# SPDX-License-Identifier: Apache-2.0
"""kontur inspect says what files are."""
import json
import pathlib
import re
import subprocess
import sys

import numpy
import pytest
from support import ball_array, ball_planes, circle, kontur, lps_affine, names, real_data, succeed, write_nifti, write_planes

SUPPORT = pathlib.Path(__file__).parent.parent / "support"


def inspect(*paths):
    return json.loads(succeed("inspect", *paths, "--json"))


def test_a_label_map_shows_geometry_and_each_labels_volume(tmp_path):
    labels = ball_array(affine=lps_affine(2.0), shape=(20, 20, 15)) * 5
    labels[0, 0, 0] = 2
    [facts] = inspect(write_nifti(tmp_path / "labels.nii.gz", labels, lps_affine(2.0)))
    assert facts["kind"] == "image"
    assert facts["size"] == [20, 20, 15]
    assert facts["spacing_mm"] == [2, 2, 2]
    assert facts["origin_mm"] == [-8, -27, -15]
    assert (facts["axes"], facts["obliqueness_deg"], facts["shear_deg"], facts["left_handed"]) == ("LPS", 0, 0, False)
    assert (facts["samples"], facts["min"], facts["max"]) == ("uint8", 0, 5)
    voxels = int(numpy.count_nonzero(labels == 5))
    assert facts["labels"] == [
        {"label": 2, "voxels": 1, "volume_ml": pytest.approx(0.008)},
        {"label": 5, "voxels": voxels, "volume_ml": pytest.approx(voxels * 0.008)},
    ]


def rotation(axis, degrees):
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    c, s = numpy.cos(numpy.radians(degrees)), numpy.sin(numpy.radians(degrees))
    turn = numpy.eye(3)
    turn[i, i], turn[i, j], turn[j, i], turn[j, j] = c, -s, s, c
    return turn


@pytest.mark.parametrize(
    "linear, axes, oblique, shear, left_handed",
    [
        (numpy.diag([-1.0, -1.0, 1.0]), "RAS", 0, 0, False),
        (numpy.diag([1.0, 1.0, -1.0]), "LPI", 0, 0, True),
        (numpy.array([[0.0, 0, 1], [1, 0, 0], [0, -1, 0]]), "PIL", 0, 0, True),
        (rotation(0, 20) @ numpy.diag([1.0, 1, 3]), "LPS", 20, 0, False),
        (numpy.array([[1.0, 0, 0], [0, 1, numpy.tan(numpy.radians(18))], [0, 0, 1]]), "LPS", 18, 18, False),
    ],
)
def test_axes_obliqueness_shear_and_handedness(tmp_path, linear, axes, oblique, shear, left_handed):
    affine = numpy.eye(4)
    affine[:3, :3] = linear
    array = numpy.arange(60, dtype=numpy.int16).reshape(3, 4, 5)
    [facts] = inspect(write_nifti(tmp_path / "image.nii.gz", array, affine))
    assert facts["axes"] == axes
    assert facts["obliqueness_deg"] == pytest.approx(oblique, abs=1e-3)
    assert facts["shear_deg"] == pytest.approx(shear, abs=1e-3)
    assert facts["left_handed"] is left_handed


def test_an_image_that_is_no_label_map_has_no_labels(tmp_path):
    array = numpy.linspace(-1, 1, 60, dtype=numpy.float32).reshape(3, 4, 5)
    [facts] = inspect(write_nifti(tmp_path / "image.nii.gz", array))
    assert (facts["samples"], facts["labels"], facts["min"], facts["max"]) == ("float32", [], -1, 1)


def test_labels_that_a_writer_scaled_are_listed_with_a_note(tmp_path):
    scaled = numpy.float32(0.99995) * (ball_array(affine=lps_affine(2.0), shape=(20, 20, 15)) * 5)
    [facts] = inspect(write_nifti(tmp_path / "labels.nii.gz", scaled, lps_affine(2.0)))
    assert [label["label"] for label in facts["labels"]] == [5]
    assert ["they are rounded" in note for note in facts["notes"]] == [True]


def test_of_several_frames_the_first_is_described_and_all_are_counted(tmp_path):
    frames = numpy.zeros((5, 4, 3, 6), numpy.int16) + 10 * numpy.arange(6, dtype=numpy.int16)
    path = write_nifti(tmp_path / "cine.nii.gz", frames)
    [facts] = inspect(path)
    assert (facts["size"], facts["frames"], facts["max"]) == ([5, 4, 3], 6, 0)
    assert facts["notes"] == ["the values are those of frame 1; --frame takes another"]
    [facts] = inspect(path, "--frame", "4")
    assert facts["max"] == 30 and "frames" not in facts


@pytest.mark.parametrize("bad", [numpy.nan, numpy.inf, -numpy.inf])
@pytest.mark.parametrize("at", [0, 7, -1])
def test_values_that_are_not_finite_are_left_out_of_the_range_and_counted(tmp_path, bad, at):
    array = numpy.linspace(-1, 1, 60, dtype=numpy.float32)
    array[3], array[50] = -5, 5
    array[[at, 20]] = bad
    [facts] = inspect(write_nifti(tmp_path / "image.nii.gz", array.reshape(3, 4, 5)))
    assert (facts["min"], facts["max"], facts["not_finite"]) == (-5, 5, 2)
    [facts] = inspect(write_nifti(tmp_path / "none.nii.gz", numpy.full((3, 4, 5), bad, numpy.float32)))
    assert (facts["min"], facts["max"], facts["not_finite"]) == (None, None, 60)


def test_no_zero_has_a_sign(tmp_path):
    path = write_nifti(tmp_path / "image.nii.gz", ball_array(), lps_affine(origin=(0, 0, 0)))
    assert re.search(r"^  origin_mm +0 0 0$", succeed("inspect", path), re.MULTILINE)
    assert '-0.0' not in succeed("inspect", path, "--json")


TETRAHEDRON = ["v 5 5 5", "v 6 5 5", "v 5 6 5", "v 5 5 6", "f 1 3 2", "f 1 2 4", "f 2 3 4", "f 3 1 4"]


def inspect_mesh(folder, lines):
    (folder / "mesh.obj").write_text("\n".join(lines) + "\n")
    return inspect(folder / "mesh.obj")[0]


def test_only_a_mesh_that_encloses_a_volume_has_one(tmp_path):
    facts = inspect_mesh(tmp_path, TETRAHEDRON)
    assert (facts["closed"], facts["oriented"], facts["faces_inwards"]) == (True, True, False)
    assert facts["volume_ml"] == pytest.approx(1 / 6000, rel=1e-6)
    facts = inspect_mesh(tmp_path, [f"f {' '.join(reversed(x.split()[1:]))}" if x[0] == "f" else x for x in TETRAHEDRON])
    assert facts["volume_ml"] == pytest.approx(1 / 6000, rel=1e-6) and facts["faces_inwards"] is True
    one_turned = [*TETRAHEDRON[:-1], "f 1 3 4"]
    for lines in (TETRAHEDRON[:-1], one_turned):
        facts = inspect_mesh(tmp_path, lines)
        assert (facts["volume_ml"], facts["faces_inwards"]) == (None, None)


def test_contours_show_planes_extent_and_no_problem(tmp_path):
    [facts] = inspect(write_planes(tmp_path / "ball.json", ball_planes()))
    assert facts["kind"] == "contours"
    assert (facts["name"], facts["planes"], facts["contours"], facts["holes"], facts["points"]) == ("ball", 9, 9, 0, 360)
    assert facts["extent_mm"][0] == pytest.approx([2, -17, -5], abs=0.1)
    assert facts["extent_mm"][1] == pytest.approx([22, 3, 15], abs=0.1)
    assert facts["problems"] == []


def test_problems_of_contours_are_listed_each(tmp_path):
    planes = [circle("z", 0), circle("z", 2), circle("z", 4)]
    planes[0]["contours"][0]["points"] = planes[0]["contours"][0]["points"][:2]
    planes[2]["contours"][0]["points"][3][2] += 1.5
    [facts] = inspect(write_planes(tmp_path / "bad.json", planes))
    assert len(facts["problems"]) == 2
    assert facts["problems"][0] == "contour 1 has 2 points; at least 3 are needed"
    assert "contour 3 lies 1.5 mm off its plane" in facts["problems"][1]


def check(*paths):
    result = kontur("inspect", "--check", *paths, "--json")
    return json.loads(result.stdout), result.returncode


def test_check_lists_what_is_doubtful_with_its_place(tmp_path):
    planes = ball_planes()
    points = planes[0]["contours"][0]["points"]
    points[5], points[25] = points[25], points[5]
    [facts], code = check(write_planes(tmp_path / "doubtful.json", planes))
    assert code == 0
    finding = next(f for f in facts["findings"] if f["kind"] == "self_crossing")
    assert (finding["severity"], finding["contour"]) == ("warning", 1)
    assert len(finding["position_mm"]) == 3
    text = succeed("inspect", "--check", tmp_path / "doubtful.json")
    assert "warning: contour 1 crosses itself in " in text


def test_check_of_a_sound_set_finds_nothing(tmp_path):
    [facts], code = check(write_planes(tmp_path / "ball.json", ball_planes()))
    assert (facts["findings"], code) == ([], 0)
    assert "findings" not in inspect(tmp_path / "ball.json")[0]


def test_check_ends_with_65_when_there_are_errors(tmp_path):
    planes = [circle("z", 0), circle("z", 2), circle("z", 4)]
    planes[0]["contours"][0]["points"] = planes[0]["contours"][0]["points"][:2]
    planes[2]["contours"][0]["points"][3][2] += 1.5
    path = write_planes(tmp_path / "bad.json", planes)
    [facts], code = check(path)
    assert code == 65
    assert [f["kind"] for f in facts["findings"] if f["severity"] == "error"] == ["too_few_points", "off_plane"]
    assert f"kontur: error: {path} has 2 errors" in kontur("inspect", "--check", path).stderr


def test_check_names_the_structure_of_a_structure_set():
    path = real_data("09_rtstruct_breast_dicompyler/rtss.dcm")
    [facts], code = check(path)
    assert code == 0
    assert {"BODY", "Lt Lung"} <= {f["roi"] for f in facts["findings"]}
    assert "note: Lt Lung: contour " in succeed("inspect", "--check", path)


def test_text_names_what_json_names(tmp_path):
    path = write_planes(tmp_path / "ball.json", ball_planes())
    lines = succeed("inspect", path).splitlines()
    assert lines[0] == str(path)
    assert {line.split()[0] for line in lines[1:] if line.strip()} >= set(inspect(path)[0]) - {"file"}


def test_an_unreadable_file_does_not_hide_the_others(tmp_path):
    broken = tmp_path / "broken.nii.gz"
    broken.write_bytes(b"no image")
    good = write_planes(tmp_path / "ball.json", ball_planes())
    result = kontur("inspect", broken, good, "--json")
    first, second = json.loads(result.stdout)
    assert result.returncode == 66
    assert "broken.nii.gz" in first["error"]
    assert second["contours"] == 9


def test_writes_no_file(tmp_path):
    path = write_planes(tmp_path / "ball.json", ball_planes())
    succeed("inspect", path, cwd=tmp_path)
    assert names(tmp_path) == ["ball.json"]


def test_damage_in_one_roi_is_told_beside_the_others(tmp_path):
    subprocess.run([sys.executable, SUPPORT / "make_rtstruct.py", "count", tmp_path / "rs.dcm"], check=True)
    result = kontur("inspect", tmp_path / "rs.dcm", "--json")
    damage = "ROI 1 'plain': contour 2: it declares 5 points and has 4"
    assert result.returncode == 66 and result.stderr.endswith(f"rs.dcm: {damage}\n"), result
    [facts] = json.loads(result.stdout)
    assert facts["rois"][0]["damage"] == damage and "problems" not in facts["rois"][0]
    assert facts["rois"][3]["contours"] == 2 and "damage" not in facts["rois"][3]
    words = ["--spacing-mm", "1", "--output", tmp_path / "m.nii.gz"]
    assert kontur("segment", tmp_path / "rs.dcm", "--roi", "nested", *words).returncode == 0
    refused = kontur("segment", tmp_path / "rs.dcm", "--roi", "plain", *words)
    assert refused.returncode == 66 and refused.stderr.endswith(f"{damage}\n"), refused
