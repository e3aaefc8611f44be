# SPDX-License-Identifier: Apache-2.0
"""kontur open: structure sets and segmentations that lie near a DICOM image, or are opened themselves."""
import json
import pathlib
import shutil
import signal
import subprocess
import sys
import urllib.parse

import pytest

from support import KONTUR, at_offset, ring, running, spline_controls

pytest.importorskip("pydicom")
SUPPORT = pathlib.Path(__file__).parent.parent / "support"


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """A CT in a folder of its own, a structure set of two regions beside that, a segmentation among the slices."""
    folder = tmp_path_factory.mktemp("patient") / "study"
    subprocess.run([sys.executable, SUPPORT / "make_dicom_series.py", "axial", folder / "made"], check=True)
    shutil.move(folder / "made" / "dicom", folder / "ct")
    shutil.rmtree(folder / "made")
    (folder / "plan").mkdir()
    with running(folder.parent, folder / "ct", "--project", folder.parent / "drawn.kontur") as server:
        page = server.page()
        plane = page.session["views"]["axial"]["plane"]
        first = next(iter(page.structures))
        page.do("structure.set", id=first, name="Node", color="#112233")
        second = page.do("structure.add", name="Rest")["structure"]["id"]
        for structure, at in ((first, -2.5), (second, 2.5)):
            for step in (-2.5, 0, 2.5):
                slice_plane = at_offset(plane, 2 * at + step)
                control = spline_controls(ring(slice_plane, 2.6 - 0.1 * abs(step)))
                page.do("contour.add", structure=structure, plane=slice_plane, control=control)
        for name, path in (("rtstruct.dcm", folder / "plan" / "RS.dcm"), ("seg.dcm", folder / "ct" / "seg.dcm")):
            status, _, body = server.request("GET", f"/api/export/{name}")
            assert status == 200, body
            path.write_bytes(body)
    subprocess.run([sys.executable, SUPPORT / "make_rtstruct.py", "good", folder / "plan" / "others.dcm"], check=True)
    return folder


def near(server):
    status, _, body = server.request("GET", "/api/drawings")
    assert status == 200, body
    return json.loads(body)["drawings"]


def import_near(server, file, more=""):
    status, _, body = server.request("POST", f"/api/import/near?file={urllib.parse.quote(str(file))}{more}", b"")
    return status, json.loads(body)


def test_what_was_drawn_on_the_series_is_told_and_nothing_else(tmp_path, study):
    with running(tmp_path, study / "ct", "--project", tmp_path / "a.kontur") as server:
        found = near(server)
        assert [(one["name"], one["modality"], one["structures"], one["own_series"]) for one in found] == [
            ("seg.dcm", "SEG", ["Node", "Rest"], True),
            ("RS.dcm", "RTSTRUCT", ["Node", "Rest"], True),
        ], "the one that was drawn on other images is not among them"


def test_one_click_imports_all_regions_in_place_of_the_structure_that_waits_to_be_drawn(tmp_path, study):
    with running(tmp_path, study / "ct", "--project", tmp_path / "a.kontur") as server:
        page = server.page()
        (waiting,) = page.structures.values()
        status, reply = import_near(server, study / "plan" / "RS.dcm")
        assert status == 200 and reply["doubts"] == [] and len(reply["structures"]) == 2, reply
        page.do("ping")
        assert [(one["name"], one["color"]) for one in page.structures.values()] == [("Node", "#112233"), ("Rest", page.structures[reply["structures"][1]]["color"])]
        assert len(page.contours) == 6
        assert page.do("undo")["label"] == "Import contours"
        assert list(page.structures.values()) == [waiting] and not page.contours


def test_a_structure_that_was_named_stays(tmp_path, study):
    with running(tmp_path, study / "ct", "--project", tmp_path / "a.kontur") as server:
        page = server.page()
        page.do("structure.set", id=next(iter(page.structures)), name="Mine")
        assert import_near(server, study / "plan" / "RS.dcm")[0] == 200
        page.do("ping")
        assert [one["name"] for one in page.structures.values()] == ["Mine", "Node", "Rest"]


def test_segments_bring_their_colours_and_codes(tmp_path, study):
    with running(tmp_path, study / "ct", "--project", tmp_path / "a.kontur") as server:
        page = server.page()
        status, reply = import_near(server, study / "ct" / "seg.dcm")
        assert status == 200 and len(reply["structures"]) == 2, reply
        page.do("ping")
        node = page.structures[reply["structures"][0]]
        levels = [int(node["color"][at : at + 2], 16) for at in (1, 3, 5)]
        assert max(abs(a - b) for a, b in zip(levels, (0x11, 0x22, 0x33))) <= 2, "CIELab in the file, of 16 bits"
        assert node["attributes"]["generation_algorithm"] == "SEMIAUTOMATIC"
        assert node["attributes"]["code"]["meaning"] == "Tissue"


def test_segments_are_cut_on_as_many_planes_as_asked_for(tmp_path, study):
    with running(tmp_path, study / "ct", "--project", tmp_path / "a.kontur") as server:
        page = server.page()
        assert import_near(server, study / "ct" / "seg.dcm", "&planes=2&axes=axial")[0] == 200
        body = (study / "ct" / "seg.dcm").read_bytes()
        assert server.request("POST", "/api/import/contours?name=seg.dcm&planes=1&axes=axial", body)[0] == 200
        page.do("ping")
        drawn = [sum(contour["structure"] == one for contour in page.contours.values()) for one in page.structures]
        assert drawn == [2, 2, 1, 1] and all(abs(contour["plane"]["normal"][2]) == 1 for contour in page.contours.values())


def test_segments_that_overlap_leave_and_come_back_on_layers(tmp_path, study):
    with running(tmp_path, study / "ct", "--project", tmp_path / "a.kontur") as server:
        page = server.page()
        page.do("borders.set", shared=False)
        first = next(iter(page.structures))
        page.do("structure.set", id=first, name="Node")
        for structure, radius in ((first, 2.6), (page.do("structure.add", name="Rest")["structure"]["id"], 1.8)):
            for step in (-2.5, 0, 2.5):
                plane = at_offset(page.session["views"]["axial"]["plane"], step)
                page.do("contour.add", structure=structure, plane=plane, control=spline_controls(ring(plane, radius)))
        status, _, segmentation = server.request("GET", "/api/export/labels.seg.nrrd")
        assert status == 200, segmentation
        assert b"dimension: 4" in segmentation and b"Segment0_Name:=Node" in segmentation and b"Segment1_Layer:=1" in segmentation
        assert server.request("POST", "/api/import/mask?name=both.seg.nrrd&planes=1&axes=axial", segmentation)[0] == 200
        page.do("ping")
        assert [one["name"] for one in page.structures.values()] == ["Node", "Rest", "Node", "Rest"]


def test_no_other_file_is_read(tmp_path, study):
    with running(tmp_path, study / "ct", "--project", tmp_path / "a.kontur") as server:
        for file in (study / "plan" / "others.dcm", "/etc/hostname", ""):
            status, reply = import_near(server, file, "&anyway=1")
            assert status == 400 and "lies near the image" in reply["error"]["message"]
    with running(tmp_path, "phantom", "--project", tmp_path / "b.kontur") as server:
        assert near(server) == [], "it is no DICOM"
        assert import_near(server, study / "plan" / "RS.dcm")[0] == 400


@pytest.mark.parametrize("file", ["plan/RS.dcm", "ct/seg.dcm"])
def test_opened_alone_its_images_are_found(tmp_path, study, file):
    with running(tmp_path, study / file, "--project", tmp_path / "a.kontur") as server:
        page = server.page()
        assert page.session["identity"]["modality"] == "CT" and page.session["has_dicom"]
        assert [one["name"] for one in page.structures.values()] == ["Node", "Rest"]
        assert page.contours and not any("belong" in note for note in page.session["image"]["notes"])
        assert page.session["history"]["undo"] is None, "what a project begins with is no step"


def test_no_project_is_left_among_the_files(tmp_path, study):
    with running(tmp_path, study / "plan" / "RS.dcm") as server:
        assert server.page().session["project"].startswith("RS-")
    assert sorted(file.name for file in (study / "plan").iterdir()) == ["RS.dcm", "others.dcm"]


def test_named_with_its_images_a_segmentation_is_drawn_on_them(tmp_path, study):
    with running(tmp_path, study / "ct" / "seg.dcm", study / "ct", "--project", tmp_path / "a.kontur") as server:
        assert [one["name"] for one in server.page().structures.values()] == ["Node", "Rest"]


def test_a_structure_set_without_its_images_is_refused_in_a_sentence(tmp_path, study):
    (tmp_path / "alone").mkdir()
    lost = shutil.copy(study / "plan" / "RS.dcm", tmp_path / "alone")
    ended = subprocess.run([KONTUR, "open", lost, "--no-browser", "--project", tmp_path / "a.kontur"], capture_output=True, text=True)
    assert ended.returncode != 0 and "was drawn on images that do not lie near it" in ended.stderr
    assert not (tmp_path / "a.kontur").exists()


def test_the_start_page_lists_them(tmp_path, study, monkeypatch):
    monkeypatch.setenv("HOME", str(study.parent))
    with running(tmp_path) as server:
        query = urllib.parse.urlencode({"path": str(study / "plan")})
        folder = json.loads(server.request("GET", f"/api/folder?{query}")[2])
        assert [(one["name"], one["kind"]) for one in folder["files"]] == [("others.dcm", "drawing"), ("RS.dcm", "drawing")]
        assert folder["dicom"] == "none", "no image is among them"
        page = server.page()
        status, _, body = server.request("POST", "/api/open", json.dumps({"path": str(study / "plan" / "RS.dcm")}).encode())
        assert status == 200, body
        while page.receive()["event"] != "opened":
            pass
        opened = server.page()
        assert [one["name"] for one in opened.structures.values()] == ["Node", "Rest"]
        server.stop(signal.SIGINT)
