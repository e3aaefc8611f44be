# SPDX-License-Identifier: Apache-2.0
"""kontur open with nothing to open, or not yet: what a page is told and may ask for."""
import json
import pathlib
import signal
import subprocess
import time
import urllib.parse

import nibabel
import numpy
import pytest
from support import KONTUR, Page, Server, running, write_image

CHOOSE = "choose an image or a project in the page; Ctrl+C ends"


@pytest.fixture
def home(tmp_path):
    folder = tmp_path / "home"
    (folder / "scans").mkdir(parents=True)
    write_image(folder / "scans" / "ball.nii.gz")
    return folder


def get(server, what, **query):
    status, _, body = server.request("GET", f"/api/{what}?{urllib.parse.urlencode(query)}")
    return status, json.loads(body)


def ask(server, what, **body):
    status, _, reply = server.request("POST", f"/api/{what}", json.dumps(body).encode())
    return status, json.loads(reply)


def wait_for(page, event):
    """The first such event; what was told before is dropped."""
    while (told := page.receive())["event"] != event:
        assert told["event"] in ("opening", "status", "surface", "notice", "outlines"), told
    return told


def test_without_words_the_page_chooses(tmp_path, home):
    with running(tmp_path, HOME=str(home)) as server:
        assert str(server.project) == CHOOSE.split(";")[0]
        page = Page(server)
        start = page.greeting
        assert start["event"] == "start" and start["recent"] == [] and start["opening"] is None
        assert [place["path"] for place in start["places"] if place["name"] == "Home"] == [str(home)]
        status, listed = get(server, "folder", path=home / "scans")
        assert status == 200 and [file["name"] for file in listed["files"]] == ["ball.nii.gz"]
        assert page.ask("undo")["error"]["message"] == "no image is open"
        assert page.do("ping") == {}
        assert ask(server, "open", path=listed["files"][0]["path"]) == (200, {})
        wait_for(page, "opened")
        session = Page(server).greeting
        assert session["event"] == "session" and session["title"] == "ball.nii.gz"
        assert ask(server, "open", path=listed["files"][0]["path"])[1]["error"]["message"] == "an image is open; close it first"
        assert ask(server, "close") == (200, {})
        wait_for(page, "closed")
        (recent,) = Page(server).greeting["recent"]
        assert recent["title"] == "ball.nii.gz" and pathlib.Path(recent["path"]).is_file()
        assert page.ask("structure.add")["error"]["message"] == "no image is open"
        of_then = {"Kontur-Opening": session["opening"]}
        plane = {"origin": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0], "normal": [0, 0, 1], "mm_per_pixel": 1}
        slice_ = json.dumps({"view": "axial", "plane": plane, "width": 8, "height": 8, "pixels": False}).encode()
        for method, target, body in (
            ("POST", "/api/slice", slice_),
            ("GET", "/api/mesh/1?coded=1", None),
            ("GET", "/api/statistics", None),
            ("GET", "/api/compare?first=1&second=2", None),
            ("GET", "/api/export/labels.nrrd", None),
        ):
            status, _, reply = server.request(method, target, body, of_then)
            assert (status, reply) == (204, b""), "a page that has not heard yet that it is closed: nothing, and no error in its console"
            assert server.request(method, target, body)[0] == 400, "who names no session means the one that is open"


def test_an_image_that_cannot_be_opened_is_told_and_leaves_no_project(tmp_path, home):
    (home / "scans" / "broken.nii").write_bytes(b"no image")
    with running(tmp_path, HOME=str(home)) as server:
        page = Page(server)
        assert ask(server, "open", path=str(home / "scans" / "broken.nii"))[0] == 200
        assert "broken.nii" in wait_for(page, "failed")["error"]["message"]
        assert "broken.nii" in Page(server).greeting["sentence"]
        assert not list((tmp_path / "data").rglob("*.kontur"))


def test_a_missing_image_of_a_recent_project_is_told(tmp_path, home):
    with running(tmp_path, home / "scans" / "ball.nii.gz", HOME=str(home)):
        pass
    (home / "scans" / "ball.nii.gz").unlink()
    with running(tmp_path, HOME=str(home)) as server:
        page = Page(server)
        (recent,) = page.greeting["recent"]
        assert ask(server, "open", path=recent["path"])[0] == 200
        assert "ball.nii.gz" in wait_for(page, "failed")["error"]["message"]


def big_image(path):
    """Takes longer to read than the terminal may be silent."""
    values = numpy.random.default_rng(1).integers(-1000, 1000, (420, 420, 420), dtype=numpy.int16)
    nibabel.save(nibabel.Nifti1Image(values, numpy.eye(4)), path)


def test_the_page_is_there_before_a_large_image_and_sees_how_far_it_is(tmp_path, home):
    big_image(home / "big.nii.gz")
    with_words = [home / "big.nii.gz", "--project", tmp_path / "big.kontur"]
    process = subprocess.Popen([KONTUR, "open", *map(str, with_words), "--no-browser", "--token", "secret", "--timeout", "300"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        begun = time.monotonic()
        address = process.stdout.readline()
        told_after = time.monotonic() - begun
        server = Server.of(process, address, "secret")
        page = Page(server)
        greeting = page.greeting
        assert told_after < 5
        fractions = []
        if greeting["event"] == "start":
            assert greeting["opening"]["title"] == "big.nii.gz"
            while (event := page.receive())["event"] == "opening":
                fractions.append(event["fraction"])
            assert event["event"] == "opened"
            assert fractions == sorted(fractions)
            assert len(fractions) > 3 or greeting["opening"]["fraction"] > 0.5  # the page came late
        assert process.stdout.readline().startswith(f"project {tmp_path / 'big.kontur'};")
        assert Page(server).greeting["event"] == "session"
    finally:
        process.send_signal(signal.SIGINT)
        assert process.wait(60) == 0


def test_ctrl_c_while_reading_ends_as_interrupted(tmp_path, home):
    big_image(home / "big.nii.gz")
    process = subprocess.Popen([KONTUR, "open", home / "big.nii.gz", "--no-browser", "--project", tmp_path / "big.kontur"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    process.stdout.readline()
    process.send_signal(signal.SIGINT)
    _, complaint = process.communicate(timeout=60)
    assert process.returncode in (0, 130)  # 0: it had just been read
    assert process.returncode == 0 or (complaint == "kontur: error: interrupted; nothing was written\n" and not (tmp_path / "big.kontur").exists())
