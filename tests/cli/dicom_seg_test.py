# SPDX-License-Identifier: Apache-2.0
"""DICOM segmentations out of kontur segment and convert and back in."""
import hashlib
import json
import pathlib
import re
import subprocess
import sys

import nibabel
import numpy
import pydicom
import pytest
from support import circle, kontur, names, read_nifti, write_nifti, write_planes

SUPPORT = pathlib.Path(__file__).parent.parent / "support"


@pytest.fixture(scope="module")
def images(tmp_path_factory):
    folder = tmp_path_factory.mktemp("images") / "oblique"
    subprocess.run([sys.executable, SUPPORT / "make_dicom_series.py", "oblique", folder], check=True)
    return folder / "dicom"


@pytest.fixture
def contours(tmp_path, images):
    center = json.loads(kontur("inspect", images, "--json").stdout)[0]["origin_mm"]
    center = numpy.array(center) + [2.5, 5.5, 11.0]
    return write_planes(tmp_path / "ball.json", [circle(a, o, center=center, radius=3.5) for a in "xyz" for o in (-1.5, 0, 1.5)])


def test_segment_writes_the_mask_that_it_writes_elsewhere(tmp_path, images, contours):
    for name in ("mask.nii.gz", "mask.dcm"):
        result = kontur("segment", contours, "--image", images, "--output", tmp_path / name, "--name", "Läsion")
        assert result.returncode == 0, result
    mask = read_nifti(tmp_path / "mask.nii.gz")
    assert mask.any()
    mask.transpose(2, 1, 0).astype("u1").tofile(tmp_path / "truth.raw")
    words = [sys.executable, SUPPORT / "check_dicom_seg.py", tmp_path / "mask.dcm", images, tmp_path / "truth.raw"]
    seen = subprocess.run(words, capture_output=True, text=True)
    assert seen.returncode == 0, seen
    assert "1 Läsion SEMIAUTOMATIC kontur" in seen.stdout
    assert "kernel=screened normals=surface" in seen.stdout
    same = json.loads(kontur("compare", tmp_path / "mask.dcm", tmp_path / "mask.nii.gz", "--json").stdout)
    assert same["dice"] == 1


def test_a_label_map_keeps_its_segments_through_dicom(tmp_path, images):
    assert kontur("convert", images, tmp_path / "ct.nii.gz").returncode == 0
    labels = (numpy.random.default_rng(1).integers(0, 3, read_nifti(tmp_path / "ct.nii.gz").shape) * 3).astype("u1")
    ras = numpy.array(nibabel.load(tmp_path / "ct.nii.gz").affine)
    write_nifti(tmp_path / "labels.nii.gz", labels, numpy.diag([-1.0, -1.0, 1.0, 1.0]) @ ras)
    assert kontur("convert", tmp_path / "labels.nii.gz", tmp_path / "seg.dcm", "--image", images).returncode == 0
    assert [s.SegmentLabel for s in pydicom.dcmread(tmp_path / "seg.dcm").SegmentSequence] == ["label 3", "label 6"]
    assert kontur("convert", tmp_path / "seg.dcm", tmp_path / "again.nii.gz").returncode == 0
    assert numpy.array_equal(read_nifti(tmp_path / "again.nii.gz"), labels // 3)
    [facts] = json.loads(kontur("inspect", tmp_path / "seg.dcm", "--json").stdout)
    assert facts["kind"] == "segmentation"
    assert [(s["name"], s["voxels"]) for s in facts["segments"]] == [(f"label {n}", (labels == n).sum()) for n in (3, 6)]


def test_segments_keep_names_and_colours_between_dicom_and_3d_slicer(tmp_path, images):
    assert kontur("convert", images, tmp_path / "ct.nii.gz").returncode == 0
    labels = (numpy.random.default_rng(1).integers(0, 3, read_nifti(tmp_path / "ct.nii.gz").shape)).astype("u1")
    ras = numpy.array(nibabel.load(tmp_path / "ct.nii.gz").affine)
    write_nifti(tmp_path / "labels.nii.gz", labels, numpy.diag([-1.0, -1.0, 1.0, 1.0]) @ ras)
    assert kontur("convert", tmp_path / "labels.nii.gz", tmp_path / "a.seg.nrrd").returncode == 0
    content = (tmp_path / "a.seg.nrrd").read_bytes()
    colors = re.findall(rb"Segment\d_Color:=(.*)", content)
    for number, name in ((1, "Läsion"), (2, "Leber rechts")):
        content = content.replace(f"Name:=label {number}\n".encode(), f"Name:={name}\n".encode())
    terms = b"TerminologyEntry:Some list~SCT^123037004^Anatomical Structure~SCT^10200004^Leber~^^~Other list~^^~^^|"
    content = content.replace(b"Segment1_Tags:=\n", b"Segment1_Tags:=Segmentation.Status:inprogress|" + terms + b"\n")
    (tmp_path / "a.seg.nrrd").write_bytes(content)
    assert kontur("convert", tmp_path / "a.seg.nrrd", tmp_path / "same.seg.nrrd").returncode == 0
    assert b"Segment1_Tags:=Segmentation.Status:inprogress|" + terms + b"\n" in (tmp_path / "same.seg.nrrd").read_bytes()
    assert kontur("convert", tmp_path / "a.seg.nrrd", tmp_path / "seg.dcm", "--image", images).returncode == 0
    code = pydicom.dcmread(tmp_path / "seg.dcm").SegmentSequence[1].SegmentedPropertyTypeCodeSequence[0]
    assert (code.CodeValue, code.CodingSchemeDesignator, code.CodeMeaning) == ("10200004", "SCT", "Leber")
    assert kontur("convert", tmp_path / "seg.dcm", tmp_path / "b.seg.nrrd").returncode == 0
    again = (tmp_path / "b.seg.nrrd").read_bytes()
    assert [n.decode() for n in re.findall(rb"Segment\d_Name:=(.*)", again)] == ["Läsion", "Leber rechts"]
    assert b"~SCT^123037004^Anatomical Structure~SCT^10200004^Leber~" in again
    for before, after in zip(colors, re.findall(rb"Segment\d_Color:=(.*)", again)):
        assert numpy.allclose([float(x) for x in before.split()], [float(x) for x in after.split()], atol=0.01)  # by way of CIELab


def test_a_converted_segmentation_says_so(tmp_path, images, contours):
    assert kontur("segment", contours, "--image", images, "--output", tmp_path / "mask.nii.gz").returncode == 0
    assert kontur("convert", tmp_path / "mask.nii.gz", tmp_path / "seg.dcm", "--image", images).returncode == 0
    [equipment] = pydicom.dcmread(tmp_path / "seg.dcm").ContributingEquipmentSequence
    assert equipment.PurposeOfReferenceCodeSequence[0].CodeMeaning == "Modifying Equipment"
    digest = hashlib.sha256((tmp_path / "mask.nii.gz").read_bytes()).hexdigest()
    assert f"made_by: kontur convert; source_sha256: {digest}" in equipment.ContributionDescription
    assert kontur("convert", tmp_path / "seg.dcm", tmp_path / "again.nii.gz").returncode == 0
    mask, seg, again = (json.loads(kontur("inspect", tmp_path / name, "--json").stdout)[0]["provenance"]
                        for name in ("mask.nii.gz", "seg.dcm", "again.nii.gz"))
    for name, value in mask.items():
        assert seg[f"source_{name}"] == again[f"source_source_{name}"] == value
    assert "Error" not in subprocess.run(["dciodvfy", tmp_path / "seg.dcm"], capture_output=True, text=True).stderr


@pytest.fixture
def overlapping(tmp_path, images):
    """Two masks on the images that share voxels, as files, and their arrays."""
    assert kontur("convert", images, tmp_path / "ct.nii.gz").returncode == 0
    ras = numpy.array(nibabel.load(tmp_path / "ct.nii.gz").affine)
    draws = numpy.random.default_rng(2).random((2, *read_nifti(tmp_path / "ct.nii.gz").shape)) < 0.4
    for name, array in zip(("liver", "tumour"), draws.astype("u1")):
        write_nifti(tmp_path / f"{name}.nii.gz", array, numpy.diag([-1.0, -1.0, 1.0, 1.0]) @ ras)
    assert draws.all(axis=0).any()
    return draws


def segments_by_pydicom(path, images):
    """The arrays of all segments of a file in which dciodvfy finds no error, as nibabel orders them, by name."""
    seg = pydicom.dcmread(path)
    assert "Error" not in subprocess.run(["dciodvfy", path], capture_output=True, text=True).stderr
    slices = [pydicom.dcmread(file) for file in images.glob("*.dcm")]
    normal = numpy.cross(slices[0].ImageOrientationPatient[:3], slices[0].ImageOrientationPatient[3:])
    order = [s.SOPInstanceUID for s in sorted(slices, key=lambda s: normal @ numpy.array(s.ImagePositionPatient, float))]
    found = {s.SegmentLabel: numpy.zeros((len(order), seg.Rows, seg.Columns), bool) for s in seg.SegmentSequence}
    names = {s.SegmentNumber: s.SegmentLabel for s in seg.SegmentSequence}
    for frame, pixels in zip(seg.PerFrameFunctionalGroupsSequence, seg.pixel_array):
        source = frame.DerivationImageSequence[0].SourceImageSequence[0].ReferencedSOPInstanceUID
        name = names[frame.SegmentIdentificationSequence[0].ReferencedSegmentNumber]
        found[name][order.index(source)] |= pixels != 0
    return seg.SegmentsOverlap, {name: array.transpose(2, 1, 0) for name, array in found.items()}


def check_overlapping(path, images, arrays):
    overlap, found = segments_by_pydicom(path, images)
    assert overlap == "YES" and list(found) == ["liver", "tumour"]
    for array, seen in zip(arrays, found.values()):
        assert numpy.array_equal(seen, array)


def test_overlapping_masks_become_segments_and_come_back_whole(tmp_path, images, overlapping):
    words = ["--add", tmp_path / "tumour.nii.gz", "--image", images]
    assert kontur("convert", tmp_path / "liver.nii.gz", tmp_path / "seg.dcm", *words).returncode == 0
    check_overlapping(tmp_path / "seg.dcm", images, overlapping)
    result = kontur("convert", tmp_path / "seg.dcm", tmp_path / "again.dcm", "--image", images)
    assert result.returncode == 0 and "segments overlap: " in result.stderr
    check_overlapping(tmp_path / "again.dcm", images, overlapping)
    for number, array in enumerate(overlapping, start=1):
        assert kontur("convert", tmp_path / "again.dcm", tmp_path / "one.nii.gz", "--label", number).returncode == 0
        assert numpy.array_equal(read_nifti(tmp_path / "one.nii.gz"), array * number)


def test_a_label_map_of_overlapping_segments_is_refused_by_name(tmp_path, images, overlapping):
    words = ["--add", tmp_path / "tumour.nii.gz", "--image", images]
    assert kontur("convert", tmp_path / "liver.nii.gz", tmp_path / "seg.dcm", *words).returncode == 0
    result = kontur("convert", tmp_path / "seg.dcm", tmp_path / "labels.nii.gz")
    assert result.returncode == 65
    assert "the segments 1 'liver' and 2 'tumour' overlap; choose one with --label" in result.stderr
    [facts] = json.loads(kontur("inspect", tmp_path / "seg.dcm", "--json").stdout)
    shared = int(overlapping.all(axis=0).sum())
    assert [s["shared_voxels"] for s in facts["segments"]] == [shared, shared]
    assert f"{shared} of {int(overlapping[0].sum())} voxels of 1 'liver'" in facts["notes"][0]


def test_layers_of_3d_slicer_become_overlapping_segments(tmp_path, images, overlapping):
    """3D Slicer stores segments that overlap in layers of one file, each of them with the value 1 here."""
    assert kontur("convert", tmp_path / "liver.nii.gz", tmp_path / "one.nrrd").returncode == 0
    fields = dict(line.split(": ") for line in (tmp_path / "one.nrrd").read_bytes().split(b"\n\n")[0].decode().splitlines() if ": " in line)
    header = ["NRRD0004", "type: unsigned char", "dimension: 4", "space: left-posterior-superior", "sizes: 2 " + fields["sizes"],
              "space directions: none " + fields["space directions"], "kinds: list domain domain domain", "encoding: raw",
              "space origin: " + fields["space origin"]]
    for number, name in enumerate(("liver", "tumour", "nothing")):
        header += [f"Segment{number}_{key}:={value}" for key, value in
                   (("ID", f"S{number}"), ("Name", name), ("Color", "1 0 0"), ("LabelValue", number // 2 + 1), ("Layer", number % 2))]
    voxels = overlapping.astype("u1").transpose(3, 2, 1, 0).tobytes()
    (tmp_path / "both.seg.nrrd").write_bytes("\n".join(header).encode() + b"\n\n" + voxels)
    result = kontur("convert", tmp_path / "both.seg.nrrd", tmp_path / "seg.dcm", "--image", images)
    assert result.returncode == 0 and "the segment 'nothing' has no voxels and is left out" in result.stderr
    check_overlapping(tmp_path / "seg.dcm", images, overlapping)
    words = ["--frame", 2, "--image", images]
    assert kontur("convert", tmp_path / "both.seg.nrrd", tmp_path / "second.dcm", *words).returncode == 0
    overlap, found = segments_by_pydicom(tmp_path / "second.dcm", images)
    assert overlap == "NO" and list(found) == ["tumour"] and numpy.array_equal(found["tumour"], overlapping[1])


def test_masks_become_layers_that_are_told_converted_and_found_by_label(tmp_path, overlapping):
    layers = tmp_path / "both.seg.nrrd"
    assert kontur("convert", tmp_path / "liver.nii.gz", layers, "--add", tmp_path / "tumour.nii.gz").returncode == 0
    [facts] = json.loads(kontur("inspect", layers, "--json").stdout)
    shared = int(overlapping.all(axis=0).sum())
    assert facts["kind"] == "segmentation" and [s["name"] for s in facts["segments"]] == ["liver", "tumour"]
    assert [(s["voxels"], s["shared_voxels"]) for s in facts["segments"]] == [(int(array.sum()), shared) for array in overlapping]
    layers.write_bytes(layers.read_bytes().replace(b"Segment1_Tags:=", b"Segment1_Tags:=Segmentation.Status:done|", 1))
    assert kontur("convert", layers, tmp_path / "again.seg.nrrd").returncode == 0
    assert b"Segment1_Tags:=Segmentation.Status:done|" in (tmp_path / "again.seg.nrrd").read_bytes()
    refused = kontur("convert", layers, tmp_path / "labels.nii.gz")
    assert refused.returncode == 65 and "both.seg.nrrd overlap, and" in refused.stderr and "--label" in refused.stderr, refused
    for number, array in enumerate(overlapping, start=1):
        assert kontur("convert", layers, tmp_path / "one.nii.gz", "--label", number).returncode == 0
        assert numpy.array_equal(read_nifti(tmp_path / "one.nii.gz"), array * number)
        same = json.loads(kontur("compare", layers, tmp_path / "one.nii.gz", "--label", number, "--json").stdout)
        assert same["dice"] == 1


@pytest.mark.parametrize("words, why", [
    (["liver.nii.gz", "out.nii.gz", "--add", "tumour.nii.gz"], "--add is for segments of a DICOM SEG"),
    (["liver.nii.gz", "out.dcm", "--add", "tumour.nii.gz", "--label", "1"], "--label cannot choose where --add"),
    (["liver.nii.gz", "out.nii.gz", "--label", "7"], "has no label 7"),
    (["ball.json", "out.json", "--label", "1"], "--label chooses from a label map"),
])
def test_options_that_do_not_fit_are_refused(tmp_path, images, contours, overlapping, words, why):
    before = names(tmp_path)
    image = ["--image", images] if "out.dcm" in words else []
    result = kontur("convert", *words, *image, cwd=tmp_path)
    assert result.returncode == 65 and why in result.stderr
    assert names(tmp_path) == before


def test_what_is_no_label_map_of_the_images_is_refused(tmp_path, images):
    before = names(tmp_path)
    result = kontur("convert", images, tmp_path / "seg.dcm", "--image", images)
    assert result.returncode == 65 and "this looks like an image, not like a label map" in result.stderr
    assert names(tmp_path) == before
