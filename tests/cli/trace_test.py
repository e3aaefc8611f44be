# SPDX-License-Identifier: Apache-2.0
"""kontur trace: a ball's mask cut by planes gives circles."""
import json

import numpy
import pytest
from support import CENTER, RADIUS, ball_array, kontur, names, succeed, write_nifti, write_planes


def plane(origin, normal):
    normal = numpy.array(normal, float) / numpy.linalg.norm(normal)
    u = numpy.cross(normal, (0.3, 0.5, 0.8))
    u /= numpy.linalg.norm(u)
    v = numpy.cross(normal, u)
    return {"origin": list(origin), "normal": normal.tolist(), "u": u.tolist(), "v": v.tolist(), "contours": []}


def contours_of(path):
    return [(p, c) for p in json.loads(path.read_text())["planes"] for c in p["contours"]]


@pytest.mark.parametrize("normal", [(0, 0, 1), (1, 2, 3), (-1, 1, 0)])
def test_cut_through_a_balls_centre_is_a_circle_on_the_plane(tmp_path, normal):
    mask = write_nifti(tmp_path / "mask.nii.gz", ball_array())
    planes = write_planes(tmp_path / "planes.json", [plane(CENTER, normal)])
    succeed("trace", mask, "--planes", planes, "--output", tmp_path / "out.json")
    [(its_plane, contour)] = contours_of(tmp_path / "out.json")
    points = numpy.array(contour["points"]) - CENTER
    assert not contour["hole"]
    assert numpy.abs(points @ its_plane["normal"]).max() < 1e-6
    assert numpy.abs(numpy.linalg.norm(points, axis=1) - RADIUS).max() < 1.0


def test_without_planes_the_masks_own_slices_cut(tmp_path):
    array = ball_array()
    mask = write_nifti(tmp_path / "mask.nii.gz", array)
    succeed("trace", mask, "--output", tmp_path / "own.json")
    succeed("trace", mask, "--image", mask, "--output", tmp_path / "image.json")
    own = contours_of(tmp_path / "own.json")
    assert len(own) == numpy.count_nonzero(array.any(axis=(0, 1)))
    assert own == contours_of(tmp_path / "image.json")


def test_a_cavity_becomes_a_hole(tmp_path):
    mask = write_nifti(tmp_path / "mask.nii.gz", ball_array() - ball_array(radius=5))
    planes = write_planes(tmp_path / "planes.json", [plane(CENTER, (0, 0, 1))])
    succeed("trace", mask, "--planes", planes, "--output", tmp_path / "out.json")
    assert sorted(c["hole"] for _, c in contours_of(tmp_path / "out.json")) == [False, True]


def test_label_chooses_the_object(tmp_path):
    labels = ball_array(radius=4) * 2
    labels[2:5, 2:5, 20] = 1
    mask = write_nifti(tmp_path / "labels.nii.gz", labels)
    planes = write_planes(tmp_path / "planes.json", [plane(CENTER, (0, 0, 1))])
    succeed("trace", mask, "--label", 2, "--planes", planes, "--output", tmp_path / "out.json")
    [(_, contour)] = contours_of(tmp_path / "out.json")
    assert numpy.linalg.norm(numpy.array(contour["points"]) - CENTER, axis=1).max() < 5


def test_planes_beside_the_object_give_no_contour_and_a_warning(tmp_path):
    mask = write_nifti(tmp_path / "mask.nii.gz", ball_array())
    planes = write_planes(tmp_path / "planes.json", [plane((12, -7, 25), (0, 0, 1))])
    result = kontur("trace", mask, "--planes", planes, "--output", tmp_path / "out.json")
    assert result.returncode == 0
    assert result.stderr == "kontur: warning: the plane does not meet the mask\n"
    assert contours_of(tmp_path / "out.json") == []


def test_quiet_prints_nothing(tmp_path):
    mask = write_nifti(tmp_path / "mask.nii.gz", ball_array())
    planes = write_planes(tmp_path / "planes.json", [plane(CENTER, (0, 0, 1))])
    assert succeed("trace", mask, "--planes", planes, "--output", tmp_path / "out.json", "--quiet") == ""
    assert names(tmp_path) == ["mask.nii.gz", "out.json", "planes.json"]
