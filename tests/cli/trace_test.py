# SPDX-License-Identifier: Apache-2.0
"""kontur trace: a ball's mask cut by planes gives circles."""
import json
import pathlib
import subprocess
import sys

import nibabel
import numpy
import pydicom
import pytest
from support import CENTER, RADIUS, ball_array, kontur, names, succeed, write_nifti, write_planes


def dicom_images(folder):
    script = pathlib.Path(__file__).parents[1] / "support" / "make_dicom_series.py"
    subprocess.run([sys.executable, script, "axial", folder / "axial"], check=True)
    return folder / "axial" / "dicom"


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


def test_all_labels_become_the_rois_of_one_structure_set(tmp_path):
    images = dicom_images(tmp_path)
    succeed("convert", images, tmp_path / "ct.nii.gz")
    ct = nibabel.load(tmp_path / "ct.nii.gz")
    labels = numpy.zeros(ct.shape, numpy.uint8)
    labels[2:6, 2:7, 2:6], labels[8:12, 3:8, 3:7] = 7, 9
    nibabel.save(nibabel.Nifti1Image(labels, ct.affine), tmp_path / "organs.nii.gz")
    result = kontur("trace", tmp_path / "organs.nii.gz", "--all-labels", "--image", images, "-o", tmp_path / "rs.dcm")
    assert result.returncode == 0 and "2 structures with 8 contours" in result.stdout, result
    made = pydicom.dcmread(tmp_path / "rs.dcm")
    assert [roi.ROIName for roi in made.StructureSetROISequence] == ["organs label 7", "organs label 9"]
    assert [len(roi.ContourSequence) for roi in made.ROIContourSequence] == [4, 4]
    colors = [tuple(roi.ROIDisplayColor) for roi in made.ROIContourSequence]
    assert len(set(colors)) == 2, colors
    one = kontur("trace", tmp_path / "organs.nii.gz", "--image", images, "-o", tmp_path / "one.dcm")
    assert one.returncode == 65 and one.stderr.endswith("with --label, or take them all with --all-labels\n"), one
    refused = kontur("trace", tmp_path / "organs.nii.gz", "--all-labels", "-o", tmp_path / "rs.json")
    assert refused.returncode == 65 and "--all-labels is for an RTSTRUCT (.dcm)" in refused.stderr, refused


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
