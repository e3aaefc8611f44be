# SPDX-License-Identifier: Apache-2.0
"""A structure that was drawn at several times of a cine: its surfaces, volumes and files are those of `kontur segment`."""
import csv
import gzip
import io
import json
import math
import os
import signal
import subprocess
import time

import nibabel
import numpy
import pytest
from support import Page, Server, at_offset, ring, running, spline_controls

FRAMES, OWN = 6, 2  # opened at the third
SLICES = (-12, -6, 0, 6, 12)


def radius_at(frame):
    """Of the ball, mm; frames count from 1, and the motion repeats."""
    return 22 + 4 * math.cos(2 * math.pi * (frame - 1) / FRAMES)


def write_cine(path, frames=FRAMES):
    index = numpy.stack(numpy.meshgrid(*(numpy.arange(30) for _ in range(3)), indexing="ij"), -1)
    away = numpy.linalg.norm(2.0 * (index - 14.5), axis=-1)
    values = numpy.stack([numpy.where(away < radius_at(frame), 100, 0) for frame in range(1, frames + 1)], -1)
    affine = numpy.diag([2.0, 2.0, 2.0, 1.0])
    affine[:3, 3] = -29
    image = nibabel.Nifti1Image(values.astype(numpy.int16), affine)
    image.header.set_xyzt_units("mm", "sec")
    image.header["pixdim"][4] = 0.05
    nibabel.save(image, path)


@pytest.fixture
def cine(tmp_path):
    write_cine(tmp_path / "cine.nii.gz")
    return tmp_path / "cine.nii.gz"


@pytest.fixture
def server(tmp_path, cine):
    with running(tmp_path, cine, "--frame", str(OWN + 1), "--project", tmp_path / "work.kontur") as server:
        yield server


def axial(page, at):
    return at_offset(page.session["views"]["axial"]["plane"], at)


def draw(page, frame, slices=SLICES):
    """Circles of the ball in a frame, from 1; returns their ids."""
    structure = next(iter(page.structures))
    added = []
    for at in slices:
        plane = axial(page, at)
        radius = math.sqrt(radius_at(frame) ** 2 - at**2)
        more = {} if frame - 1 == OWN else {"time": frame - 1}
        middle = numpy.array(plane["origin"])  # the ball's is the patient's origin
        center = [-float(middle @ plane["u"]), -float(middle @ plane["v"])]
        control = spline_controls(ring(plane, radius, 16, center))
        added.append(page.do("contour.add", structure=structure, plane=plane, control=control, **more)["contour"]["id"])
    return added


def wait_for_motion(page, structure, is_there=lambda motion: motion["finished"]):
    """The next such motion."""
    while True:
        for at, event in enumerate(page.events):
            if event["event"] == "motion" and event["structure"] == structure and is_there(event):
                del page.events[: at + 1]
                return event
        page.events.clear()
        page._apply(page.receive())


def download(server, name, structure, **more):
    query = "&".join(f"{key}={value}" for key, value in {"structure": structure, **more}.items())
    status, headers, body = server.request("GET", f"/api/export/{name}?{query}")
    assert status == 200, body
    return body, headers["Content-Disposition"]


def voxels(body):
    return numpy.asarray(nibabel.Nifti1Image.from_bytes(gzip.decompress(body)).dataobj)


def test_contours_belong_to_frames_and_surfaces_to_all_of_them(server, tmp_path, cine):
    page = Page(server)
    structure = next(iter(page.structures))
    assert page.session["cycle_frames"] is None and page.session["motions"] == []
    own = draw(page, OWN + 1)
    assert "time" not in page.contours[own[0]]
    page.wait_for_surface(structure)
    assert not any(event["event"] == "motion" for event in page.events), "what was drawn in one frame does not move"
    other = draw(page, 6)
    assert page.contours[other[0]]["time"] == 5
    page.do("cycle.set", repeats=True)
    page.events.clear()
    motion = wait_for_motion(page, structure)
    assert len(motion["revisions"]) == FRAMES and all(motion["revisions"])

    # The same voxels, volumes and table as the command line's.
    contours, _ = download(server, "contours.json", structure)
    (tmp_path / "drawn.json").write_bytes(contours)
    told = json.loads(contours)
    assert told["cycle_frames"] == FRAMES
    assert {contour["frame"] for plane in told["planes"] for contour in plane["contours"]} == {OWN + 1, 6}
    subprocess.run([os.environ["KONTUR_CLI"], "segment", tmp_path / "drawn.json", "--image", cine, "--output", tmp_path / "cli.nii.gz",
                    "--volumes", tmp_path / "cli.csv"], check=True, capture_output=True)
    by_cli = numpy.asarray(nibabel.load(tmp_path / "cli.nii.gz").dataobj)
    body, name = download(server, "masks.nii.gz", structure)
    assert 'filename="cine_Structure_1.nii.gz"' in name
    assert numpy.array_equal(voxels(body), by_cli) and by_cli.shape == (30, 30, 30, FRAMES)
    table, _ = download(server, "volumes.csv", structure)
    assert table == (tmp_path / "cli.csv").read_bytes()
    rows = list(csv.DictReader(io.StringIO(table.decode())))
    assert [row["time_s"] for row in rows][:3] == ["0", "0.05", "0.1"]
    assert numpy.allclose([float(row["volume_ml"]) for row in rows], motion["curve"]["volumes_ml"], atol=1e-3)
    for frame in (1, 3, 6):
        body, name = download(server, "mask.nii.gz", structure, time=frame - 1)
        assert numpy.array_equal(voxels(body), by_cli[..., frame - 1]) and f"frame_{frame}" in name

    # Surfaces are those of the frames: as large as their masks, and where views cut them.
    plane = page.session["views"]["axial"]["plane"]
    for frame in (1, 3, 5):
        head, arrays = server.binary("GET", f"/api/mesh/{structure}?time={frame - 1}")
        assert head["revision"] == motion["revisions"][frame - 1]
        p = arrays["positions"].reshape(-1, 3)[arrays["triangles"].reshape(-1, 3)].astype(float)
        ml = numpy.einsum("ij,ij->i", p[:, 0], numpy.cross(p[:, 1], p[:, 2])).sum() / 6000
        assert abs(ml / motion["curve"]["volumes_ml"][frame - 1] - 1) < 0.02
        head, arrays = server.slice({**plane, "mm_per_pixel": 1}, time=frame - 1)
        assert head["outlines"][0]["revision"] == motion["revisions"][frame - 1]


def test_a_drawn_frame_shows_what_was_drawn(server):
    page = Page(server)
    structure = next(iter(page.structures))
    draw(page, OWN + 1)
    draw(page, 6)
    page.do("cycle.set", repeats=True)
    page.events.clear()
    wait_for_motion(page, structure)
    for frame in (OWN + 1, 6):
        _, arrays = server.binary("GET", f"/api/mesh/{structure}?time={frame - 1}")
        points = arrays["positions"].reshape(-1, 3) - (0, 0, 1)  # the views show slices of voxels, which lie at odd places
        drawn = numpy.abs(points[:, 2]) < max(SLICES)
        assert drawn.sum() > 1000
        assert abs(numpy.linalg.norm(points[drawn], axis=1) - radius_at(frame)).max() < 0.35


def test_an_edit_is_undone_and_a_killed_server_keeps_all(server, tmp_path, cine):
    page = Page(server)
    structure = next(iter(page.structures))
    draw(page, OWN + 1)
    moved = draw(page, 6)[2]
    page.do("cycle.set", repeats=True)
    page.events.clear()
    before = wait_for_motion(page, structure)["curve"]
    page.do("contour.remove", ids=[moved])
    after = wait_for_motion(page, structure, lambda m: m["finished"] and m["curve"] != before)["curve"]
    assert after != before
    assert page.do("undo")["label"] == "Delete a contour"
    assert wait_for_motion(page, structure, lambda m: m["finished"] and m["curve"] != after)["curve"] == before
    assert page.contours[moved]["time"] == 5
    contours = dict(page.contours)
    page.close()
    server.stop(signal.SIGKILL)
    again = Server(tmp_path, tmp_path / "work.kontur")
    try:
        page = Page(again)
        assert page.contours == contours and page.session["cycle_frames"] == FRAMES
        assert wait_for_motion(page, structure)["curve"] == before
        for label in ("The motion repeats", "Draw a contour"):
            assert page.do("undo")["label"] == label
        assert len(page.contours) == len(contours) - 1
    finally:
        again.stop(signal.SIGKILL)


def test_contours_of_one_frame_are_what_they_were(server, tmp_path):
    page = Page(server)
    structure = next(iter(page.structures))
    draw(page, OWN + 1)
    page.wait_for_surface(structure)
    contours, _ = download(server, "contours.json", structure)
    assert b'"frame": 3' not in contours and b"cycle" not in contours
    # What is drawn in another frame alone does not move either, and its file says which it was.
    ids = list(page.contours)
    page.do("contour.remove", ids=ids)
    draw(page, 1)
    page.wait_for_surface(structure)
    assert not any(event["event"] == "motion" for event in page.events)
    contours, _ = download(server, "contours.json", structure)
    assert contours.count(b'"frame": 1') == len(SLICES)


def test_a_file_with_frames_comes_in_and_others_are_refused(server, tmp_path):
    page = Page(server)
    draw(page, OWN + 1)
    draw(page, 6)
    page.do("cycle.set", repeats=True)
    page.events.clear()
    drawn, _ = download(server, "contours.json", next(iter(page.structures)))

    def import_of(text, to=server):
        return to.request("POST", "/api/import/contours?name=beating.json", text)

    status, _, reply = import_of(drawn)
    assert status == 200, reply
    page.do("ping")
    added = json.loads(reply)["structures"][0]
    times = sorted({contour.get("time", OWN) for contour in page.contours.values() if contour["structure"] == added})
    assert times == [OWN, 5]
    status, _, reply = import_of(drawn.replace(b'"frame": 6', b'"frame": 9').replace(b'"cycle_frames": 6', b'"cycle_frames": 12'))
    assert status == 400 and "lies in frame 9, and the image's frames go from 1 to 6" in reply.decode()
    write_cine(tmp_path / "still.nii.gz", frames=1)
    with running(tmp_path, tmp_path / "still.nii.gz") as other:
        status, _, reply = import_of(drawn, other)
        assert status == 400 and "the image has 1 frame" in reply.decode()


def test_what_a_kind_of_file_cannot_hold_is_said(server):
    page = Page(server)
    structure = next(iter(page.structures))
    draw(page, OWN + 1)
    for name in ("masks.nii.gz", "volumes.csv"):
        status, _, reply = server.request("GET", f"/api/export/{name}?structure={structure}")
        assert status == 400 and "was drawn in one frame" in reply.decode()
    draw(page, 6)
    status, _, reply = server.request("GET", f"/api/export/contours.mrk.json?structure={structure}")
    assert status == 415 and "holds contours of one frame" in reply.decode()
    status, _, reply = server.request("GET", f"/api/export/mask.nii.gz?structure={structure}&time=6")
    assert status == 400 and "there is no time 6: the last one is time 5" in reply.decode()
    assert "there is no time 7" in page.refused("contour.add", structure=structure, plane=axial(page, 0), control=spline_controls(ring(axial(page, 0), 9)), time=7)["message"]


def test_a_single_slice_in_a_frame_is_carried_on_while_it_is_drawn(server):
    """A draft in a frame of little shows a whole body, not one slice blown up."""
    page = Page(server)
    structure = next(iter(page.structures))
    draw(page, OWN + 1)
    draw(page, 6)
    wait_for_motion(page, structure)
    page.events.clear()
    plane = axial(page, 0)
    server.slice({**plane, "mm_per_pixel": 1}, time=0)  # somebody looks at the first frame
    began = time.perf_counter()
    page.do("contour.add", structure=structure, plane=plane, control=spline_controls(ring(plane, radius_at(1), 16)), time=0, draft=True)
    event = page.wait_for_surface(structure, "preview")
    took = time.perf_counter() - began
    assert event["time"] == 0
    _, arrays = server.binary("GET", f"/api/mesh/{structure}?time=0")
    heights = arrays["positions"].reshape(-1, 3)[:, 2]
    assert 30 < heights.max() - heights.min() < 60
    print(f"preview after {1000 * took:.0f} ms")
    page.do("draft.drop")
