# SPDX-License-Identifier: Apache-2.0
"""kontur open: what rules make is what `kontur derive` makes of the same drawing, and survives what projects survive."""
import json
import pathlib
import signal
import subprocess
import sys

import nibabel
import numpy
import pytest

from support import KONTUR, Server, ring, running, spline_controls, write_image

SUPPORT = pathlib.Path(__file__).parent.parent / "support"


def exported(server, name, structure=None):
    query = "" if structure is None else f"?structure={structure}"
    status, _, body = server.request("GET", f"/api/export/{name}{query}")
    assert status == 200, body
    return body


def saved(folder, server, name, structure=None):
    path = folder / name
    path.write_bytes(exported(server, name, structure))
    return path


def voxels(path):
    return numpy.asarray(nibabel.load(path).dataobj)


def drawn(page, name, radius):
    """A structure of two circles that lie across each other."""
    structure = page.do("structure.add", name=name)["structure"]["id"]
    for view in ("axial", "coronal"):
        plane = page.session["views"][view]["plane"]
        page.do("contour.add", structure=structure, plane=plane, control=spline_controls(ring(plane, radius, 16)))
    return structure


def derive(folder, *words):
    subprocess.run([KONTUR, "derive", *map(str, words)], check=True, cwd=folder)


def outlines(path):
    """What a contour file says beside how it was made."""
    said = json.loads(path.read_text())
    return {key: value for key, value in said.items() if key not in ("provenance", "attributes", "color")}


@pytest.fixture(scope="module")
def image(tmp_path_factory):
    path = tmp_path_factory.mktemp("image") / "ball.nii"
    write_image(path)
    return path


def test_it_is_what_kontur_derive_makes_of_the_same_drawing(tmp_path, image):
    rules = ["PTV = CTV + 5 mm", "Ring = PTV + {3 mm, superior 6 mm} - (PTV + 1 mm)", "In = crop(PTV, body(), 2 mm)"]
    with running(tmp_path, image, "--project", tmp_path / "a.kontur") as server:
        page = server.page()
        ctv = drawn(page, "CTV", 7)
        made = [page.do("rule.set", line=rule)["structure"]["id"] for rule in rules]
        drawing = saved(tmp_path, server, "contours.json", ctv)
        (tmp_path / "ctv.json").write_bytes(drawing.read_bytes())
        taken = numpy.zeros(nibabel.load(image).shape, bool)
        for count, structure in enumerate(made, 1):
            own = voxels(saved(tmp_path, server, "mask.nii.gz", structure)) != 0
            derive(tmp_path, *rules[:count], "-i", "ctv.json", "--image", image, "--output", "all.nii.gz")
            # In a label map the first structure keeps voxels that two share.
            assert ((voxels(tmp_path / "all.nii.gz") == count) == (own & ~taken)).all() and own.any(), rules[count - 1]
            taken |= own
        lines = saved(tmp_path, server, "contours.json", made[0])
        derive(tmp_path, rules[0], "-i", "ctv.json", "--image", image, "--output", "one.json")
        assert outlines(tmp_path / "one.json") == outlines(lines)
        said = json.loads(lines.read_text())
        assert (said["description"], said["provenance"]["rule"]) == (f"derived: {rules[0]}", rules[0])
        status, _, body = server.request("GET", "/api/statistics")
        assert status == 200, body
        rows = {row["name"]: row for row in json.loads(body)["structures"]}
        assert rows["PTV"]["volume_ml"] > 2 * rows["CTV"]["volume_ml"] and rows["PTV"]["contours"] == 0
        status, _, body = server.request("GET", f"/api/compare?first={ctv}&second={made[0]}")
        assert status == 200 and 0 < json.loads(body)["dice"] < 1, body


def test_it_survives_kill_9(tmp_path, image):
    project = tmp_path / "a.kontur"
    server = Server(tmp_path, image, "--project", project)
    page = server.page()
    drawn(page, "CTV", 7)
    ptv = page.do("rule.set", line="PTV = CTV + 5 mm")["structure"]["id"]
    frozen = page.do("rule.set", line="Old = CTV + 2 mm")["structure"]["id"]
    page.do("structure.freeze", id=frozen)
    before = exported(server, "labels.nii.gz")
    server.stop(signal.SIGKILL)
    with running(tmp_path, image, "--project", project) as server:
        page = server.page()
        assert page.structures[ptv]["rule"] == "PTV = CTV + 5 mm"
        assert "rule" not in page.structures[frozen] and "mask" in page.structures[frozen]
        assert exported(server, "labels.nii.gz") == before
        page.do("undo")
        assert page.structures[frozen]["rule"] == "Old = CTV + 2 mm"
        for name in ("CTV + 2 mm", "CTV + 5 mm"):
            assert page.refused("rule.set", line=f"CTV = {name}")["kind"] == "invalid_input"


def test_an_outline_moves_with_the_line_that_a_hand_drags(tmp_path, image):
    with running(tmp_path, image, "--project", tmp_path / "a.kontur") as server:
        page = server.page()
        ctv = drawn(page, "CTV", 7)
        ptv = page.do("rule.set", line="PTV = CTV + 5 mm")["structure"]["id"]
        page.wait_for_surface(ptv)
        plane = page.session["views"]["axial"]["plane"]
        server.slice({**plane, "mm_per_pixel": 1.0}, view="axial")
        contour = next(iter(page.contours))
        for step in range(1, 4):
            page.do("contour.translate", id=contour, by=[step, 0, 0], draft=True)
        kinds = []
        while "preview" not in kinds:
            event = page.receive()
            if event["event"] == "outlines" and event["structure"] == ptv:
                kinds.append("outlines")
            if event["event"] == "surface" and event["structure"] == ptv:
                kinds.append(event["stage"])
        assert "outlines" in kinds, kinds
        page.do("draft.drop")
        assert ctv != ptv


def test_it_goes_out_as_dicom_as_kontur_derive_writes_it(tmp_path):
    pydicom = pytest.importorskip("pydicom")
    subprocess.run([sys.executable, SUPPORT / "make_dicom_series.py", "axial", tmp_path / "made"], check=True)
    series = tmp_path / "made" / "dicom"
    with running(tmp_path, series, "--project", tmp_path / "a.kontur") as server:
        page = server.page()
        ctv = drawn(page, "CTV", 2.6)
        page.do("rule.set", line="PTV = CTV + 2 mm")
        (tmp_path / "ctv.json").write_bytes(exported(server, "contours.json", ctv))
        regions = pydicom.dcmread(saved(tmp_path, server, "rtstruct.dcm"))
        segments = pydicom.dcmread(saved(tmp_path, server, "seg.dcm"))
    derive(tmp_path, "PTV = CTV + 2 mm", "-i", "ctv.json", "--image", series, "--output", "own.dcm", "--rtstruct", "own_rt.dcm")
    own_regions, own_segments = pydicom.dcmread(tmp_path / "own_rt.dcm"), pydicom.dcmread(tmp_path / "own.dcm")
    roi = {one.ROIName: one for one in regions.StructureSetROISequence}["PTV"]
    own = own_regions.StructureSetROISequence[0]
    assert (roi.ROIGenerationAlgorithm, roi.ROIDescription) == (own.ROIGenerationAlgorithm, own.ROIDescription) == ("AUTOMATIC", "derived: PTV = CTV + 2 mm")
    kinds = {one.ReferencedROINumber: one.RTROIInterpretedType for one in regions.RTROIObservationsSequence}
    assert kinds[roi.ROINumber] == "PTV"
    lines = {one.ReferencedROINumber: [item.ContourData for item in one.ContourSequence] for one in regions.ROIContourSequence}
    assert lines[roi.ROINumber] == [item.ContourData for item in own_regions.ROIContourSequence[0].ContourSequence]
    segment = {one.SegmentLabel: one for one in segments.SegmentSequence}["PTV"]
    assert (segment.SegmentAlgorithmType, segment.SegmentAlgorithmName) == ("AUTOMATIC", "kontur derive")
    assert (segment.SegmentDescription, own_segments.SegmentSequence[0].SegmentAlgorithmName) == ("derived: PTV = CTV + 2 mm", "kontur derive")
