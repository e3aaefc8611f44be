# SPDX-License-Identifier: Apache-2.0
"""kontur open: a session as a page lives it."""
import concurrent.futures
import contextlib
import gzip
import html
import json
import math
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import socket
import sqlite3
import subprocess
import sys
import time

import nibabel
import numpy
import pytest

from support import KONTUR, Page, Server, at_offset, ring, running, shifted, spline_controls, write_image

RADIUS = 12.0


@pytest.fixture(scope="module")
def image(tmp_path_factory):
    path = tmp_path_factory.mktemp("image") / "ball.nii.gz"
    write_image(path, RADIUS)
    return path


@pytest.fixture
def server(tmp_path, image):
    with running(tmp_path, image, "--project", tmp_path / "work.kontur") as one:
        yield one


def draw_ball(page, structure):
    """Three spline circles of the ball on the axial view; returns their ids."""
    plane = page.session["views"]["axial"]["plane"]
    ids = []
    for offset in (-6.0, 0.0, 6.0):
        at = at_offset(plane, offset)
        points = ring(at, (RADIUS**2 - offset**2) ** 0.5)
        ids.append(page.do("contour.add", structure=structure, plane=at, control=spline_controls(points))["contour"]["id"])
    return ids


def the_structure(page):
    return next(iter(page.structures))


def test_the_session_describes_the_image(server):
    session = server.page().session
    assert session["title"] == "ball.nii.gz" and session["project"] == "work.kontur"
    assert session["image"]["size"] == [48, 40, 32]
    assert numpy.allclose(session["image"]["spacing_mm"], [1.0, 1.2, 1.5])
    assert session["image"]["unit"] == "HU" and session["image"]["range"] == [-1000, 100]
    assert {"Abdomen", "Lung"} <= {preset["name"] for preset in session["presets"]}
    axial = session["views"]["axial"]
    assert axial["step_mm"] == pytest.approx(1.5) and axial["range_mm"] == pytest.approx([-24, 22.5])
    assert session["history"] == {"undo": None, "redo": None}
    for view in session["views"].values():
        frame = numpy.array([view["plane"][k] for k in ("u", "v", "normal")])
        assert numpy.allclose(frame @ frame.T, numpy.eye(3), atol=1e-12)


def test_a_slice_shows_the_ball_where_it_is(server):
    page = server.page()
    for view in page.session["views"].values():
        plane = shifted(view["plane"], 65, 65, 0.5)
        head, arrays = server.slice(plane, 65, 65, pixels="shades")
        bright = arrays["pixels"].reshape(65, 65) > 127
        rows, columns = numpy.nonzero(bright)
        assert bright.sum() * 0.25 == pytest.approx(numpy.pi * RADIUS**2, rel=0.06)
        assert numpy.allclose([rows.mean(), columns.mean()], 32, atol=0.5)
        assert all(head["letters"][side] for side in ("left", "right", "top", "bottom"))


def test_a_slice_comes_no_finer_than_the_image_is(server):
    axial = server.page().session["views"]["axial"]["plane"]
    plane = shifted(axial, 500, 400, 0.1)  # of 50 x 40 mm, in voxels of 1.0 x 1.2 mm
    head, arrays = server.slice(plane, 500, 400)
    samples = head["samples"]
    assert "pixels" not in arrays and samples["step"] == pytest.approx([10, 12])
    assert 48 <= samples["columns"] <= 53 and 34 <= samples["rows"] <= 37
    codes = arrays["values"].reshape(samples["rows"], samples["columns"])
    values = head["values"]["first"] + head["values"]["step"] * (codes - 1.0)
    assert set(numpy.round(values[codes > 0], 2).tolist()) == {-1000, 100}, "voxels as they are, none between them"
    finer, shades = server.slice(plane, 500, 400, pixels="shades")
    assert "samples" not in finer and shades["pixels"].size == 500 * 400
    coarser, shades = server.slice(shifted(axial, 50, 40, 1.0), 50, 40)
    assert "samples" not in coarser and shades["pixels"].size == 50 * 40


def test_a_slice_comes_compressed_where_that_is_asked_for(server):
    plane = server.page().session["views"]["axial"]["plane"] | {"mm_per_pixel": 0.5}
    request = {"view": "test", "plane": plane, "width": 65, "height": 65, "pixels": "values"}
    status, headers, plain = server.request("POST", "/api/slice", json.dumps(request).encode())
    assert status == 200 and "Content-Encoding" not in headers
    status, headers, bytes_ = server.request("POST", "/api/slice", json.dumps(request | {"compressed": True}).encode())
    assert status == 200 and headers["Content-Encoding"] == "gzip" and len(bytes_) < len(plain)
    assert gzip.decompress(bytes_) == plain


def test_values_and_presets_follow_the_image(server):
    page = server.page()
    center = page.session["views"]["axial"]["plane"]["origin"]
    assert page.do("value", at=center)["values"] == [pytest.approx(100)]
    assert page.do("value", at=[9000, 0, 0])["values"] == [None]


def test_drawing_gives_a_surface_and_outlines_in_every_view(server):
    page = server.page()
    structure = the_structure(page)
    draw_ball(page, structure)
    surface = page.wait_for_surface(structure)
    assert surface["volume_ml"] == pytest.approx(4 / 3 * numpy.pi * RADIUS**3 / 1000, rel=0.05)
    assert surface["residual"]["max_mm"] < 0.5
    head, mesh = server.binary("GET", f"/api/mesh/{structure}")
    assert head["revision"] == surface["revision"]
    points = mesh["positions"].reshape(-1, 3)
    assert mesh["normals"].size == mesh["positions"].size and mesh["triangles"].max() < len(points)
    center = numpy.array(page.session["views"]["axial"]["plane"]["origin"])
    assert numpy.abs(numpy.linalg.norm(points - center, axis=1) - RADIUS).max() < 1.5
    for view in page.session["views"].values():
        head, arrays = server.slice(shifted(view["plane"], 65, 65, 0.5), 65, 65, pixels=False)
        assert "pixels" not in arrays
        (outline,) = head["outlines"]
        assert outline["structure"] == structure and len(outline["lines"]) == 1 and outline["lines"][0]["closed"]
        line = arrays["outline_points"].reshape(-1, 2)
        assert numpy.abs(numpy.hypot(*(line - 32).T) * 0.5 - RADIUS).max() < 1.0
    assert len(head["crossings"]) >= 2


def events_until_finished(page):
    while not any(event["event"] == "surface" and event["stage"] == "finished" for event in page.events):
        page._apply(page.receive())
    return page.events


def told_lines(event, view):
    """The lines in a view of an `outlines` event, as points in pixels."""
    (told,) = [told for told in event["views"] if told["view"] == view]
    return told["plane"], [numpy.array(line).reshape(-1, 2) for line in told["lines"]]


def test_outlines_are_told_ahead_of_their_surface_in_the_planes_that_were_asked_for(server):
    page = server.page()
    structure = the_structure(page)
    ids = draw_ball(page, structure)
    page.wait_for_surface(structure)
    planes = {name: shifted(page.session["views"][name]["plane"], 65, 65, 0.5) for name in ("axial", "coronal")}
    for name, plane in planes.items():
        server.slice(at_offset(plane, 3), 65, 65, view=name, pixels=False)
        server.slice(plane, 65, 65, view=name, pixels=False)
    page.events.clear()
    page.do("contour.translate", id=ids[0], by=[1, 0, 0], draft=True)
    events_until_finished(page)
    ahead = {event["revision"]: at for at, event in enumerate(page.events) if event["event"] == "outlines"}
    surfaces = {event["revision"]: (at, event) for at, event in enumerate(page.events) if event["event"] == "surface" and event["stage"] != "outdated"}
    assert ahead.keys() == surfaces.keys() and [surface["stage"] for _, surface in surfaces.values()] == ["preview", "finished"]
    for revision, at in ahead.items():
        assert at < surfaces[revision][0]
        for name, plane in planes.items():
            told_plane, (line,) = told_lines(page.events[at], name)
            assert told_plane == plane, "to the last bit, so that a page knows it again"
            assert numpy.abs(numpy.hypot(*(line - 32).T) * 0.5 - RADIUS).max() < 2
    # Those of the finished surface are the ones that a slice shows.
    for name, plane in planes.items():
        head, arrays = server.slice(plane, 65, 65, view=name, pixels=False)
        assert head["outlines"][0]["revision"] == max(ahead)
        _, (line,) = told_lines(page.events[ahead[max(ahead)]], name)
        assert numpy.abs(arrays["outline_points"].reshape(-1, 2) - line).max() < 0.01
    page.do("draft.drop")


def test_only_the_latest_planes_are_watched(server):
    page = server.page()
    structure = the_structure(page)
    ids = draw_ball(page, structure)
    page.wait_for_surface(structure)
    for number in range(20):
        server.slice(page.session["views"]["axial"]["plane"] | {"mm_per_pixel": 1}, 8, 8, view=f"view {number}", pixels=False)
    page.events.clear()
    page.do("contour.translate", id=ids[0], by=[1, 0, 0])
    told = [event for event in events_until_finished(page) if event["event"] == "outlines"]
    assert len(told) == 2
    for event in told:
        assert [view["view"] for view in event["views"]] == [f"view {number}" for number in range(12, 20)]


def test_two_pages_are_told_of_their_own_planes(server):
    page = server.page()
    structure = the_structure(page)
    draw_ball(page, structure)
    page.wait_for_surface(structure)
    plane = shifted(page.session["views"]["axial"]["plane"], 65, 65, 0.5)
    planes = [at_offset(plane, offset) for offset in (-3, 0, 3)]
    for at, name in zip(planes, ("one", "two", None), strict=True):
        server.slice(at, 65, 65, view="axial", pixels=False, **({"page": name} if name else {}))
    page.events.clear()
    page.do("contour.translate", id=max(page.contours), by=[1, 0, 0])
    (last,) = [event for event in events_until_finished(page) if event["event"] == "outlines"][-1:]
    assert [view["plane"] for view in last["views"]] == planes


def test_a_surface_is_outdated_before_anybody_is_told_of_an_edit(server):
    """Else a page would show the figures of before as those of now."""
    page = server.page()
    structure = the_structure(page)
    ids = draw_ball(page, structure)
    before = page.wait_for_surface(structure)
    for call, arguments in (("contour.translate", {"id": ids[1], "by": [2, 0, 0]}), ("contour.remove", {"ids": [ids[0]]}), ("undo", {}), ("undo", {})):
        page.events.clear()
        page.do(call, **arguments)
        kinds = [event["event"] for event in page.events]
        (told,) = [event for event in page.events[: kinds.index("changed")] if event["event"] == "surface" and event["stage"] == "outdated"]
        assert told["revision"] == before["revision"] and "volume_ml" not in told
        for surface in server.page().session["surfaces"]:  # where the machine is busy it may be the new one by now
            assert surface["stage"] in ("outdated", "preview") or surface["revision"] > before["revision"]
        before = page.wait_for_surface(structure)


def test_no_surface_of_contours_from_before_is_told_as_finished(server):
    """Edits in the midst of a finishing: what that still gives comes as a preview."""
    page = server.page()
    structure = the_structure(page)
    ids = draw_ball(page, structure)
    page.wait_for_surface(structure)
    choose = random.Random(5)
    is_finished = True
    for n in range(40):  # never back to where it was, for which the surface is kept
        page.do("contour.translate", id=ids[1], by=[choose.choice((-1, 1)) * (1 + n / 64), 0, 0])
        time.sleep(choose.uniform(0, 0.3))
        page.do("ping")
        is_new = was_early = False
        for event in page.events:
            if event["event"] == "changed":
                assert is_new or not is_finished
                was_early = is_finished
            elif event["event"] == "surface":
                is_new = True
                is_finished = event["stage"] == "finished"
        page.events.clear()
        if was_early:  # its own surface, done while a busy machine stored the change: no other one follows
            time.sleep(1)
            page.do("ping")
            assert not [event for event in page.events if event["event"] == "surface"]


def test_contours_are_listed_in_their_own_slice_only(server):
    page = server.page()
    ids = draw_ball(page, the_structure(page))
    axial = page.session["views"]["axial"]["plane"]
    head, _ = server.slice(shifted(axial, 65, 65, 0.5), 65, 65, pixels=False)
    assert head["contours"] == [ids[1]]
    page.do("contour.set", id=ids[1], visible=False)
    head, _ = server.slice(shifted(axial, 65, 65, 0.5), 65, 65, pixels=False)
    assert head["contours"] == []


def test_a_wire_follows_the_ball(server):
    page = server.page()
    plane = shifted(page.session["views"]["axial"]["plane"], 65, 65, 0.5)
    on_edge = ring(page.session["views"]["axial"]["plane"], RADIUS + 1.0, 5)
    controls = [{"at": p, "kind": "wire"} for p in on_edge]
    drawn = page.do("path", plane=plane, control=controls, closed=True)
    center = numpy.array(page.session["views"]["axial"]["plane"]["origin"])
    radii = numpy.linalg.norm(numpy.array(drawn["points"]) - center, axis=1)
    assert len(radii) > 15 and numpy.abs(radii - RADIUS).max() < 1.0
    assert [drawn["points"][c["index"]] for c in drawn["control"]] == [c["at"] for c in drawn["control"]]
    contour = page.do("contour.add", structure=the_structure(page), plane=plane, control=drawn["control"])["contour"]
    assert contour["kind"] == "livewire" and len(contour["control"]) == 5


def test_every_edit_can_be_undone_and_redone(server):
    page = server.page()
    structure = the_structure(page)
    states = [json.dumps([page.structures, page.contours], sort_keys=True)]

    def edit(call, **arguments):
        page.do(call, **arguments)
        states.append(json.dumps([page.structures, page.contours], sort_keys=True))

    first, second, _ = draw_ball(page, structure)
    states.append(json.dumps([page.structures, page.contours], sort_keys=True))
    at = page.contours[first]["points"][0]
    to = [at[0] + 2, at[1] + 1, at[2]]
    edit("contour.move_point", id=first, index=0, to=to)
    edit("contour.insert_point", id=first, at=page.contours[first]["points"][7])
    edit("contour.delete_point", id=first, index=3)
    edit("contour.pull", id=second, **{"from": page.contours[second]["points"][5], "to": to})
    edit("contour.translate", id=second, by=[1, 2, 3])
    edit("contour.redraw", id=second, path=[page.contours[second]["points"][i] for i in (2, 4, 8)])
    edit("contour.copy", id=second, offset_mm=1.5)
    edit("contour.set", id=second, hole=True)
    edit("structure.add", name="Tumour", color="#112233")
    other = max(page.structures)
    edit("contour.set", id=second, structure=other)
    edit("structure.set", id=other, name="Cyst", color="#445566", visible=False)
    edit("contour.remove", ids=[first])
    edit("structure.remove", id=other)

    for expected in reversed(states[1:-1]):
        assert page.do("undo")["label"]
        assert json.dumps([page.structures, page.contours], sort_keys=True) == expected
    for expected in states[2:]:
        assert page.do("redo")["label"]
        assert json.dumps([page.structures, page.contours], sort_keys=True) == expected
    assert page.do("redo")["label"] is None and page.history["redo"] is None


def test_a_draft_moves_the_surface_and_leaves_no_trace(server):
    page = server.page()
    structure = the_structure(page)
    ids = draw_ball(page, structure)
    before = page.wait_for_surface(structure)
    history, contours = page.history, dict(page.contours)
    draft = page.do("contour.translate", id=ids[1], by=[3, 0, 0], draft=True)["contour"]
    assert draft["points"] != contours[ids[1]]["points"]
    assert page.wait_for_surface(structure, "preview")["revision"] > before["revision"]
    page.do("draft.drop")
    assert page.wait_for_surface(structure)["volume_ml"] == pytest.approx(before["volume_ml"], rel=1e-9)
    assert (page.history, page.contours) == (history, contours)


def test_a_draft_ends_with_its_page(server):
    page, other = server.page(), server.page()
    structure = the_structure(page)
    ids = draw_ball(page, structure)
    before = other.wait_for_surface(structure)
    page.do("contour.translate", id=ids[1], by=[8, 0, 0], draft=True)
    drafted = other.wait_for_surface(structure)
    assert abs(drafted["volume_ml"] - before["volume_ml"]) > 0.01 * before["volume_ml"]
    server.page().close()  # one that has drafted nothing
    page.close()

    def volume_ml():
        (surface,) = server.page().session["surfaces"]
        return surface.get("volume_ml", 0)

    wait_for(lambda: volume_ml() == pytest.approx(before["volume_ml"], rel=1e-9), seconds=20)


def test_pages_see_each_others_edits(server):
    one, two = server.page(), server.page()
    one.do("structure.add", name="Seen by both")
    two.do("ping")
    assert one.structures == two.structures and one.history == two.history
    assert server.page().structures == one.structures


def test_all_is_there_after_kill_9(tmp_path, image):
    project = tmp_path / "work.kontur"
    first = Server(tmp_path, image, "--project", project)
    page = first.page()
    ids = draw_ball(page, the_structure(page))
    page.do("contour.remove", ids=[ids[0]])
    page.do("undo")
    page.do("page.save", state={"layout": "big"})
    first.stop(signal.SIGKILL)

    moved = tmp_path / "elsewhere" / "moved.kontur"
    moved.parent.mkdir()
    project.rename(moved)
    with running(tmp_path, moved) as second:
        again = second.page()
        assert (again.structures, again.contours, again.history) == (page.structures, page.contours, page.history)
        assert again.session["page"] == {"layout": "big"}
        assert again.do("redo")["label"] == "Delete a contour" and ids[0] not in again.contours
        for _ in range(4):
            again.do("undo")
        assert again.contours == {}


def test_of_an_image_that_was_moved_it_is_said_how_to_go_on(tmp_path, image):
    project, moved = tmp_path / "work.kontur", tmp_path / "moved.nii.gz"
    image = shutil.copy(image, tmp_path / "here.nii.gz")
    with running(tmp_path, image, "--project", project) as server:
        ids = draw_ball(server.page(), the_structure(server.page()))
    image.rename(moved)
    ended = subprocess.run([KONTUR, "open", project, "--no-browser"], capture_output=True, text=True)
    assert ended.returncode == 74 and f"was drawn on {image}, which is not there; where it has moved" in ended.stderr, ended
    with running(tmp_path, project, moved) as server:
        assert set(server.page().contours) == set(ids)
    with running(tmp_path, project) as server:
        assert set(server.page().contours) == set(ids), "the new place is kept"


def test_exports_are_what_the_command_line_makes(server, tmp_path, image):
    page = server.page()
    structure = the_structure(page)
    draw_ball(page, structure)
    page.do("structure.set", id=structure, name="ball / 1")

    def export(name):
        status, headers, body = server.request("GET", f"/api/export/{name}?structure={structure}")
        assert status == 200 and headers["Content-Disposition"] == f'attachment; filename="ball_ball_1{name[name.find("."):]}"'
        (tmp_path / name).write_bytes(body)
        return tmp_path / name

    contours = export("contours.json")
    made = subprocess.run(
        [KONTUR, "segment", contours, "--image", image, "--output", tmp_path / "own.nii.gz", "--mesh", tmp_path / "own.stl", "--quiet"]
    )
    assert made.returncode == 0
    # All but the notes on how they were made: only the command line has read a contour file.
    ours, theirs = nibabel.load(export("mask.nii.gz")), nibabel.load(tmp_path / "own.nii.gz")
    assert numpy.array_equal(ours.dataobj, theirs.dataobj) and numpy.asarray(ours.dataobj).any()
    assert numpy.array_equal(ours.affine, theirs.affine)
    stl_header = 80
    assert export("mesh.stl").read_bytes()[stl_header:] == (tmp_path / "own.stl").read_bytes()[stl_header:]
    picture = export("picture.png").read_bytes()
    assert picture.startswith(b"\x89PNG")
    made = json.loads(contours.read_text())["provenance"]
    assert made["made_by"] == "kontur open" and made["image_fingerprint"].startswith("48x40x32-int16-")
    assert json.loads(export("contours.mrk.json").read_text())["kontur"] == made
    noted = dict(re.findall(rb"kontur (\w+)\0+([0-9a-f]{64})", picture))
    assert noted[b"contours_sha256"].decode() == made["contours_sha256"] and b"grid_sha256" in noted
    status, _, body = server.request("GET", "/api/export/project.kontur")
    (tmp_path / "copy.kontur").write_bytes(body)
    with running(tmp_path, tmp_path / "copy.kontur") as other:
        assert other.page().contours == page.contours


def test_an_export_that_nobody_waits_for_any_more_is_stopped(tmp_path, image):
    plane_count, points = 40, 250
    with running(tmp_path, image) as server:
        page = server.page()
        plane = page.session["views"]["axial"]["plane"]
        for n in range(plane_count):  # so many points that a mask takes seconds
            at = at_offset(plane, 0.5 * (n - plane_count // 2))
            path = [{"at": p, "kind": "line"} for p in ring(at, 8 + 0.3 * math.sin(n), points)]
            page.do("contour.add", structure=the_structure(page), plane=at, control=path)
        page.wait_for_surface(the_structure(page))
        target = f"/api/export/mask.nii.gz?structure={the_structure(page)}"

        def exporting(page):
            """Waits until the status line tells of an export, or of the end of one."""
            while True:
                event = page.receive()
                if event.get("event") == "status":
                    return event["text"].startswith("Exporting")

        started = time.monotonic()
        assert server.request("GET", target)[0] == 200
        whole = time.monotonic() - started
        page.do("contour.remove", ids=[min(page.contours)])  # of the same drawing the fit is kept
        page = server.page()
        with socket.create_connection(("127.0.0.1", server.port)) as connection:
            connection.sendall(f"GET {target} HTTP/1.1\r\nHost: {server.host}\r\nAuthorization: Bearer {server.token}\r\n\r\n".encode())
            while not exporting(page):
                pass
        started = time.monotonic()
        while exporting(page):
            pass
        assert time.monotonic() - started < 0.5 * whole, whole
        wait_for(lambda: not list(server.folder.glob("kontur-*")), seconds=5)


def test_imports_of_contours_and_masks(server, tmp_path):
    page = server.page()
    structure = the_structure(page)
    draw_ball(page, structure)
    contours = server.request("GET", f"/api/export/contours.json?structure={structure}")[2]
    mask = server.request("GET", f"/api/export/mask.nii.gz?structure={structure}")[2]

    status, _, body = server.request("POST", "/api/import/contours?name=..%2f..%2fmine.json", contours)
    assert status == 200
    (imported,) = json.loads(body)["structures"]
    page.do("ping")
    ours = [c["points"] for c in page.contours.values() if c["structure"] == structure]
    assert [c["points"] for c in page.contours.values() if c["structure"] == imported] == ours

    status, _, body = server.request("POST", "/api/import/mask?name=m.nii.gz&planes=5", mask)
    assert status == 200, body
    (traced,) = json.loads(body)["structures"]
    surface = page.wait_for_surface(traced)
    assert surface["volume_ml"] == pytest.approx(4 / 3 * numpy.pi * RADIUS**3 / 1000, rel=0.1)
    assert page.do("undo")["label"] == "Import a mask" and traced not in page.structures

    status, _, body = server.request("POST", "/api/import/mask?name=m.exe", mask)
    assert status == 415
    status, _, body = server.request("POST", "/api/import/contours?name=x.json", b"{")
    assert status == 422 and str(tmp_path) not in body.decode()


def vertebrae(path, image, values):
    """A label map on the image's grid: a block for each value, one above the other."""
    grid = nibabel.load(image)
    labels = numpy.zeros(grid.shape, "u1")
    for n, value in enumerate(values):
        labels[10:20, 10:20, 4 + 8 * n : 10 + 8 * n] = value
    nibabel.save(nibabel.Nifti1Image(labels, grid.affine), path)
    return path.read_bytes()


def labels_in(server, name="labels.nii.gz"):
    path = server.folder / name
    path.write_bytes(server.request("GET", f"/api/export/{name}")[2])
    return set(numpy.unique(nibabel.load(path).dataobj)) - {0}


def test_values_of_a_label_map_stay_with_its_structures(server, tmp_path, image):
    page = server.page()
    mask = vertebrae(tmp_path / "v.nii.gz", image, [26, 33])
    status, _, body = server.request("POST", "/api/import/mask?name=v.nii.gz&planes=5", mask)
    assert status == 200, body
    first, second = json.loads(body)["structures"]
    page.do("ping")
    assert [page.structures[n]["label_value"] for n in (first, second)] == [26, 33]
    assert labels_in(server) == {26, 33}
    page.do("structure.set", id=second, label_value=300)
    assert labels_in(server) == {26, 300}
    header = server.request("GET", "/api/export/labels.seg.nrrd")[2]
    assert b"Segment0_LabelValue:=26\n" in header and b"Segment1_LabelValue:=300\n" in header
    status, _, body = server.request("POST", "/api/import/mask?name=w.nii.gz&planes=5", mask)
    (note,) = json.loads(body)["notes"]
    assert note == "the label value 26 of Label 26 is that of Label 26 here; another one is chosen"
    header = server.request("GET", "/api/export/labels.seg.nrrd")[2].decode("latin-1")
    assert re.findall("Segment._LabelValue:=([0-9]+)", header) == ["26", "300", "1", "33"]


def test_the_names_of_a_label_map_are_written_into_it_and_read_from_it(server, tmp_path, image):
    page = server.page()
    mask = vertebrae(tmp_path / "v.nii.gz", image, [26, 33])
    (first, second) = json.loads(server.request("POST", "/api/import/mask?name=v.nii.gz&planes=5", mask)[2])["structures"]
    page.do("structure.set", id=first, name="T8", color="#ff0000")
    exported = server.request("GET", "/api/export/labels.nii.gz")[2]
    again = json.loads(server.request("POST", "/api/import/mask?name=again.nii.gz&planes=5", exported)[2])["structures"]
    page.do("ping")
    assert [page.structures[n]["name"] for n in again] == ["T8", "Label 33"]
    assert page.structures[again[0]]["color"] == "#ff0000"


def test_a_preview_says_what_the_planes_keep_of_a_mask_and_imports_nothing(server, tmp_path):
    page = server.page()
    draw_ball(page, the_structure(page))
    mask = server.request("GET", f"/api/export/mask.nii.gz?structure={the_structure(page)}")[2]
    before = set(page.structures)
    kept = []
    for planes, axes in ((1, "axial"), (9, "axial,sagittal,coronal")):
        status, _, body = server.request("POST", f"/api/import/mask?name=m.nii.gz&planes={planes}&axes={axes}&preview=1", mask)
        assert status == 200, body
        reply = json.loads(body)
        assert reply["structures"] == [] and reply["doubts"] == []
        (ball,) = reply["traced"]
        assert ball["name"] == "m" and ball["volume_ml"] == pytest.approx(4 / 3 * numpy.pi * RADIUS**3 / 1000, rel=0.05)
        kept.append(ball["dice"])
        assert ball["traced_ml"] == pytest.approx(ball["volume_ml"], rel=0.6)
    assert kept[0] < kept[1] and kept[1] > 0.97
    page.do("ping")
    assert set(page.structures) == before and page.history["undo"] == "Draw a contour"


def test_an_import_takes_points_ends_and_weights_along(server):
    page = server.page()
    drawing = {**rings(30, 3, 20), "interior": [[0, 0, 31]], "exterior": [[20, 0, 31]], "surface": [[10, 0, 33]]}
    drawing["planes"][0]["contours"][0].update(closed=False)
    drawing["planes"][1]["contours"][0].update(end="flat", weight=0.5)
    status, _, body = server.request("POST", "/api/import/contours?name=a.json&anyway=1", json.dumps(drawing).encode())
    assert status == 200, body
    reply = json.loads(body)
    assert reply["notes"] == []
    page.do("ping")
    (imported,) = (page.structures[i] for i in reply["structures"])
    assert (imported["interior"], imported["exterior"], imported["surface_points"]) == ([[0, 0, 31]], [[20, 0, 31]], [{"at": [10, 0, 33]}])
    own = [contour for contour in page.contours.values() if contour["structure"] == imported["id"]]
    assert sorted(contour["closed"] for contour in own) == [False, True, True]
    assert [(contour["end"], contour["weight"]) for contour in own if "end" in contour] == [("flat", 0.5)]
    exported = json.loads(server.request("GET", f"/api/export/contours.json?structure={imported['id']}")[2])
    marks = [(contour.get("end"), contour.get("weight")) for plane in exported["planes"] for contour in plane["contours"]]
    assert marks.count(("flat", 0.5)) == 1 and marks.count((None, None)) == 2


def test_a_contour_can_be_told_to_be_the_end_and_how_far_it_counts(server):
    page = server.page()
    structure = the_structure(page)
    lower, middle, upper = draw_ball(page, structure)
    whole = page.wait_for_surface(structure)["volume_ml"]
    for contour in (lower, upper):
        assert page.do("contour.set", id=contour, end="flat")["contour"]["end"] == "flat"
    volumes = []
    while not volumes or volumes[-1] > 0.9 * whole:  # of the first one alone less is cut off
        volumes.append(page.wait_for_surface(structure)["volume_ml"])
    assert page.history["undo"] == "End at a contour"
    assert page.do("contour.set", id=middle, weight=0.01)["contour"]["weight"] == 0.01
    page.do("ping")
    assert page.history["undo"] == "Weight of a contour"
    assert page.refused("contour.set", id=middle, weight=0)["kind"] == "invalid_input"
    assert "end" not in page.do("contour.set", id=lower, hole=True)["contour"], "a hole is no end"
    assert page.refused("contour.set", id=lower, end="flat")["kind"] == "invalid_input"


def test_a_project_that_can_only_be_read_says_so_and_is_looked_at(server, tmp_path):
    page = server.page()
    draw_ball(page, the_structure(page))
    server.stop()
    server.project.chmod(0o444)
    if os.access(server.project, os.W_OK):
        pytest.skip("this user may write what nobody may")
    with running(tmp_path, server.project) as again:
        page = again.page()
        assert page.session["read_only"] and len(page.contours) == 3
        (note,) = (note for note in page.session["image"]["notes"] if "can only be read" in note)
        assert note.startswith(server.project.name)
        assert "read-only" in page.refused("structure.add")["message"]
        assert again.request("GET", "/api/export/project.kontur")[0] == 200


def test_every_format_that_the_page_is_told_of_can_be_imported(server, tmp_path):
    """Files of each, by the command line's writers or, where it has none, by the tests' own."""
    page = server.page()
    structure = the_structure(page)
    draw_ball(page, structure)
    for name in ("contours.json", "mask.nii.gz"):
        (tmp_path / name).write_bytes(server.request("GET", f"/api/export/{name}?structure={structure}")[2])
    support = pathlib.Path(__file__).parent.parent / "support"
    (tmp_path / "vtk").mkdir()
    subprocess.run([sys.executable, support / "make_vtk.py", tmp_path / "vtk"], check=True)
    subprocess.run([sys.executable, support / "make_rtstruct.py", "good", tmp_path / "a.dcm"], check=True)
    imports = page.session["imports"]
    for what, endings in (("contours", imports["contours"]), ("mask", imports["masks"])):
        for ending in endings:
            path = tmp_path / f"a{ending}"
            if ending in (".vtk", ".vtp"):
                path = sorted((tmp_path / "vtk").glob(f"*{ending}"))[0]
            elif not path.exists():
                source = tmp_path / ("contours.json" if what == "contours" else "mask.nii.gz")
                made = subprocess.run([KONTUR, "convert", source, path], capture_output=True, text=True)
                assert made.returncode == 0, made
            name = f"A{ending.upper()}"
            status, _, body = server.request("POST", f"/api/import/{what}?name={name}&planes=2&anyway=1", path.read_bytes())
            assert status == 200 and json.loads(body)["structures"], (name, body)
            assert page.do("undo")["label"].startswith("Import")
    for name in ("a.gipl", "a.hdr", "a.mhd"):
        status, _, body = server.request("POST", f"/api/import/mask?name={name}", b"")
        assert status == 415 and imports["masks"][-1] in json.loads(body)["error"]["message"]


def test_contours_that_may_not_belong_to_the_image_come_in_only_when_told_so(server):
    page = server.page()
    far = json.dumps(rings(31, 3, 20, x=900.0)).encode()
    before = len(page.structures)
    status, _, body = server.request("POST", "/api/import/contours?name=a.json", far)
    reply = json.loads(body)
    assert status == 200 and reply["structures"] == []
    assert len(reply["doubts"]) == 1 and "Rings lies" in reply["doubts"][0] and "mm outside of the image" in reply["doubts"][0]
    page.do("ping")
    assert len(page.structures) == before and page.history["undo"] is None
    status, _, body = server.request("POST", "/api/import/contours?name=a.json&anyway=1", far)
    assert status == 200 and json.loads(body)["doubts"] == [] and len(json.loads(body)["structures"]) == 1
    page.do("ping")
    assert [one["name"] for one in page.structures.values()] == ["Rings"], "in place of the one that waited to be drawn"
    assert page.do("undo")["label"] == "Import contours"


def test_contours_beside_the_image_are_named_when_both_are_opened(tmp_path, image):
    contours = tmp_path / "rings.json"
    contours.write_text(json.dumps(rings(31, 3, 20, x=900.0)))
    with running(tmp_path, image, contours) as server:
        (note,) = server.page().session["image"]["notes"]
        assert "Rings lies" in note and "outside of the image" in note


def test_a_structure_without_a_surface_has_an_empty_mesh(server):
    """It may go while it is asked for, which is no error."""
    page = server.page()
    for structure in (the_structure(page), 987654):
        head, arrays = server.binary("GET", f"/api/mesh/{structure}")
        assert head["stage"] == "none" and head["revision"] == 0 and head["structure"] == structure
        assert all(array.size == 0 for array in arrays.values())
    assert server.request("GET", "/api/mesh/x")[0] == 404


def test_nothing_is_told_of_a_structure_that_another_page_has_removed(server):
    """The page says what that means; of an error the browser would complain in its console."""
    page = server.page()
    there = the_structure(page)
    removed = page.do("structure.add")["structure"]["id"]
    page.do("structure.remove", id=removed)
    for target in (f"export/mask.nii.gz?structure={removed}", f"compare?first={there}&second={removed}", f"compare?first={removed}&second={there}"):
        assert server.request("GET", f"/api/{target}")[::2] == (204, b""), target
    for target in ("export/mask.nii.gz?structure=987654", f"compare?first={there}&second=987654"):
        assert server.request("GET", f"/api/{target}")[0] == 400, target


def test_a_mesh_tells_how_sure_it_is_where_that_is_asked_for_and_is_compressed_likewise(server):
    page = server.page()
    structure = the_structure(page)
    draw_ball(page, structure)
    page.wait_for_surface(structure)
    head, plain = server.binary("GET", f"/api/mesh/{structure}?coded=1")
    assert plain["half_widths"].size == 0 and head["points"] > 100
    _, widths = server.binary("GET", f"/api/mesh/{structure}?coded=1&widths=1")
    assert widths["half_widths"].size == head["points"] and widths["half_widths"].max() > 0
    _, headers, bytes_ = server.request("GET", f"/api/mesh/{structure}?coded=1&compressed=1")
    assert headers["Content-Encoding"] == "gzip"
    assert gzip.decompress(bytes_) == server.request("GET", f"/api/mesh/{structure}?coded=1")[2]


def test_where_a_contour_crosses_itself_is_told(server):
    page = server.page()
    plane = {**page.session["views"]["axial"]["plane"]}
    origin, u, v = (numpy.array(plane[key]) for key in ("origin", "u", "v"))
    corners = [(origin + x * u + y * v).tolist() for x, y in ((-6, -5), (6, 5), (6, -5), (-6, 5))]
    control = [{"at": at, "kind": "line"} for at in corners]
    contour = page.do("contour.add", structure=the_structure(page), plane={**plane, "mm_per_pixel": 1}, control=control)["contour"]
    (place,) = contour["self_crossings"]
    assert place == pytest.approx(origin.tolist(), abs=1e-9)
    assert page.contours[contour["id"]]["self_crossings"] == [place]
    assert server.page().contours[contour["id"]]["self_crossings"] == [place]
    straight = page.do("contour.move_point", id=contour["id"], index=1, to=(origin + 6 * u - 8 * v).tolist())["contour"]
    assert straight["self_crossings"] == [] and page.contours[contour["id"]]["self_crossings"] == []


def rings(z, count, points, radius=10.0, x=0.0):
    """A contour file of axial circles."""
    planes = [{"origin": [0, 0, z + k], "normal": [0, 0, 1], "u": [1, 0, 0], "v": [0, 1, 0]} for k in range(count)]
    for plane in planes:
        plane["contours"] = [{"closed": True, "hole": False, "points": ring(plane, radius, points, (x, 0.0))}]
    return {"version": 1, "frame": "LPS mm", "structure": "Rings", "planes": planes}


@pytest.mark.parametrize(
    "document, part",
    [(rings(31, 1, 100_001), "'points' has 100001 points; the limit is 100000"), (rings(31, 1, 20, x=2e6), "the limit is 1e+06 mm")],
    ids=["points", "far"],
)
def test_what_could_not_be_opened_again_is_refused(tmp_path, image, document, part):
    contours = tmp_path / "rings.json"
    contours.write_text(json.dumps(document))
    begun = subprocess.run([KONTUR, "open", image, contours, "--no-browser", "--timeout", "1"], capture_output=True, text=True)
    assert begun.returncode == 65 and "a contour of Rings cannot be kept" in begun.stderr and part in begun.stderr
    with running(tmp_path, image, "--project", tmp_path / "work.kontur") as server:
        page = server.page()
        status, _, body = server.request("POST", "/api/import/contours?name=a.json&anyway=1", contours.read_bytes())
        assert status == 400 and part in json.loads(body)["error"]["message"]
        ids = draw_ball(page, the_structure(page))
        assert "cannot be kept" in page.refused("contour.copy", id=ids[0], offset_mm=1e7)["message"]
        server.stop()
        with running(tmp_path, server.project) as again:
            assert again.page().contours == page.contours


def test_contours_that_cannot_be_read_leave_no_project_in_their_way(tmp_path, image):
    good = rings(31, 3, 20)
    bad = rings(31, 3, 2)
    contours, project = tmp_path / "mine.json", tmp_path / "mine.kontur"
    contours.write_text(json.dumps(bad))
    words = [KONTUR, "open", image, contours, "--no-browser", "--timeout", "1"]
    failed = subprocess.run(words, capture_output=True, text=True)
    assert failed.returncode == 65 and "2 points" in failed.stderr and not project.exists()
    with running(tmp_path, image, "--project", project) as server:
        server.stop(signal.SIGKILL)
    for statement in ("DELETE FROM structure", "DELETE FROM history"):  # as if killed before it was filled
        damage(project, statement)
    contours.write_text(json.dumps(good))
    with running(tmp_path, image, contours) as server:
        assert server.project == project and len(server.page().contours) == 3


def test_a_project_larger_than_what_may_wait_for_a_page_is_shown(tmp_path, image):
    """70 MiB in one message."""
    with running(tmp_path, image, "--project", tmp_path / "work.kontur") as server:
        status, _, body = server.request("POST", "/api/import/contours?name=a.json", json.dumps(rings(20, 1, 90_000)).encode())
        assert status == 200, body
        server.stop()
    with contextlib.closing(sqlite3.connect(server.project)) as database, database:
        ((first, row),) = database.execute("SELECT id, data FROM contour").fetchall()
        copies = [(n, row.replace(f'"id":{first},', f'"id":{n},')) for n in range(1000, 1000 + (70 << 20) // len(row))]
        database.executemany("INSERT INTO contour VALUES (?, ?)", copies)
        database.execute("UPDATE setting SET value = '5000' WHERE key = 'next_id'")
    with running(tmp_path, server.project) as again:
        page = again.page()
        assert len(page.contours) == 1 + len(copies) and page.do("ping") == {}


def big_mask(size=220):
    """A checkered mask of many voxels, which takes a while to trace."""
    index = numpy.indices((size, size, size)) // 20
    values = (index.sum(axis=0) % 2).astype(numpy.uint8)
    return nibabel.Nifti1Image(values, numpy.eye(4)).to_bytes()


def readers(server):
    """The processes in which the server reads imports, from where they have what is the server's no longer."""

    def reads(child):
        try:
            return b"--import-worker" in pathlib.Path(f"/proc/{child}/cmdline").read_bytes()
        except OSError:
            return False  # it has just ended

    tasks = pathlib.Path(f"/proc/{server.process.pid}/task")
    children = [int(child) for task in tasks.iterdir() for child in (task / "children").read_text().split()]
    return [child for child in children if reads(child)]


def damage(project, statement, *values):
    with contextlib.closing(sqlite3.connect(project)) as database, database:
        database.execute(statement, values)


def test_a_stored_page_that_no_page_can_have_saved_is_not_given_back(server, tmp_path):
    server.page().do("page.save", state={"layout": "big"})
    server.stop()
    for stored in ('{"layout": "big"}', "[" * 1_000_000 + "]" * 1_000_000, '{"a":', '"' + "x" * 70_000 + '"'):
        damage(server.project, "UPDATE setting SET value = ? WHERE key = 'page'", stored)
        with running(tmp_path, server.project) as again:
            assert again.page().session["page"] == ({"layout": "big"} if "big" in stored else None)


def wait_for(condition, seconds=60):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if found := condition():
            return found
        time.sleep(0.005)
    raise AssertionError("it did not happen")


def test_a_file_that_crashes_its_reader_costs_only_the_import(server):
    page = server.page()
    before = dict(page.structures)
    with concurrent.futures.ThreadPoolExecutor() as pool:
        reply = pool.submit(server.request, "POST", "/api/import/mask?name=m.nii&planes=200", big_mask())
        for reader in wait_for(lambda: readers(server)):
            limits = pathlib.Path(f"/proc/{reader}/limits")
            wait_for(lambda: re.search(r"Max cpu time +600 ", limits.read_text()))
            os.kill(reader, signal.SIGSEGV)
        status, _, body = reply.result()
    assert status == 422 and "did not foresee" in json.loads(body)["error"]["message"]
    assert page.do("ping") == {} and page.structures == before
    assert not list(server.folder.glob("kontur-*")), "nothing is left of the upload"


def send_import(server, connection, what, body):
    """A request whose answer nobody waits for."""
    head = (
        f"POST /api/import/{what} HTTP/1.1\r\nHost: {server.host}\r\nOrigin: http://{server.host}\r\n"
        f"Authorization: Bearer {server.token}\r\nContent-Length: {len(body)}\r\n\r\n"
    )
    connection.sendall(head.encode() + body)


def test_who_leaves_ends_what_was_read_for_him(server):
    with socket.create_connection(("127.0.0.1", server.port)) as connection:
        send_import(server, connection, "mask?name=m.nii&planes=200", big_mask())
        wait_for(lambda: readers(server))
    wait_for(lambda: not readers(server), seconds=5)
    wait_for(lambda: not list(server.folder.glob("kontur-*")), seconds=5)
    assert server.page().structures.keys() == {1}


def test_an_import_that_nobody_waits_for_any_more_is_not_applied(server):
    """Not either when its reader is through, and the server takes over what it has read."""
    page = server.page()
    body = json.dumps(rings(20, 6, 95_000)).encode()
    with socket.create_connection(("127.0.0.1", server.port)) as connection:
        send_import(server, connection, "contours?name=a.json", body)
        wait_for(lambda: readers(server))
        wait_for(lambda: not readers(server))
    while (event := page.receive())["event"] != "status" or event["text"]:
        pass  # until the end of "Importing"
    assert page.do("ping") == {} and server.page().structures.keys() == {1}


def test_what_a_killed_kontur_leaves_goes_with_the_next(server, tmp_path, image):
    with socket.create_connection(("127.0.0.1", server.port)) as connection:
        send_import(server, connection, "mask?name=m.nii&planes=200", big_mask())
        wait_for(lambda: readers(server))
        server.stop(signal.SIGKILL)
    (left,) = tmp_path.glob("kontur-*")
    assert (left / "upload.nii").exists()
    with running(tmp_path, image, "--project", tmp_path / "other.kontur"):
        assert not list(tmp_path.glob("kontur-*"))


@pytest.mark.parametrize("size", [(30000, 30000, 30), (2000, 2000, 2000)])
def test_a_file_that_declares_more_than_it_holds_costs_no_memory(server, size):
    header = nibabel.Nifti1Header()
    header.set_data_dtype(numpy.float32)
    header.set_data_shape(size)
    header["vox_offset"], header["magic"] = 352, b"n+1"
    header.set_sform(numpy.eye(4), 1)
    body = gzip.compress(header.binaryblock + b"\0" * 100_000)
    status, _, answer = server.request("POST", "/api/import/mask?name=m.nii.gz", body)
    assert status in (413, 422), answer
    peak = re.search(r"VmHWM:\s+(\d+)", pathlib.Path(f"/proc/{server.process.pid}/status").read_text())
    assert int(peak[1]) < 400_000  # KiB


def test_an_rtstruct_brings_every_region_that_has_contours(server, tmp_path):
    file = tmp_path / "plan.dcm"
    script = pathlib.Path(__file__).parent.parent / "support" / "make_rtstruct.py"
    subprocess.run([sys.executable, script, "good", file], check=True)
    page = server.page()
    asked = json.loads(server.request("POST", "/api/import/contours?name=plan.dcm", file.read_bytes())[2])
    assert asked["structures"] == [] and asked["doubts"]  # it was drawn on another image
    status, _, body = server.request("POST", "/api/import/contours?name=plan.dcm&anyway=1", file.read_bytes())
    assert status == 200, body
    page.do("ping")
    ids = json.loads(body)["structures"]
    names = {page.structures[i]["name"] for i in ids}
    assert {"plain", "nested", "keyhole"} <= names and "empty" not in names
    (plain,) = (page.structures[i] for i in ids if page.structures[i]["name"] == "plain")
    assert plain["color"] == "#0102ff" and plain["attributes"] == {"number": 1, "interpreted_type": "ORGAN"}
    contours = json.loads(server.request("GET", f"/api/export/contours.json?structure={plain['id']}")[2])
    assert (contours["color"], contours["interpreted_type"], contours["number"]) == ([1, 2, 255], "ORGAN", 1)
    assert page.do("undo")["label"] == "Import contours" and not set(ids) & page.structures.keys()


def test_a_project_that_cannot_be_told_turns_its_page_away_by_a_sentence(server, tmp_path):
    server.stop()
    damage(server.project, "DROP TABLE history")
    with running(tmp_path, server.project) as again:
        for _ in range(2):
            page = Page(again, greeted=False)
            told = page.receive()
            assert told["event"] == "notice" and told["level"] == "error" and "history" in told["text"]
            with pytest.raises(ConnectionError, match="1011"):
                page.receive()


def test_two_processes_on_one_project(server, tmp_path, image):
    second = subprocess.run(
        [KONTUR, "open", image, "--project", server.project, "--no-browser", "--timeout", "1"], capture_output=True, text=True
    )
    assert second.returncode == 74 and "is open in another kontur" in second.stderr


def test_a_full_disk_is_told_changes_nothing_and_passes(server):
    """By a limit on the size of files, which SQLite meets as it would a full disk."""
    page = server.page()
    structure = the_structure(page)
    ids = draw_ball(page, structure)
    before = dict(page.contours)
    full = server.project.stat().st_size
    resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (full, resource.RLIM_INFINITY))
    refusals = []
    plane = page.session["views"]["axial"]["plane"]
    for _ in range(30):
        reply = page.ask("contour.add", structure=structure, plane=plane, control=spline_controls(ring(plane, 9, 60)))
        if "error" in reply:
            refusals.append(reply["error"])
            break
    assert refusals and refusals[0]["kind"] == "io" and "cannot write" in refusals[0]["message"], refusals
    drawn = len(page.contours)
    resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    page.do("contour.remove", ids=[ids[0]])
    assert len(page.contours) == drawn - 1
    state = (page.structures, page.contours, page.history)
    server.stop(signal.SIGKILL)
    with running(server.folder, server.project) as again:
        reopened = again.page()
        assert (reopened.structures, reopened.contours, reopened.history) == state
        for _ in range(1 + drawn - len(before)):
            reopened.do("undo")
        assert reopened.contours == before


def test_a_place_that_cannot_be_written_is_told(tmp_path, image):
    for folder in ("/proc", tmp_path / "missing"):
        result = subprocess.run(
            [KONTUR, "open", image, "--project", pathlib.Path(folder) / "work.kontur", "--no-browser", "--timeout", "1"],
            capture_output=True, text=True,
        )
        assert result.returncode == 74 and "work.kontur" in result.stderr and result.stderr.count("\n") == 1, result.stderr


def test_a_project_refuses_another_image(server, tmp_path):
    server.page().do("structure.add")
    server.stop()
    result = subprocess.run(
        [KONTUR, "open", "phantom", "--project", server.project, "--no-browser", "--timeout", "1"], capture_output=True, text=True
    )
    assert result.returncode == 65 and "another image" in result.stderr


def test_a_project_alone_has_to_be_there(tmp_path, image):
    words = [KONTUR, "open", "--project", tmp_path / "work.kontur", "--no-browser", "--timeout", "1"]
    result = subprocess.run(words, capture_output=True, text=True)
    assert result.returncode == 65 and "is no project yet; name the image" in result.stderr
    with running(tmp_path, image, "--project", tmp_path / "work.kontur"):
        pass
    with running(tmp_path, "--project", tmp_path / "work.kontur") as server:
        assert server.page().session["title"] == image.name


def test_contours_come_with_the_image_and_the_project_lies_beside_them(tmp_path, image, server):
    page = server.page()
    draw_ball(page, the_structure(page))
    contours = tmp_path / "liver.json"
    contours.write_bytes(server.request("GET", f"/api/export/contours.json?structure={the_structure(page)}")[2])
    with running(tmp_path, image, contours) as other:
        assert other.project == tmp_path / "liver.kontur"
        opened = other.page()
        assert [c["points"] for c in opened.contours.values()] == [c["points"] for c in page.contours.values()]
        assert opened.do("undo")["label"] is None and opened.contours, "nobody undoes what he has not done"


def test_it_ends_when_asked(tmp_path, image):
    server = Server(tmp_path, image)
    assert server.project.parent == tmp_path / "data" / "kontur"
    assert server.stop(signal.SIGTERM) == 0
    idle = subprocess.run([KONTUR, "open", image, "--no-browser", "--timeout", "1", "--project", tmp_path / "i.kontur"], timeout=60)
    assert idle.returncode == 0


def test_the_browser_lives_on_and_nobody_else_learns_the_token(tmp_path, image):
    """By a stand-in for xdg-open, which keeps what it is told."""
    stand_in = tmp_path / "bin" / "xdg-open"
    stand_in.parent.mkdir()
    stand_in.write_text('#!/bin/sh\necho "$$ $*" > "$TMPDIR/told"\ncp "$1" "$TMPDIR/page"\nls -ld "$(dirname "$1")" > "$TMPDIR/mode.new"\nmv "$TMPDIR/mode.new" "$TMPDIR/mode"\nsleep 1\ntouch "$TMPDIR/ended"\n')
    stand_in.chmod(0o755)
    environment = {**os.environ, "PATH": f"{stand_in.parent}:{os.environ['PATH']}", "DISPLAY": ":9", "TMPDIR": str(tmp_path)}
    words = [KONTUR, "open", image, "--project", tmp_path / "work.kontur", "--token", "se'cret", "--timeout", "300"]
    server = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)
    try:
        address = server.stdout.readline().strip()
        wait_for((tmp_path / "mode").exists)
        browser, page = (tmp_path / "told").read_text().split(maxsplit=1)
        assert "cret" not in page and (tmp_path / "mode").read_text().startswith("drwx------")
        assert f"url={address}" in html.unescape((tmp_path / "page").read_text())
        assert os.getsid(int(browser)) == int(browser) != os.getsid(server.pid), "Ctrl+C does not reach it"
        wait_for((tmp_path / "ended").exists)
        wait_for(lambda: not pathlib.Path(f"/proc/{browser}").exists(), seconds=5)  # no zombie is left
        server.send_signal(signal.SIGINT)
        assert server.wait(60) == 0 and not list(tmp_path.glob("kontur-*"))
    finally:
        server.kill()
        server.communicate()


@pytest.mark.parametrize(
    "call, arguments, part",
    [
        ("contour.add", {"structure": 99, "control": []}, "'plane' is missing"),
        ("contour.move_point", {"id": 77, "index": 0, "to": [0, 0, 0]}, "no contour with the id 77"),
        ("structure.set", {"id": 1, "color": "red"}, "'color' is \"red\"; a colour"),
        ("structure.set", {"id": 1, "name": "x" * 101}, "'name' is a text of 101 characters; a text of at most 100"),
        ("value", {"at": [0, 0]}, "'at' is a list of 2; a point [x, y, z] is needed"),
        ("value", {"at": [0, 0, 1e300]}, "'at[2]' is 1e+300; a number from -1000000 to 1000000"),
        ("value", {"at": [0, 0, 0], "time": 1}, "there is no time 1: the last one is time 0"),
        ("structure.set", {"id": 1, "colour": "#e8b04a"}, "'colour' is not known here"),
        ("fly", {}, "no call 'fly'"),
        ("contour.remove", {"ids": [1.5]}, "'ids[0]' is 1.5; a whole number"),
    ],
)
def test_wrong_calls_are_refused_and_change_nothing(server, call, arguments, part):
    page = server.page()
    before = page.do("ping"), page.structures, page.contours, page.history
    error = page.refused(call, **arguments)
    assert error["kind"] == "invalid_input" and part in error["message"]
    assert before == (page.do("ping"), page.structures, page.contours, page.history)
