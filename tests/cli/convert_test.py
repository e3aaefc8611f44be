# SPDX-License-Identifier: Apache-2.0
"""kontur convert: the same content in another format, or a sentence that says why not."""
import json
import pathlib
import subprocess
import sys

import nibabel
import numpy
import pydicom
import pytest
from support import ball_array, ball_planes, circle, kontur, lps_affine, names, read_nifti, real_data, succeed, write_nifti, write_planes

SUPPORT = pathlib.Path(__file__).parents[1] / "support"


def sheared_affine():
    affine = lps_affine(2.0)
    affine[1, 2] = 0.7
    return affine


@pytest.mark.parametrize("through", ["nrrd", "mha", "nii"])
def test_an_image_survives_the_way_through_another_format(tmp_path, through):
    rng = numpy.random.default_rng(7)
    array = rng.integers(-1000, 3000, (5, 6, 7), dtype=numpy.int16)
    first = write_nifti(tmp_path / "in.nii.gz", array, sheared_affine())
    succeed("convert", first, tmp_path / f"middle.{through}")
    succeed("convert", tmp_path / f"middle.{through}", tmp_path / "out.nii.gz")
    before, after = nibabel.load(first), nibabel.load(tmp_path / "out.nii.gz")
    assert numpy.array_equal(numpy.asarray(before.dataobj), numpy.asarray(after.dataobj))
    assert numpy.allclose(before.affine, after.affine, atol=1e-5)
    assert after.get_data_dtype() == numpy.int16


def scaled_labels(path, largest_error):
    """Labels 1, 2, 12 off by up to `largest_error`, as scaling to 16 bits leaves them."""
    labels = numpy.zeros((6, 6, 6), numpy.float32)
    labels[1:3], labels[3:4], labels[4:5] = 1 - largest_error, 2 + largest_error, 12
    return write_nifti(path, labels)


def test_labels_that_a_writer_scaled_are_rounded_with_a_note(tmp_path):
    path = scaled_labels(tmp_path / "scaled.nii.gz", 9e-4)
    result = kontur("convert", path, tmp_path / "two.nii.gz", "--label", 2)
    assert result.returncode == 0, result
    assert "scaled.nii.gz: the values of 108 voxels are no integers but lie within 0.001 of one; they are rounded" in result.stderr
    assert set(numpy.unique(read_nifti(tmp_path / "two.nii.gz"))) == {0, 2}
    for words in (["fill", path, "-o"], ["trace", path, "--label", 1, "-o"], ["convert", path]):
        made = kontur(*words, tmp_path / ("out.json" if words[0] == "trace" else "out.seg.nrrd"))
        assert made.returncode == 0, made


def test_an_image_near_integers_is_converted_as_it_is(tmp_path):
    path = scaled_labels(tmp_path / "scaled.nii.gz", 9e-4)
    succeed("convert", path, tmp_path / "same.nii.gz")
    assert numpy.array_equal(read_nifti(path), read_nifti(tmp_path / "same.nii.gz"))


def test_fractions_are_no_labels_and_are_shown_with_their_digits(tmp_path):
    result = kontur("convert", scaled_labels(tmp_path / "f.nii.gz", 0.0011), tmp_path / "o.seg.nrrd")
    assert result.returncode == 65 and "f.nii.gz: the image is no label map" in result.stderr, result
    assert "the first is 0.9989\n" in result.stderr and "o.seg.nrrd" not in result.stderr, result


def test_a_structure_without_a_name_has_one_in_dicom(tmp_path):
    """plastimatch ends at an empty ROI Name."""
    subprocess.run([sys.executable, SUPPORT / "make_dicom_series.py", "axial", tmp_path / "axial"], check=True)
    images = tmp_path / "axial" / "dicom"
    path = write_planes(tmp_path / "c.json", [circle("z", 0.0)])
    contours = json.loads(path.read_text())
    for name in ("", "  "):
        path.write_text(json.dumps(contours | {"structure": name}))
        kontur("convert", path, tmp_path / "rs.dcm", "--image", images)
        assert [roi.ROIName for roi in pydicom.dcmread(tmp_path / "rs.dcm").StructureSetROISequence] == ["Structure_1"]


def test_series_of_results_are_told_apart_by_number_and_description(tmp_path):
    subprocess.run([sys.executable, SUPPORT / "make_dicom_series.py", "axial", tmp_path / "axial"], check=True)
    path = write_planes(tmp_path / "c.json", [circle("z", 0.0)])
    kontur("convert", path, tmp_path / "rs.dcm", "--image", tmp_path / "axial" / "dicom")
    made = pydicom.dcmread(tmp_path / "rs.dcm")
    day = f"{made.SeriesDate[:4]}-{made.SeriesDate[4:6]}-{made.SeriesDate[6:]}"
    assert made.SeriesDescription == f"kontur contours {day}: ball"
    assert made.SeriesNumber == max(1, int(made.SeriesTime))


def test_a_mask_on_part_of_a_grid_is_written_on_the_whole_one(tmp_path):
    whole = ball_array()
    image = write_nifti(tmp_path / "image.nii.gz", whole.astype(numpy.int16))
    part = lps_affine()
    part[:3, 3] += [5, 4, 3]
    write_nifti(tmp_path / "part.nii.gz", 3 * whole[5:35, 4:36, 3:38], part)
    succeed("convert", tmp_path / "part.nii.gz", tmp_path / "out.nii.gz", "--image", image)
    assert numpy.array_equal(read_nifti(tmp_path / "out.nii.gz"), 3 * whole)


def test_what_another_grid_cuts_off_is_a_warning(tmp_path):
    mask = write_nifti(tmp_path / "mask.nii.gz", ball_array())
    image = write_nifti(tmp_path / "half.nii.gz", ball_array()[:20])
    result = kontur("convert", mask, tmp_path / "out.nii.gz", "--image", image)
    assert result.returncode == 0 and "ml in place of 4.1" in result.stderr, result
    assert read_nifti(tmp_path / "out.nii.gz").sum() == ball_array()[:20].sum()
    fractions = write_nifti(tmp_path / "f.nii.gz", ball_array() * numpy.float32(0.5))
    refused = kontur("convert", fractions, tmp_path / "o.nii.gz", "--image", image)
    assert refused.returncode == 65 and "f.nii.gz: the image is no label map" in refused.stderr, refused


def test_frame_chooses_one_of_a_4d_image(tmp_path):
    array = numpy.stack([ball_array(), 2 * ball_array()], axis=-1)
    path = write_nifti(tmp_path / "4d.nii.gz", array)
    assert kontur("convert", path, tmp_path / "out.nii.gz").returncode != 0
    succeed("convert", path, tmp_path / "out.nii.gz", "--frame", 2)
    assert numpy.array_equal(numpy.asarray(nibabel.load(tmp_path / "out.nii.gz").dataobj), array[..., 1])


def test_contours_survive_the_way_through_markups(tmp_path):
    planes = ball_planes()
    first = write_planes(tmp_path / "in.json", planes)
    succeed("convert", first, tmp_path / "middle.mrk.json")
    succeed("convert", tmp_path / "middle.mrk.json", tmp_path / "out.json")
    after = json.loads((tmp_path / "out.json").read_text())
    before_points = [c["points"] for p in planes for c in p["contours"]]
    after_points = [c["points"] for p in after["planes"] for c in p["contours"]]
    assert numpy.allclose(before_points, after_points, atol=1e-6)


TETRAHEDRON = """# SPACE=LPS
v 0 0 0
v 10 0 0
v 0 10 0
v 0 0 10
f 1 3 2
f 1 2 4
f 1 4 3
f 2 3 4
"""


@pytest.mark.parametrize("through", ["stl", "ply", "obj"])
def test_a_mesh_keeps_its_volume_in_every_format(tmp_path, through):
    (tmp_path / "in.obj").write_text(TETRAHEDRON)
    succeed("convert", tmp_path / "in.obj", tmp_path / f"out.{through}")
    [facts] = json.loads(succeed("inspect", tmp_path / f"out.{through}", "--json"))
    assert (facts["kind"], facts["points"], facts["triangles"]) == ("mesh", 4, 4)
    assert (facts["closed"], facts["oriented"], facts["euler"]) == (True, True, 2)
    assert facts["volume_ml"] == pytest.approx(1 / 6, rel=1e-6)


def test_a_dicom_series_keeps_values_and_place(tmp_path):
    folder = real_data("03_sarcoma_STS_002/CT/image")
    assert kontur("convert", folder, tmp_path / "ct.nii.gz").returncode == 0
    slices = [pydicom.dcmread(file) for file in folder.glob("*.dcm")]
    slices.sort(key=lambda s: float(s.ImagePositionPatient[2]))
    hu = numpy.stack([s.pixel_array * float(s.RescaleSlope) + float(s.RescaleIntercept) for s in slices])
    image = nibabel.load(tmp_path / "ct.nii.gz")
    assert numpy.array_equal(numpy.asarray(image.dataobj), hu.transpose(2, 1, 0))
    x, y, z = map(float, slices[0].ImagePositionPatient)
    assert numpy.allclose(image.affine[:3, 3], [-x, -y, z], atol=1e-3)


def test_slices_that_lie_unevenly_are_resampled_where_that_is_asked_for(tmp_path):
    subprocess.run([sys.executable, SUPPORT / "make_dicom_series.py", "missing", tmp_path], check=True)
    gaps, even = tmp_path / "dicom", tmp_path / "even.nii.gz"
    refused = kontur("convert", gaps, even)
    assert refused.returncode == 69 and "--resample-slices interpolates slices" in refused.stderr, refused
    made = kontur("convert", gaps, even, "--resample-slices")
    assert made.returncode == 0 and "3 of 9 slices are interpolated" in made.stderr, made
    labels = nibabel.load(even)
    nibabel.save(nibabel.Nifti1Image((numpy.asarray(labels.dataobj) > 100).astype(numpy.uint8), labels.affine), tmp_path / "mask.nii.gz")
    segmentation = kontur("convert", tmp_path / "mask.nii.gz", tmp_path / "mask.dcm", "--image", gaps, "--resample-slices")
    assert segmentation.returncode == 69 and "do not lie evenly" in segmentation.stderr, segmentation
    traced = kontur("trace", tmp_path / "mask.nii.gz", "--image", gaps, "--resample-slices", "-o", tmp_path / "rs.dcm")
    assert traced.returncode == 0 and "on no slice of the images" in traced.stderr, traced


def test_a_structure_set_becomes_contours(tmp_path):
    path = real_data("03_sarcoma_STS_002/CT/RTSTRUCT_RS.dcm")
    assert kontur("convert", path, tmp_path / "out.json").returncode == 0
    found = json.loads((tmp_path / "out.json").read_text())
    assert found["structure"] == "GTV_Mass_CT"
    assert sum(len(p["contours"]) for p in found["planes"]) == 16


@pytest.mark.parametrize(
    "source, target, advice",
    [
        ("contours.json", "mask.nii.gz", "kontur segment"),
        ("contours.json", "mesh.stl", "kontur segment"),
        ("mask.nii.gz", "contours.json", "kontur trace"),
        ("mask.nii.gz", "mesh.stl", "kontur trace cuts a mask into contours, of which kontur segment makes a mesh"),
        ("mesh.obj", "contours.json", "kontur makes masks of meshes"),
    ],
)
def test_what_is_no_conversion_names_the_command_that_does_it(tmp_path, source, target, advice):
    write_planes(tmp_path / "contours.json", ball_planes())
    write_nifti(tmp_path / "mask.nii.gz", ball_array())
    (tmp_path / "mesh.obj").write_text(TETRAHEDRON)
    before = names(tmp_path)
    result = kontur("convert", tmp_path / source, tmp_path / target)
    assert result.returncode == 69
    assert advice in result.stderr
    assert names(tmp_path) == before


def test_an_input_is_never_replaced(tmp_path):
    path = write_nifti(tmp_path / "mask.nii.gz", ball_array())
    content = path.read_bytes()
    result = kontur("convert", path, path)
    assert result.returncode == 65
    assert path.read_bytes() == content
    assert names(tmp_path) == ["mask.nii.gz"]


def write_box_stl(path, low, high, leave_out=0):
    """A box by 12 triangles, of which some may be left out."""
    corners = numpy.array([[(low, high)[i][0], (low, high)[j][1], (low, high)[k][2]] for k in (0, 1) for j in (0, 1) for i in (0, 1)])
    faces = [(0, 4, 6), (0, 6, 2), (0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (1, 3, 7), (1, 7, 5)]
    triangles = numpy.zeros(len(faces) - leave_out, [("normal", "<f4", 3), ("points", "<f4", (3, 3)), ("tail", "<u2")])
    triangles["points"] = corners[numpy.array(faces[leave_out:])]
    path.write_bytes(b"SPACE=LPS".ljust(80) + numpy.uint32(len(triangles)).tobytes() + triangles.tobytes())
    return path


def test_a_mesh_becomes_the_mask_of_the_voxels_within(tmp_path):
    image = write_nifti(tmp_path / "ct.nii.gz", numpy.zeros((20, 18, 16), numpy.int16), sheared_affine())
    low, high = numpy.array([-3.13, -15.34, -9.93]), numpy.array([19.27, -2.76, 8.38])
    write_box_stl(tmp_path / "box.stl", low, high)
    for name in ("mask.nii.gz", "mask.seg.nrrd"):
        succeed("convert", tmp_path / "box.stl", tmp_path / name, "--image", image)
    places = numpy.stack(numpy.meshgrid(*map(numpy.arange, (20, 18, 16)), indexing="ij"), axis=-1)
    centres = places @ sheared_affine()[:3, :3].T + sheared_affine()[:3, 3]
    inside = ((centres > low) & (centres < high)).all(axis=-1)
    assert inside.sum() > 300
    assert numpy.array_equal(read_nifti(tmp_path / "mask.nii.gz"), inside)
    same = json.loads(succeed("compare", tmp_path / "mask.seg.nrrd", tmp_path / "mask.nii.gz", "--json"))
    assert same["dice"] == 1
    [facts] = json.loads(succeed("inspect", tmp_path / "mask.seg.nrrd", "--json"))
    assert facts["labels"][0]["name"] == "box"


def test_a_surface_of_kontur_gives_its_mask_back(tmp_path):
    write_planes(tmp_path / "ball.json", ball_planes())
    image = write_nifti(tmp_path / "ct.nii.gz", ball_array())
    made = kontur("segment", tmp_path / "ball.json", "--image", image, "--use-image", "off", "-o", tmp_path / "mask.nii.gz", "--mesh", tmp_path / "ball.ply")
    assert made.returncode == 0, made
    succeed("convert", tmp_path / "ball.ply", tmp_path / "again.nii.gz", "--image", image)
    assert json.loads(succeed("compare", tmp_path / "mask.nii.gz", tmp_path / "again.nii.gz", "--json"))["dice"] > 0.999


def test_a_mesh_without_an_inside_or_a_grid_is_refused(tmp_path):
    image = write_nifti(tmp_path / "ct.nii.gz", numpy.zeros((10, 10, 10), numpy.int16))
    for name, words, said in (
        ("open.stl", {"low": (-7, -26, -14), "high": (0.5, -20, -8), "leave_out": 2}, "open.stl: the surface is not closed: "),
        ("far.stl", {"low": (200, 200, 200), "high": (209, 209, 209)}, "no voxel of"),
    ):
        write_box_stl(tmp_path / name, *map(numpy.array, (words["low"], words["high"])), words.get("leave_out", 0))
        result = kontur("convert", tmp_path / name, tmp_path / "out.nii.gz", "--image", image)
        assert result.returncode == 65 and said in result.stderr, result
    result = kontur("convert", tmp_path / "far.stl", tmp_path / "out.nii.gz")
    assert result.returncode == 65 and "name an image that has it with --image" in result.stderr, result
    write_box_stl(tmp_path / "cut.stl", numpy.array([-7.0, -26, -14]), numpy.array([99.0, -20, -8]))
    result = kontur("convert", tmp_path / "cut.stl", tmp_path / "cut.nii.gz", "--image", image)
    assert result.returncode == 0 and "reaches beyond" in result.stderr, result
    assert not (tmp_path / "out.nii.gz").exists()
