# SPDX-License-Identifier: Apache-2.0
"""kontur inspect says what files are."""
import json

import numpy
import pytest
from support import ball_array, ball_planes, circle, kontur, lps_affine, names, succeed, write_nifti, write_planes


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
