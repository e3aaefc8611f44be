# SPDX-License-Identifier: Apache-2.0
"""What a page of `kontur open --archive` is shown of a series while it comes."""
import importlib.util
import json
import pathlib
import time

import pydicom
import pytest
from misbehaving import PARTS
from support import Archive, make_series, running

spec = importlib.util.spec_from_file_location("viewer_support", pathlib.Path(__file__).parents[1] / "viewer/support.py")
viewer = importlib.util.module_from_spec(spec)
spec.loader.exec_module(viewer)


class Slow(Archive):
    """Sends a slice when `sent` is raised, and all of them at 9."""

    sent = 0

    def do_slow(self, handler, path):
        if not path.endswith(self.series):
            return False
        body = self.parts(self.objects.values())
        handler.send_response(200)
        handler.send_header("Content-Type", PARTS)
        handler.send_header("Content-Length", str(len(body)))
        handler.end_headers()
        size = -(-len(body) // 18)  # halves of a slice, so that each is ended by the next one's beginning
        for n in range(18):
            while self.sent < n // 2:
                time.sleep(0.02)
            handler.wfile.write(body[n * size : (n + 1) * size])
            time.sleep(0.1)
        return True


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    return make_series(tmp_path_factory.mktemp("series"))


def places(files):
    """Along the normal of each slice, mm."""
    found = []
    for file in files:
        header = pydicom.dcmread(file, stop_before_pixels=True)
        row, column = header.ImageOrientationPatient[:3], header.ImageOrientationPatient[3:]
        normal = [row[(n + 1) % 3] * column[(n + 2) % 3] - row[(n + 2) % 3] * column[(n + 1) % 3] for n in range(3)]
        found.append(sum(a * b for a, b in zip(normal, header.ImagePositionPatient)))
    return sorted(found)


def arriving(server, query=""):
    status, _, data = server.request("GET", f"/api/archive/arriving{query}")
    assert status in (200, 204), data
    return server.parts(data) if status == 200 else None


def until_more_than(server, count):
    """The reply once so many slices are here; they are told while more come."""
    end = time.monotonic() + 30
    while time.monotonic() < end:
        if (reply := arriving(server)) and reply[0]["slices"] > count:
            return reply
        time.sleep(0.05)
    raise AssertionError("no more slices came")


def test_slices_are_shown_as_they_come_until_the_image_is_open(tmp_path, files):
    with running(Slow(files)) as archive:
        archive.fault = "slow"
        server = viewer.Server(tmp_path, "--archive", archive.address, HOME=str(tmp_path), XDG_CACHE_HOME=str(tmp_path / "cache"))
        assert arriving(server) is None
        request = json.dumps({"study": archive.study, "series": archive.series, "title": "slow"}).encode()
        assert server.request("POST", "/api/archive/open", request)[0] == 200
        all_places, seen = places(files), 0
        for archive.sent in (2, 4, 6):
            head, arrays = until_more_than(server, seen)
            seen = head["slices"]
            assert 0 < seen <= 9 and len(arrays["pixels"]) == head["width"] * head["height"] and max(head["width"], head["height"]) == 384
            for name in ("at_mm", "first_mm", "last_mm"):
                assert min(abs(head[name] - place) for place in all_places) < 1e-6
            chosen = arriving(server, f"?at_mm={head['first_mm'] - 100}")[0]
            assert chosen["at_mm"] == chosen["first_mm"] <= head["first_mm"]
        assert server.request("GET", "/api/archive/arriving?at_mm=near")[0] == 400
        archive.sent = 9
        end = time.monotonic() + 30
        while arriving(server) and time.monotonic() < end:
            time.sleep(0.05)
        assert arriving(server) is None, "nothing is on its way any more"
        assert server.stop() == 0
