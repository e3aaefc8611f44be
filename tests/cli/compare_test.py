# SPDX-License-Identifier: Apache-2.0
"""kontur compare against NumPy."""
import json
import math

import numpy
import pytest
from support import ball_array, dice, kontur, lps_affine, names, succeed, write_nifti


@pytest.fixture
def masks(tmp_path):
    a, b = ball_array(), ball_array(radius=9)
    return write_nifti(tmp_path / "a.nii.gz", a), write_nifti(tmp_path / "b.nii.gz", b), a, b


def test_overlap_and_volumes_are_numpys(masks):
    path_a, path_b, a, b = masks
    found = json.loads(succeed("compare", path_a, path_b, "--json"))
    assert found["dice"] == pytest.approx(dice(a, b), abs=1e-12)
    assert found["jaccard"] == pytest.approx(numpy.count_nonzero(a & b) / numpy.count_nonzero(a | b), abs=1e-12)
    assert found["volume_a_ml"] == pytest.approx(numpy.count_nonzero(a) / 1000)
    assert found["volume_b_ml"] == pytest.approx(numpy.count_nonzero(b) / 1000)
    # Two concentric balls 1 mm apart, on 1 mm voxels.
    assert 0.5 < found["mean_surface_distance_mm"] < found["hausdorff95_mm"] <= found["hausdorff_mm"] <= math.sqrt(3)


def test_text_has_the_same_names_as_json(masks):
    path_a, path_b, _, _ = masks
    text = succeed("compare", path_a, path_b)
    assert [line.split()[0] for line in text.splitlines()] == list(json.loads(succeed("compare", path_a, path_b, "--json")))


def test_differences_are_where_one_mask_is_and_the_other_not(tmp_path, masks):
    path_a, path_b, a, b = masks
    changed = b.copy()
    changed[0, 0, 0:2] = 1
    inside = numpy.argwhere(b)
    changed[tuple(inside[len(inside) // 2])] = 0
    path = write_nifti(tmp_path / "c.nii.gz", changed)
    far, near = json.loads(succeed("compare", path, path_b, "--differences", 9, "--json"))["differences"]
    away = numpy.linalg.norm(inside - [0, 0, 0], axis=1).min()
    assert (far["only_in"], far["volume_ml"]) == ("a", 0.002)
    assert far["distance_mm"] == pytest.approx(away)
    assert far["at_mm"] == pytest.approx((lps_affine() @ [0, 0, 0, 1])[:3])
    assert (near["only_in"], near["volume_ml"], near["distance_mm"]) == ("b", 0.001, pytest.approx(1))
    assert json.loads(succeed("compare", path, path_b, "--differences", 1, "--json"))["differences"] == [far]
    assert json.loads(succeed("compare", path_a, path_a, "--differences", 9, "--json"))["differences"] == []
    assert "only_in" in succeed("compare", path, path_b, "--differences", 9)
    assert kontur("compare", path, path_b, "--differences", -1).returncode == 64


def test_a_mask_equals_itself(masks):
    found = json.loads(succeed("compare", masks[0], masks[0], "--json"))
    assert (found["dice"], found["jaccard"], found["hausdorff_mm"]) == (1, 1, 0)


def test_label_chooses_the_voxels_of_one_label(tmp_path, masks):
    labels = write_nifti(tmp_path / "labels.nii.gz", masks[2] * 3 + masks[3] * 4)  # 3: the shell, 7: the smaller ball
    found = json.loads(succeed("compare", labels, labels, "--label", 7, "--json"))
    assert found["volume_a_ml"] == pytest.approx(numpy.count_nonzero(masks[3]) / 1000)


def test_the_second_file_may_have_another_label_and_frame(tmp_path, masks):
    labels = write_nifti(tmp_path / "labels.nii.gz", masks[2] * 3 + masks[3] * 4)
    result = kontur("compare", masks[0], labels, "--label-b", 7, "--json")
    found = json.loads(result.stdout)
    assert (found["label_a"], found["label_b"]) == (1, 7)
    assert found["dice"] == pytest.approx(dice(masks[2], masks[3]), abs=1e-12)
    assert result.stderr == f"kontur: note: label 1 of {masks[0]} is compared with label 7 of {labels}\n"
    phases = write_nifti(tmp_path / "phases.nii.gz", numpy.stack([masks[2], masks[3]], axis=3))
    assert json.loads(succeed("compare", masks[1], phases, "--frame-b", 2, "--json"))["dice"] == 1
    assert json.loads(succeed("compare", phases, masks[0], "--frame", 1, "--frame-b", 1, "--json"))["dice"] == 1
    assert json.loads(succeed("compare", phases, phases, "--frame", 1, "--json"))["dice"] == 1


def test_labels_that_differ_by_themselves_are_told(tmp_path, masks):
    sevens = write_nifti(tmp_path / "sevens.nii.gz", masks[2] * 7)
    result = kontur("compare", masks[0], sevens, "--json")
    assert result.returncode == 0 and "label 1 of " in result.stderr and "label 7 of " in result.stderr
    empty = write_nifti(tmp_path / "empty.nii.gz", masks[2] * 0)
    assert json.loads(succeed("compare", empty, sevens, "--json"))["label_a"] is None
    labels = write_nifti(tmp_path / "labels.nii.gz", masks[2] * 3 + masks[3] * 4)
    assert "has 2 labels; choose one of 3, 7" in kontur("compare", masks[0], labels).stderr


def test_masks_on_different_grids_are_refused_with_the_difference(tmp_path, masks):
    shifted = write_nifti(tmp_path / "shifted.nii.gz", masks[2], lps_affine(origin=(-8, -27, -12.5)))
    result = kontur("compare", masks[0], shifted)
    assert result.returncode == 65
    assert "2.5" in result.stderr and "mm" in result.stderr


def test_a_label_that_no_voxel_has_is_refused(masks):
    result = kontur("compare", masks[0], masks[1], "--label", 9)
    assert result.returncode == 65
    assert "9" in result.stderr


def test_writes_no_file(tmp_path, masks):
    before = names(tmp_path)
    succeed("compare", masks[0], masks[1], cwd=tmp_path)
    assert names(tmp_path) == before
