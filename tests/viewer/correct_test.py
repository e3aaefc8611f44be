# SPDX-License-Identifier: Apache-2.0
"""kontur open: a mask that is corrected is what `kontur correct` makes of it, and survives what projects survive."""
import json
import pathlib
import shutil
import signal
import subprocess
import sys

import nibabel
import numpy
import pytest

from support import KONTUR, at_offset, ring, running, write_image, Server

SUPPORT = pathlib.Path(__file__).parent.parent / "support"


def write_labels(path, image):
    """A ball with a leak as label 2, a cube as label 5, on the grid of the image."""
    like = nibabel.load(image)
    index = numpy.stack(numpy.meshgrid(*(numpy.arange(n) for n in like.shape), indexing="ij"), -1)
    away = (index - numpy.array(like.shape) // 2) * (1.0, 1.2, 1.5)
    labels = numpy.where(numpy.linalg.norm(away, axis=-1) < 10, 2, 0).astype(numpy.uint8)
    labels[(numpy.abs(away - (12, 0, 0)) < 3.5).all(-1)] = 2
    labels[2:6, 2:6, 2:6] = 5
    nibabel.save(nibabel.Nifti1Image(labels, like.affine), path)


def imported(server, path, query="&as=correct"):
    kind = "contours" if path.suffix == ".dcm" else "mask"
    status, _, body = server.request("POST", f"/api/import/{kind}?name={path.name}{query}", path.read_bytes())
    assert status == 200, body
    return json.loads(body)


def exported(server, name, structure=None):
    query = "" if structure is None else f"?structure={structure}"
    status, _, body = server.request("GET", f"/api/export/{name}{query}")
    assert status == 200, body
    return body


def voxels(path):
    return numpy.asarray(nibabel.load(path).dataobj)


def saved(folder, server, name, structure=None):
    path = folder / name
    path.write_bytes(exported(server, name, structure))
    return path


def lines(points):
    return [{"at": p, "kind": "line"} for p in points]


def correct_by_hand(page, liver):
    """A whole outline, a stroke, a plane without anything, one that is right, and a point."""
    plane = page.session["views"]["axial"]["plane"]
    page.do("contour.add", structure=liver, plane=plane, control=lines(ring(plane, 9, 48)))
    beside = at_offset(page.session["views"]["coronal"]["plane"], 4)
    stroke = [p for n, p in enumerate(ring(beside, 9.2, 60)) if 4 <= n <= 16]
    page.do("contour.add", structure=liver, plane=beside, control=lines(stroke), closed=False)
    page.do("structure.set", id=liver, empty_planes=[at_offset(plane, 9)])
    page.do("structure.set", id=liver, confirmed_planes=[at_offset(plane, -6)])
    page.do("point.add", structure=liver, at=at_offset(page.session["views"]["sagittal"]["plane"], -11)["origin"], kind="interior")


@pytest.fixture(scope="module")
def scan(tmp_path_factory):
    folder = tmp_path_factory.mktemp("scan")
    write_image(folder / "ball.nii")
    image = nibabel.load(folder / "ball.nii")
    noisy = numpy.asarray(image.dataobj) + numpy.random.default_rng(47).integers(-60, 60, image.shape)
    nibabel.save(nibabel.Nifti1Image(noisy.astype(numpy.int16), image.affine), folder / "ball.nii")
    write_labels(folder / "labels.nii.gz", folder / "ball.nii")
    return folder


@pytest.mark.parametrize("use_image", [False, True])
def test_it_is_what_kontur_correct_makes_of_the_same_files(tmp_path, scan, use_image):
    with running(tmp_path, scan / "ball.nii", "--project", tmp_path / "a.kontur") as server:
        page = server.page()
        reply = imported(server, scan / "labels.nii.gz")
        assert reply["doubts"] == [] and len(reply["structures"]) == 2
        page.do("image.set", use=use_image)
        liver, cube = reply["structures"]
        assert [page.structures[one]["label_value"] for one in (liver, cube)] == [2, 5] and not page.contours
        before = voxels(scan / "labels.nii.gz")
        assert (voxels(saved(tmp_path, server, "labels.nii.gz")) == before).all(), "nothing is corrected yet"
        correct_by_hand(page, liver)
        own = voxels(saved(tmp_path, server, "mask.nii.gz", liver))
        drawn = saved(tmp_path, server, "contours.json", liver)
        words = [KONTUR, "correct", scan / "labels.nii.gz", drawn, "--label", "2", "--output", tmp_path / "out.nii.gz"]
        words += ["--image", scan / "ball.nii"] if use_image else []
        subprocess.run(words, check=True)
        assert ((voxels(tmp_path / "out.nii.gz") == 2) == (own != 0)).all() and (own != (before == 2)).any()
        changed = int((own != (before == 2)).sum())
        while page.wait_for_surface(liver)["correction"]["voxels"] != changed:
            pass  # of the edits before
        while page.history["undo"] != "Import a mask":
            page.do("undo")
        assert (voxels(saved(tmp_path, server, "labels.nii.gz")) == before).all()


def write_halves(path, image):
    """A ball as two labels that touch, 2 and 5, beside each other along the first axis."""
    like = nibabel.load(image)
    index = numpy.stack(numpy.meshgrid(*(numpy.arange(n) for n in like.shape), indexing="ij"), -1)
    away = (index - numpy.array(like.shape) // 2) * (1.0, 1.2, 1.5)
    labels = numpy.where(numpy.linalg.norm(away, axis=-1) < 12, numpy.where(away[..., 0] < 1, 2, 5), 0).astype(numpy.uint8)
    nibabel.save(nibabel.Nifti1Image(labels, like.affine), path)


def test_masks_that_share_borders_follow_as_kontur_correct_lets_them(tmp_path, scan):
    write_halves(tmp_path / "halves.nii.gz", scan / "ball.nii")
    before = voxels(tmp_path / "halves.nii.gz")
    with running(tmp_path, scan / "ball.nii", "--project", tmp_path / "a.kontur") as server:
        page = server.page()
        first, second = imported(server, tmp_path / "halves.nii.gz")["structures"]
        page.do("image.set", use=False)
        plane = page.session["views"]["axial"]["plane"]
        page.do("contour.add", structure=first, plane=plane, control=lines(ring(plane, 8, 48)))
        page.do("borders.set", shared=False)
        alone = voxels(saved(tmp_path, server, "labels.nii.gz"))
        page.do("borders.set", shared=True)
        shared = voxels(saved(tmp_path, server, "labels.nii.gz"))
        drawn = saved(tmp_path, server, "contours.json", first)
        subprocess.run([KONTUR, "correct", tmp_path / "halves.nii.gz", drawn, "--label", "2", "--shared-borders", "--output",
                        tmp_path / "out.nii.gz"], check=True)
        assert (voxels(tmp_path / "out.nii.gz") == shared).all()
        gained = (shared == 5) & (before == 2)
        assert gained.any() and ((before == 5) & (shared == 2)).any(), "it retreats here and goes ahead there"
        assert not (gained & (alone == 5)).any()
        own = voxels(saved(tmp_path, server, "mask.nii.gz", second)) != 0
        assert (own == (shared == 5)).all(), "by itself, too"
        followed = int((own != (before == 5)).sum())
        while page.wait_for_surface(second).get("correction", {}).get("followed") != followed:
            pass
        while page.history["undo"] != "Import a mask":
            page.do("undo")
        while page.wait_for_surface(second)["correction"].get("followed"):
            pass
        assert (voxels(saved(tmp_path, server, "labels.nii.gz")) == before).all()


def test_it_survives_kill_9_a_moved_mask_and_a_moved_project(tmp_path, scan):
    mask = shutil.copy(scan / "labels.nii.gz", tmp_path)
    project = tmp_path / "a.kontur"
    server = Server(tmp_path, scan / "ball.nii", "--project", project)
    page = server.page()
    liver = imported(server, pathlib.Path(mask))["structures"][0]
    correct_by_hand(page, liver)
    before = exported(server, "labels.nii.gz")
    server.stop(signal.SIGKILL)
    pathlib.Path(mask).unlink()
    (tmp_path / "elsewhere").mkdir()
    moved = shutil.move(project, tmp_path / "elsewhere" / "b.kontur")
    with running(tmp_path, scan / "ball.nii", "--project", moved) as server:
        page = server.page()
        assert exported(server, "labels.nii.gz") == before
        assert exported(server, "project.kontur")
        page.do("undo")
        page.do("redo")
        assert exported(server, "labels.nii.gz") == before


def test_what_cannot_be_asked_for_is_refused_in_a_sentence(tmp_path, scan):
    with running(tmp_path, scan / "ball.nii", "--project", tmp_path / "a.kontur") as server:
        body = (scan / "labels.nii.gz").read_bytes()
        status, _, reply = server.request("POST", "/api/import/mask?name=x.nii.gz&as=voxels", body)
        assert status == 400 and "contours or correct is needed" in json.loads(reply)["error"]["message"]
        page = server.page()
        liver = imported(server, scan / "labels.nii.gz")["structures"][0]
        page.do("ping")
        plane = page.session["views"]["axial"]["plane"]
        far = [p for n, p in enumerate(ring(plane, 19, 60)) if n < 6]
        error = page.refused("contour.add", structure=liver, plane=plane, control=lines(far), closed=False)
        assert error["message"].startswith("The line is open, and an end of it lies "), error
        other = page.do("structure.add", name="Mine")["structure"]["id"]
        assert "is no mask to be corrected" in page.refused("structure.set", id=other, reach=2)["message"]


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """A CT, and what others segmented on it: a structure set that fills its slices, and a SEG."""
    pytest.importorskip("pydicom")
    folder = tmp_path_factory.mktemp("study")
    subprocess.run([sys.executable, SUPPORT / "make_dicom_series.py", "axial", folder / "made"], check=True)
    with running(folder, folder / "made" / "dicom", "--project", folder / "drawn.kontur") as server:
        page = server.page()
        plane = page.session["views"]["axial"]["plane"]
        node = next(iter(page.structures))
        page.do("structure.set", id=node, name="Node")
        for step in (-2.5, 0, 2.5):
            page.do("contour.add", structure=node, plane=at_offset(plane, step), control=lines(ring(at_offset(plane, step), 2.6)))
        for name in ("rtstruct.dcm", "seg.dcm"):
            saved(folder, server, name)
    return folder


@pytest.mark.parametrize("name", ["seg.dcm", "rtstruct.dcm"])
def test_segments_and_regions_come_in_and_go_out(tmp_path, study, name):
    pydicom = pytest.importorskip("pydicom")
    with running(tmp_path, study / "made" / "dicom", "--project", tmp_path / "a.kontur") as server:
        page = server.page()
        reply = imported(server, study / name)
        (node,) = reply["structures"]
        page.do("ping")
        assert page.structures[node]["mask"]["confirmed_planes"] == [] and not page.contours, reply
        before = voxels(saved(tmp_path, server, "labels.nii.gz"))
        assert before.any()
        plane = page.session["views"]["axial"]["plane"]
        page.do("contour.add", structure=node, plane=plane, control=lines(ring(plane, 3.4)))
        after = voxels(saved(tmp_path, server, "labels.nii.gz"))
        assert (after != before).any()
        segment = pydicom.dcmread(saved(tmp_path, server, "seg.dcm")).SegmentSequence[0]
        assert segment.SegmentAlgorithmType == "SEMIAUTOMATIC" and segment.SegmentAlgorithmName.endswith("kontur correct")
        again = imported(server, saved(tmp_path, server, "rtstruct.dcm"))
        assert (voxels(saved(tmp_path, server, "mask.nii.gz", again["structures"][0])) == after).all()


def test_contours_that_leave_slices_out_stay_contours(tmp_path, study):
    pytest.importorskip("pydicom")
    with running(tmp_path, study / "made" / "dicom", "--project", tmp_path / "a.kontur") as server:
        page = server.page()
        plane = page.session["views"]["axial"]["plane"]
        planes = [
            {"origin": one["origin"], "normal": one["normal"], "contours": [{"points": ring(one, 2)}]}
            for one in (at_offset(plane, -5), plane)
        ]
        path = tmp_path / "sparse.json"
        path.write_text(json.dumps({"version": 1, "frame": "LPS mm", "structure": "Sparse", "planes": planes}))
        status, _, body = server.request("POST", "/api/import/contours?name=sparse.json&as=correct", path.read_bytes())
        assert status == 200, body
        page.do("ping")
        assert len(page.contours) == 2 and "stays contours" in json.loads(body)["notes"][0]
