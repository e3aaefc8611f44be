# SPDX-License-Identifier: Apache-2.0
"""Images with several volumes in time: one is drawn on, the others are looked at."""
import json
import pathlib
import subprocess
import sys

import nibabel
import numpy
import pydicom
from support import KONTUR, Page, ring, running

SUPPORT = pathlib.Path(__file__).parents[1] / "support"
sys.path.append(str(SUPPORT))
import make_dicom_series as dicom


def write_beating(path, frames=4):
    values = numpy.zeros((20, 18, 16, frames), numpy.int16)
    for time in range(frames):
        values[..., time] = 100 * time + numpy.arange(20)[:, None, None]
    nibabel.save(nibabel.Nifti1Image(values, numpy.diag([2.0, 2.0, 2.0, 1.0])), path)


def value(page, **more):
    return page.do("value", at=[-6, -10, 12], **more)["values"][0]  # voxel 3, 5, 6 in LPS


def slice_values(server, **more):
    plane = {"origin": [-6, -10, 12], "u": [1, 0, 0], "v": [0, 1, 0], "normal": [0, 0, 1], "mm_per_pixel": 2}
    body = {"plane": plane, "width": 1, "height": 1, "pixels": "values", **more}
    head, _ = server.binary("POST", "/api/slice", json.dumps(body).encode())
    return head["values"]["first"]


def test_other_times_of_a_file_are_seen_while_one_is_drawn_on(tmp_path):
    write_beating(tmp_path / "beating.nii.gz")
    with running(tmp_path, tmp_path / "beating.nii.gz", "--frame", "3") as server:
        page = Page(server)
        image = page.session["image"]
        assert (image["times"], image["time"]) == (4, 2)
        assert value(page) == 203 and slice_values(server) == 203
        for time in (0, 3, 2, 0):
            assert value(page, time=time) == 100 * time + 3
            assert slice_values(server, time=time) == 100 * time + 3
        status, _, reply = server.request("POST", "/api/slice", json.dumps({"plane": {"origin": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0], "normal": [0, 0, 1], "mm_per_pixel": 1}, "width": 1, "height": 1, "pixels": "values", "time": 4}).encode())
        assert status == 400 and "there is no time 4: the last one is time 3" in reply.decode()


def test_a_second_image_of_as_many_volumes_moves_in_time_with_the_first(tmp_path):
    home = tmp_path / "home"
    home.mkdir()
    for name, frames in (("first", 4), ("second", 4), ("other", 3)):
        write_beating(home / f"{name}.nii.gz", frames)
    with running(tmp_path, home / "first.nii.gz", "--frame", "3", HOME=str(home)) as server:
        page = Page(server)

        def both(**more):
            return page.do("value", at=[-6, -10, 12], **more)["values"]

        for name, frame, moves in (("second", 2, True), ("second", 1, False), ("other", 2, False)):
            body = {"image": 1, "path": str(home / f"{name}.nii.gz"), "frame": frame}
            assert server.request("POST", "/api/image", json.dumps(body).encode())[0] == 200
            own = 100 * frame + 3
            assert both() == [203, own] and slice_values(server, image=1) == own
            assert both(time=0) == [3, 3 if moves else own]
            assert slice_values(server, image=1, time=0) == 3


def test_a_file_of_one_volume_has_one_time(tmp_path):
    write_beating(tmp_path / "still.nii.gz", frames=1)
    for words in ([], ["--frame", "1"]):
        with running(tmp_path, tmp_path / "still.nii.gz", *words) as server:
            image = Page(server).session["image"]
            assert (image["times"], image["time"]) == (1, 0)


def test_volumes_of_a_series_are_its_times(tmp_path):
    subprocess.run([sys.executable, SUPPORT / "make_dicom_series.py", "echoes", tmp_path / "made"], check=True)
    folder = tmp_path / "made" / "dicom"
    values = []
    for volume in (1, 2):
        with running(tmp_path, folder, "--volume", str(volume), "--project", tmp_path / f"{volume}.kontur") as server:
            page = Page(server)
            image = page.session["image"]
            assert (image["times"], image["time"]) == (2, volume - 1)
            values.append([page.do("value", at=image["center"], **more)["values"][0] for more in ({}, {"time": 0}, {"time": 1})])
    (own, first, second), (own_of_second, *others) = values
    assert own == first and own_of_second == second and others == [first, second]
    assert first != second


def test_series_that_are_phases_are_times_of_each_other(tmp_path):
    dicom.write_phases(tmp_path / "breath", 5, 9, 2.0, -8.0)
    uids = {}
    for file in (tmp_path / "breath").iterdir():
        slice_ = pydicom.dcmread(file)
        uids[slice_.SeriesDescription] = slice_.SeriesInstanceUID
    with running(tmp_path, tmp_path / "breath", "--series", uids["P4 Gated, 40.0%"], "--project", tmp_path / "a.kontur") as server:
        page = Page(server)
        image = page.session["image"]
        assert (image["times"], image["time"], page.session["cycle_frames"]) == (5, 2, 5)
        seen = [page.do("value", at=image["center"], **more)["values"][0] for more in ({}, *({"time": time} for time in range(5)))]
        assert [shade + 1024 for shade in seen] == [2, 0, 1, 2, 3, 4]


def test_contours_of_a_structure_set_are_of_the_time_whose_slices_they_refer_to(tmp_path):
    dicom.write_cine(tmp_path / "cine", 8, 9, 2.0, -8.0)
    dicom.write_phases(tmp_path / "breath", 5, 9, 2.0, -8.0)
    uids = {pydicom.dcmread(file).SeriesDescription: pydicom.dcmread(file).SeriesInstanceUID for file in (tmp_path / "breath").iterdir()}
    planes = []
    for z in (-2.0, 2.0):
        plane = {"origin": [0, 0, z], "normal": [0, 0, 1], "u": [1, 0, 0], "v": [0, 1, 0]}
        planes.append({**plane, "contours": [{"closed": True, "hole": False, "points": [list(p) for p in ring(plane, 5, 40)]}]})
    (tmp_path / "drawn.json").write_text(json.dumps({"frame": "LPS mm", "structure": "ball", "planes": planes}))
    for folder, drawn, opened, time in (("cine", ("--volume", "3"), ("--volume", "1"), 2),
                                        ("breath", ("--series", uids["P4 Gated, 40.0%"]), ("--series", uids["P4 Gated, 0.0%"]), 2)):
        subprocess.run([KONTUR, "convert", tmp_path / "drawn.json", tmp_path / f"{folder}.dcm", "--image", tmp_path / folder, *drawn], check=True)
        with running(tmp_path, tmp_path / folder, *opened, "--project", tmp_path / f"{folder}.kontur") as server:
            page = Page(server)
            status, _, reply = server.request("POST", f"/api/import/contours?name={folder}.dcm&as=contours", (tmp_path / f"{folder}.dcm").read_bytes())
            assert status == 200 and len(json.loads(reply)["structures"]) == 1, reply
            page.do("ping")
            assert [contour["time"] for contour in page.contours.values()] == [time, time]


def test_the_files_of_a_folder_are_times_of_each_other(tmp_path):
    folder = tmp_path / "frames"
    folder.mkdir()
    for name, value_ in (("b 10", 2), ("b 9", 1), ("a 1", 0)):
        nibabel.save(nibabel.Nifti1Image(numpy.full((20, 18, 16), value_, numpy.int16), numpy.diag([2.0, 2.0, 2.0, 1.0])), folder / f"{name}.nii.gz")
    with running(tmp_path, folder, "--frame", "2", "--project", tmp_path / "a.kontur") as server:
        page = Page(server)
        assert (page.session["image"]["times"], page.session["image"]["time"]) == (3, 1)
        assert [value(page, time=time) for time in range(3)] == [0, 1, 2]


def test_the_tags_of_a_gated_series_tell_the_cycle_until_somebody_says_otherwise(tmp_path):
    dicom.write_cine(tmp_path / "cine", 8, 9, 2.0, -8.0)
    with running(tmp_path, tmp_path / "cine", "--volume", "3", "--project", tmp_path / "a.kontur") as server:
        page = Page(server)
        assert (page.session["image"]["times"], page.session["image"]["time"]) == (8, 2)
        assert page.session["cycle_frames"] == 8
        page.do("cycle.set", repeats=False)
    with running(tmp_path, tmp_path / "cine", "--volume", "3", "--project", tmp_path / "a.kontur") as server:
        assert Page(server).session["cycle_frames"] == 0
