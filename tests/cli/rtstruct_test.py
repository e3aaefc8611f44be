# SPDX-License-Identifier: Apache-2.0
"""RT structure sets out of kontur segment, trace and convert, as pydicom and dciodvfy see them."""
import hashlib
import json
import math
import pathlib
import subprocess
import sys

import numpy
import pydicom
import pytest
from support import ball_array, circle, kontur, names, read_nifti, real_data, write_nifti, write_planes

SUPPORT = pathlib.Path(__file__).parent.parent / "support"
CENTER = (-15.0, -25.0, 110.0)  # within the images
RADIUS = 3.5


@pytest.fixture(scope="module")
def images(tmp_path_factory):
    """A DICOM series of 9 axial slices, 2.5 mm apart."""
    folder = tmp_path_factory.mktemp("images") / "axial"
    subprocess.run([sys.executable, SUPPORT / "make_dicom_series.py", "axial", folder], check=True)
    return folder / "dicom"


def ball_contours(path):
    return write_planes(path, [circle(axis, offset, center=CENTER, radius=RADIUS) for axis in "xyz" for offset in (-1.5, 0, 1.5)])


def checked(path, images):
    """The ROI lines and the contour lines of a file in which pydicom and dciodvfy find no fault."""
    words = [sys.executable, SUPPORT / "check_rtstruct.py", path, images]
    result = subprocess.run(words, capture_output=True, text=True)
    assert result.returncode == 0, result
    lines = [line.split() for line in result.stdout.splitlines()]
    return [line for line in lines if not line[0].startswith("CLOSED")], [line for line in lines if line[0].startswith("CLOSED")]


def disc_area(z):
    return math.pi * max(0, RADIUS**2 - (z - CENTER[2]) ** 2)


def test_what_the_reader_says_of_contours_the_fit_does_not_say_again(tmp_path, images):
    planes = [circle("z", offset, center=CENTER, radius=RADIUS) for offset in (-2.5, 0, 2.5)]
    for plane, other in zip(planes, [circle("z", offset, center=CENTER, radius=RADIUS) for offset in (-2.5, 0, 2.5)]):
        plane["contours"].append({**other["contours"][0], "points": [[x + 2, y, z] for x, y, z in other["contours"][0]["points"]]})
    write_planes(tmp_path / "two.json", planes)
    assert (made := kontur("convert", tmp_path / "two.json", tmp_path / "two.dcm", "--image", images)).returncode == 0, made
    for words in (["--all-rois"], []):
        result = kontur("segment", tmp_path / "two.dcm", *words, "--image", images, "-o", tmp_path / "mask.nii.gz", "--use-image", "off")
        assert result.returncode == 0, result
        assert result.stderr.count("overlap in part (and 2 more such pairs)") == 1, result.stderr


def test_segment_cuts_the_surface_on_the_images_slices(tmp_path, images):
    contours = ball_contours(tmp_path / "ball.json")
    words = ["--image", images, "--output", tmp_path / "mask.nii.gz", "--rtstruct", tmp_path / "rs.dcm", "--name", "Läsion"]
    result = kontur("segment", contours, *words)
    assert result.returncode == 0, result
    assert "rs.dcm" in result.stdout
    [roi], found = checked(tmp_path / "rs.dcm", images)
    assert roi[1] == "Läsion" and roi[3] == "SEMIAUTOMATIC"
    [equipment] = pydicom.dcmread(tmp_path / "rs.dcm").ContributingEquipmentSequence
    digest = hashlib.sha256(contours.read_bytes()).hexdigest()
    assert f"contour_files_sha256: {digest}" in equipment.ContributionDescription
    assert kontur("convert", tmp_path / "rs.dcm", tmp_path / "again.json").returncode == 0
    assert json.loads((tmp_path / "again.json").read_text())["provenance"]["source_contour_files_sha256"] == digest
    areas = {float(line[3]): float(line[2]) for line in found}
    assert sorted(areas) == [107.5, 110.0, 112.5]
    for z, area in areas.items():
        # The chords of a coarse lattice cut off some of each disc, the surface itself is exact to 0.1 mm.
        assert area == pytest.approx(disc_area(z), rel=0.08)
    mask = read_nifti(tmp_path / "mask.nii.gz")
    assert [k for k in range(9) if mask[:, :, k].any()] == [3, 4, 5]


def test_trace_cuts_a_mask_on_the_images_slices(tmp_path, images):
    kontur("segment", ball_contours(tmp_path / "ball.json"), "--image", images, "--output", tmp_path / "mask.nii.gz")
    words = ["--image", images, "--output", tmp_path / "rs.dcm", "--name", "ball"]
    assert kontur("trace", tmp_path / "mask.nii.gz", *words).returncode == 0
    [roi], found = checked(tmp_path / "rs.dcm", images)
    assert roi[1] == "ball"
    assert [float(line[3]) for line in found] == [107.5, 110.0, 112.5]


def test_an_images_slices_also_cut_into_a_contour_file(tmp_path):
    mask = write_nifti(tmp_path / "mask.nii.gz", ball_array())
    assert kontur("trace", mask, "--image", mask, "--output", tmp_path / "out.json").returncode == 0
    planes = json.loads((tmp_path / "out.json").read_text())["planes"]
    assert [p["origin"][2] for p in planes] == [float(z) for z in range(-4, 15)]
    assert kontur("trace", mask, "--output", tmp_path / "own.json").returncode == 0  # the mask's own slices
    own = json.loads((tmp_path / "own.json").read_text())["planes"]
    assert [p["contours"] for p in own if p["contours"]] == [p["contours"] for p in planes]


def test_a_structure_set_survives_the_way_through_kontur(tmp_path):
    folder = real_data("04_sarcoma_STS_040/CT")
    first = folder / "RTSTRUCT_RS.dcm"
    assert kontur("convert", first, tmp_path / "rs.dcm", "--image", folder / "image").returncode == 0
    for source, target in [(first, "before.json"), (tmp_path / "rs.dcm", "after.json")]:
        assert kontur("convert", source, tmp_path / target).returncode == 0
    before, after = (json.loads((tmp_path / name).read_text()) for name in ("before.json", "after.json"))
    assert before["structure"] == after["structure"] == "GTV_Mass_CT"
    points = [
        sorted((tuple(p) for plane in found["planes"] for c in plane["contours"] for p in c["points"]))
        for found in (before, after)
    ]
    assert len(points[0]) == 25540
    assert numpy.abs(numpy.array(points[0]) - numpy.array(points[1])).max() < 1e-4


SAID = {
    "number": 17,
    "interpreted_type": "GTV",
    "color": [10, 200, 255],
    "description": "seen in \"MR\"\nsecond line, ä",
    "generation_algorithm": "MANUAL",
    "code": {"value": "4147007", "scheme": "SCT", "meaning": "Mass"},
    "physical_properties": [{"property": "REL_ELEC_DENSITY", "value": 1.25}],
}


def said_in(path):
    """What a contour file says of its structure beside its name."""
    document = json.loads(path.read_text())
    return {key: value for key, value in document.items() if key not in ("version", "frame", "structure", "planes", "provenance")}


def seen_by_a_planner(path):
    """The same of the first ROI of a structure set, as pydicom reads it."""
    structures = pydicom.dcmread(path)
    entry, roi, about = structures.StructureSetROISequence[0], structures.ROIContourSequence[0], structures.RTROIObservationsSequence[0]
    [code], [density] = about.RTROIIdentificationCodeSequence, about.ROIPhysicalPropertiesSequence
    return {
        "number": entry.ROINumber,
        "interpreted_type": about.RTROIInterpretedType,
        "color": list(roi.ROIDisplayColor),
        "description": entry.ROIDescription.replace("\r\n", "\n"),
        "generation_algorithm": entry.ROIGenerationAlgorithm,
        "code": {"value": code.CodeValue, "scheme": code.CodingSchemeDesignator, "meaning": code.CodeMeaning},
        "physical_properties": [{"property": density.ROIPhysicalProperty, "value": density.ROIPhysicalPropertyValue}],
    }


@pytest.fixture
def said(tmp_path):
    """A ball's contours of which much is said."""
    document = json.loads(ball_contours(tmp_path / "ball.json").read_text())
    document["planes"] = document["planes"][-3:]  # on slices
    (tmp_path / "said.json").write_text(json.dumps(document | SAID))
    return tmp_path / "said.json"


def test_what_is_said_of_a_structure_survives_the_way_to_rtstruct_and_back(tmp_path, images, said):
    assert kontur("convert", said, tmp_path / "rs.dcm", "--image", images).returncode == 0
    assert seen_by_a_planner(tmp_path / "rs.dcm") == SAID
    checked(tmp_path / "rs.dcm", images)
    assert kontur("convert", tmp_path / "rs.dcm", tmp_path / "again.json").returncode == 0
    assert said_in(tmp_path / "again.json") == SAID
    assert kontur("convert", tmp_path / "rs.dcm", tmp_path / "rs2.dcm", "--image", images).returncode == 0
    assert seen_by_a_planner(tmp_path / "rs2.dcm") == SAID


def test_what_segment_makes_says_the_same_and_that_kontur_made_it(tmp_path, images, said):
    words = ["--image", images, "--rtstruct", tmp_path / "rs.dcm", "--output"]
    assert kontur("segment", said, *words, tmp_path / "seg.dcm").returncode == 0
    made = SAID | {"generation_algorithm": "SEMIAUTOMATIC"}
    assert seen_by_a_planner(tmp_path / "rs.dcm") == made
    [segment] = pydicom.dcmread(tmp_path / "seg.dcm").SegmentSequence
    assert segment.SegmentedPropertyTypeCodeSequence[0].CodeMeaning == "Mass"
    assert segment.SegmentDescription.replace("\r\n", "\n") == SAID["description"]
    rs = tmp_path / "rs.dcm"
    assert kontur("segment", rs, "--all-rois", "--image", images, "-o", tmp_path / "m.nii.gz", "--rtstruct", tmp_path / "all.dcm").returncode == 0
    assert seen_by_a_planner(tmp_path / "all.dcm") == made
    # Through SEG and .seg.nrrd, which have room for less.
    assert kontur("trace", tmp_path / "seg.dcm", "--image", images, "-o", tmp_path / "traced.json").returncode == 0
    kept = {key: made[key] for key in ("color", "description", "generation_algorithm", "code")}
    traced = said_in(tmp_path / "traced.json")
    assert traced.pop("category")["meaning"] == "Tissue"
    assert numpy.abs(numpy.array(traced.pop("color")) - kept.pop("color")).max() <= 1, "CIELab rounds"
    assert traced == kept
    assert json.loads((tmp_path / "traced.json").read_text())["structure"] == "ball"
    assert kontur("segment", said, "--image", images, "-o", tmp_path / "m.seg.nrrd").returncode == 0
    assert kontur("trace", tmp_path / "m.seg.nrrd", "--image", images, "-o", tmp_path / "traced.json").returncode == 0
    traced = said_in(tmp_path / "traced.json")
    assert traced.pop("category")["meaning"] == "Tissue" and traced.pop("code") == made["code"]
    assert traced == {"color": SAID["color"], "generation_algorithm": "SEMIAUTOMATIC"}
    assert kontur("convert", said, tmp_path / "ball.mrk.json").returncode == 0
    assert kontur("convert", tmp_path / "ball.mrk.json", tmp_path / "again.json").returncode == 0
    assert said_in(tmp_path / "again.json") == {"color": SAID["color"]}


def test_convert_keeps_an_approval_and_a_new_fit_has_none(tmp_path, images):
    contours = write_planes(tmp_path / "ball.json", [circle("z", offset, center=CENTER, radius=RADIUS) for offset in (-2.5, 0, 2.5)])
    review = {"approved": {"by": "Doe^Jane", "at": "2026-11-30T21:02:43"}, "comment": "to the rim", "locked": True}
    pathlib.Path(contours).write_text(json.dumps({**json.loads(pathlib.Path(contours).read_text()), "review": review}))
    assert (made := kontur("convert", contours, tmp_path / "rs.dcm", "--image", images)).returncode == 0, made
    lines, _ = checked(tmp_path / "rs.dcm", images)
    assert lines[0] == ["APPROVED", "by", "Doe^Jane", "on", "20261130", "at", "210243"]
    [[roi]] = [one["rois"] for one in json.loads(kontur("inspect", tmp_path / "rs.dcm", "--json").stdout)]
    assert (roi["approved"], roi["comment"]) == (review["approved"], review["comment"])
    assert (made := kontur("convert", tmp_path / "rs.dcm", tmp_path / "back.json")).returncode == 0, made
    assert json.loads((tmp_path / "back.json").read_text())["review"] == {key: review[key] for key in ("approved", "comment")}
    assert (made := kontur("segment", contours, "--image", images, "--output", tmp_path / "m.nii.gz", "--rtstruct", tmp_path / "fit.dcm")).returncode == 0, made
    assert pydicom.dcmread(tmp_path / "fit.dcm").ApprovalStatus == "UNAPPROVED"


def test_a_real_structure_set_keeps_what_it_says(tmp_path):
    folder = real_data("09_rtstruct_breast_dicompyler")
    before = pydicom.dcmread(folder / "rtss.dcm")

    def rois(structures):
        observations = {o.ReferencedROINumber: o for o in structures.RTROIObservationsSequence}
        colors = {r.ReferencedROINumber: r.get("ROIDisplayColor") for r in structures.ROIContourSequence if "ContourSequence" in r}
        return {
            s.ROINumber: (s.ROIName, s.ROIGenerationAlgorithm, colors[s.ROINumber], observations[s.ROINumber].RTROIInterpretedType,
                          [c.CodeValue for c in observations[s.ROINumber].get("RTROIIdentificationCodeSequence", [])])
            for s in structures.StructureSetROISequence if s.ROINumber in colors
        }

    for number, said in rois(before).items():
        words = ["--roi", number]
        assert kontur("convert", folder / "rtss.dcm", tmp_path / "one.json", *words).returncode == 0
        assert kontur("convert", tmp_path / "one.json", tmp_path / "one.dcm", "--image", folder / "ct.0.dcm").returncode == 0
        assert rois(pydicom.dcmread(tmp_path / "one.dcm")) == {number: said}


@pytest.mark.parametrize("encoding, kind", [("keyhole", "CLOSED_PLANAR"), ("xor", "CLOSEDPLANAR_XOR"), ("nested", "CLOSED_PLANAR")])
def test_holes_are_stored_as_asked(tmp_path, images, encoding, kind):
    plane = circle("z", 0, center=CENTER, radius=RADIUS)
    plane["contours"] += circle("z", 0, center=CENTER, radius=1)["contours"]
    contours = write_planes(tmp_path / "ring.json", [plane])
    words = ["convert", contours, tmp_path / "rs.dcm", "--image", images, "--holes", encoding]
    assert kontur(*words).returncode == 0
    assert kontur("convert", tmp_path / "rs.dcm", tmp_path / "again.json").returncode == 0
    [again] = json.loads((tmp_path / "again.json").read_text())["planes"]
    assert sorted((c["hole"], len(c["points"])) for c in again["contours"]) == [(False, 40), (True, 40)]
    assert kind.encode() in (tmp_path / "rs.dcm").read_bytes()


def test_dicom_output_without_dicom_images_is_refused_before_any_work(tmp_path):
    contours = ball_contours(tmp_path / "ball.json")
    image = write_nifti(tmp_path / "image.nii.gz", ball_array())
    before = names(tmp_path)
    for words in [
        ["convert", contours, tmp_path / "rs.dcm"],
        ["convert", contours, tmp_path / "rs.dcm", "--image", image],
        ["segment", contours, "--image", image, "--output", tmp_path / "m.nii.gz", "--rtstruct", tmp_path / "rs.dcm"],
        ["trace", image, "--planes", contours, "--output", tmp_path / "rs.dcm"],
    ]:
        result = kontur(*words)
        assert result.returncode == 65
        assert "DICOM" in result.stderr
        assert names(tmp_path) == before


def test_another_frame_of_reference_than_the_images_is_told(tmp_path, images):
    kontur("segment", ball_contours(tmp_path / "ball.json"), "--image", images, "--output", tmp_path / "seg.dcm", "--rtstruct", tmp_path / "rs.dcm")
    [own] = {str(pydicom.dcmread(path).FrameOfReferenceUID) for path in images.iterdir()}
    commands = {
        "rs.dcm": [["segment", "rs.dcm", "--output", "m.nii.gz"], ["convert", "rs.dcm", "again.dcm"]],
        "seg.dcm": [["trace", "seg.dcm", "--output", "t.dcm"], ["trace", "seg.dcm", "--output", "t.json"], ["convert", "seg.dcm", "again.dcm"]],
    }
    for name, of_file in commands.items():
        for uid in (own, "1.2.3.4"):
            file = pydicom.dcmread(tmp_path / name)
            file.FrameOfReferenceUID = uid
            for roi in file.get("StructureSetROISequence", []):
                roi.ReferencedFrameOfReferenceUID = uid
            file.save_as(tmp_path / name)
            for words in of_file:
                result = kontur(*words, "--image", images, cwd=tmp_path)
                assert result.returncode == 0, result
                told = f"lies in the frame of reference 1.2.3.4, the images in {own}; it may not fit them\n" in result.stderr
                assert told == (uid != own), (words, result)
    file = pydicom.dcmread(tmp_path / "rs.dcm")
    file.FrameOfReferenceUID = own
    for roi in file.StructureSetROISequence:
        roi.ReferencedFrameOfReferenceUID = own
    file.save_as(tmp_path / "own.dcm")
    result = kontur("segment", "rs.dcm", "own.dcm", "--image", images, "--output", "m.nii.gz", cwd=tmp_path)
    assert result.returncode == 65, result
    assert f"own.dcm: its contours lie in the frame of reference {own}, those before in 1.2.3.4; " in result.stderr


@pytest.mark.parametrize(
    "declared, name, written",
    [
        (["", "ISO 2022 IR 87"], "Yamada^Tarou=山田^太郎=やまだ^たろう", "Yamada^Tarou=山田^太郎=やまだ^たろう"),
        (["ISO 2022 IR 13", "ISO 2022 IR 87"], "ﾔﾏﾀﾞ^ﾀﾛｳ=山田^太郎=やまだ^たろう", "ﾔﾏﾀﾞ^ﾀﾛｳ=山田^太郎=やまだ^たろう"),
        (["", "ISO 2022 IR 149"], "Hong^Gildong=洪^吉洞=홍^길동", "Hong^Gildong=洪^吉洞=홍^길동"),
        ("GB18030", "王^小东", "王^小东"),
        (None, b"M\xfcller^J", "Müller^J"),
    ],
)
def test_the_patients_name_is_written_as_the_images_have_it(tmp_path, images, declared, name, written):
    (tmp_path / "images").mkdir()
    for path in images.iterdir():
        image = pydicom.dcmread(path)
        image.PatientName = name
        if declared:
            image.SpecificCharacterSet = declared
        image.save_as(tmp_path / "images" / path.name)
    contours = ball_contours(tmp_path / "ball.json")
    assert kontur("convert", contours, tmp_path / "rs.dcm", "--image", tmp_path / "images").returncode == 0
    assert str(pydicom.dcmread(tmp_path / "rs.dcm").PatientName) == written
