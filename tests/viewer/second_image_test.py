# SPDX-License-Identifier: Apache-2.0
"""A second image in kontur open: from the page and from the command line, kept with the project, and refused where it does not fit."""
import json
import pathlib
import shutil
import subprocess
import sys

import nibabel
import numpy
import pydicom
import pytest
from support import KONTUR, Page, running, write_image

SUPPORT = pathlib.Path(__file__).parents[1] / "support"
NO_SUV = "Values stay in Bq/ml, since SUV cannot be told: CorrectedImage (0028,0051) is missing."


def write_pet(path, shift_mm=0.0, frames=None):
    """5 in a ball where that of `write_image` is, on a coarser grid without its turn."""
    affine = numpy.diag([3.0, 3.0, 3.0, 1.0])
    affine[:3, 3] = (-60 + shift_mm, -60, -30)
    index = numpy.stack(numpy.meshgrid(*(numpy.arange(40) for _ in range(3)), indexing="ij"), -1)
    middle = numpy.linalg.inv(affine) @ affine @ (20, 20, 20, 1)
    values = numpy.where(numpy.linalg.norm((index - middle[:3]) * 3, axis=-1) < 15, 5, 0).astype(numpy.float32)
    if frames:
        values = numpy.stack([values] * frames, -1)
    nibabel.save(nibabel.Nifti1Image(values, affine), path)


@pytest.fixture
def home(tmp_path):
    folder = tmp_path / "home"
    folder.mkdir()
    write_image(folder / "ct.nii.gz")
    write_pet(folder / "pet.nii.gz")
    return folder


@pytest.fixture(scope="module")
def pet_and_ct(tmp_path_factory):
    """CT, PET and an old PET as DICOM folders; the old one lies in another frame of reference."""
    folder = tmp_path_factory.mktemp("study")
    subprocess.run([sys.executable, SUPPORT / "make_dicom_series.py", "axial", folder / "made"], check=True)
    shutil.move(folder / "made" / "dicom", folder / "ct")
    for name, frame in (("pet", None), ("old", "1.2.826.0.1.3680043.8.498.1")):
        (folder / name).mkdir()
        series = pydicom.uid.generate_uid(entropy_srcs=[name])
        for number, file in enumerate(sorted((folder / "ct").iterdir())):
            d = pydicom.dcmread(file)
            d.Modality, d.Units, d.SeriesDescription = "PT", "BQML", f"{name} image"
            d.SeriesInstanceUID, d.SOPInstanceUID = series, pydicom.uid.generate_uid(entropy_srcs=[name, str(number)])
            d.file_meta.MediaStorageSOPInstanceUID = d.SOPInstanceUID
            d.FrameOfReferenceUID = frame or d.FrameOfReferenceUID
            d.save_as(folder / name / f"{number}.dcm", write_like_original=False)
    return folder


def add(server, path, **more):
    status, _, reply = server.request("POST", "/api/image", json.dumps({"image": 1, "path": str(path), **more}).encode())
    return status, json.loads(reply)


def images_of(server):
    return Page(server).session["images"]


def test_a_page_adds_one_and_all_pages_are_told(tmp_path, home):
    with running(tmp_path, home / "ct.nii.gz", HOME=str(home)) as server:
        page = Page(server)
        assert page.session["images"] == [] and page.session["folder"] == str(home)
        assert str(home) in [place["path"] for place in page.session["places"]]
        assert add(server, home / "pet.nii.gz") == (200, {})
        while (event := page.receive())["event"] != "images":
            assert event["event"] in ("status", "surface")
        (pet,) = event["images"]
        assert (pet["image"], pet["title"], pet["size"]) == (1, "pet.nii.gz", [40, 40, 40])
        assert pet["notes"] == ["Neither ct.nii.gz nor pet.nii.gz names a frame of reference: both are taken to lie in one patient space."]
        assert page.do("value", at=[0, 0, 0])["values"][1] is not None
        page.do("image.remove", image=1)
        assert images_of(server) == []
        assert len(page.do("value", at=[0, 0, 0])["values"]) == 1


def test_what_was_passed_over_in_its_folder_is_told_once_and_does_not_stay_with_it(tmp_path, pet_and_ct):
    (pet_and_ct / "pet" / "readme.txt").write_text("hello")
    try:
        with running(tmp_path, pet_and_ct / "ct", HOME=str(pet_and_ct)) as server:
            page = Page(server)
            assert add(server, pet_and_ct / "pet") == (200, {})
            events = []
            while not events or events[-1]["event"] != "images":
                events.append(page.receive())
            assert "left out 1 file (not a DICOM file): readme.txt" in [event["text"] for event in events if event["event"] == "notice"]
            assert events[-1]["images"][0]["notes"] == [NO_SUV]
    finally:
        (pet_and_ct / "pet" / "readme.txt").unlink()


def test_it_is_there_again_with_the_project_and_its_frame(tmp_path, home):
    write_pet(home / "beating.nii.gz", frames=3)
    project = tmp_path / "work.kontur"
    with running(tmp_path, home / "ct.nii.gz", "--project", project, HOME=str(home)) as server:
        status, reply = add(server, home / "beating.nii.gz")
        assert status == 415 and reply["error"]["frames"] == 3, "a page asks which one"
        assert add(server, home / "beating.nii.gz", frame=1)[0] == 200
    with running(tmp_path, project, HOME=str(home)) as server:
        assert [image["title"] for image in images_of(server)] == ["beating.nii.gz"]
    (home / "beating.nii.gz").rename(home / "elsewhere.nii.gz")
    for _ in range(2):  # it is missed, and waited for
        with running(tmp_path, project, HOME=str(home)) as server:
            session = Page(server).session
            assert session["images"] == []
            assert any(note.startswith("The second image is not shown: ") and "beating.nii.gz" in note for note in session["image"]["notes"])
    (home / "elsewhere.nii.gz").rename(home / "beating.nii.gz")
    with running(tmp_path, project, HOME=str(home)) as server:
        assert len(images_of(server)) == 1
        Page(server).do("image.remove", image=1)
    with running(tmp_path, project, HOME=str(home)) as server:
        assert images_of(server) == []


def test_one_that_has_changed_since_is_shown_and_said(tmp_path, home):
    project = tmp_path / "work.kontur"
    with running(tmp_path, home / "ct.nii.gz", "--second-image", home / "pet.nii.gz", "--project", project):
        pass
    write_pet(home / "pet.nii.gz", shift_mm=4)
    with running(tmp_path, project) as server:
        session = Page(server).session
        assert len(session["images"]) == 1
        assert "The second image, pet.nii.gz, has changed since it was added to this project." in session["image"]["notes"]


def test_what_does_not_fit_is_refused_in_one_sentence(tmp_path, home):
    write_pet(home / "far.nii.gz", shift_mm=500)
    (home / "broken.nii").write_bytes(b"this is no image")
    (tmp_path / "outside").mkdir()
    write_pet(tmp_path / "outside" / "pet.nii.gz")
    with running(tmp_path, home / "ct.nii.gz", HOME=str(home)) as server:
        for path, status, part in [
            (home / "far.nii.gz", 400, "far.nii.gz and ct.nii.gz do not meet: they lie "),
            (home / "broken.nii", 422, "broken.nii"),
            (home / "none.nii", 404, "none.nii"),
            (tmp_path / "outside" / "pet.nii.gz", 400, "lies outside of the folders that this page may open"),
        ]:
            told, reply = add(server, path)
            assert (told, part in reply["error"]["message"]) == (status, True), reply
        assert add(server, home / "pet.nii.gz", image=2)[1]["error"]["message"] == "'image' is 2; a whole number from 1 to 1 is needed"
        assert images_of(server) == []


def test_dicom_images_of_one_frame_of_reference_need_no_assumption(tmp_path, pet_and_ct):
    with running(tmp_path, pet_and_ct / "ct", "--second-image", pet_and_ct / "pet") as server:
        (pet,) = images_of(server)
        assert (pet["notes"], pet["unit"], pet["emission"], pet["identity"]["modality"]) == ([NO_SUV], "Bq/ml", True, "PT")
        window = pet["window"]
        assert window["center"] == pytest.approx(window["width"] / 2)


def command(*words):
    return subprocess.run([KONTUR, "open", *map(str, words), "--no-browser", "--timeout", "1"], capture_output=True, text=True, timeout=120)


def test_the_command_refuses_what_does_not_fit_and_leaves_no_project(tmp_path, home, pet_and_ct):
    project = tmp_path / "new.kontur"
    for second, part in [
        ([pet_and_ct / "old"], "has another frame of reference (1.2.826.0.1.3680043.8.498.1) than"),
        ([home / "none.nii"], "none.nii"),
        ([pet_and_ct], "several series"),
    ]:
        ended = command(pet_and_ct / "ct", "--second-image", *second, "--project", project)
        assert ended.returncode != 0 and "--second-image: " in ended.stderr and part in ended.stderr and ended.stderr.count("\n") == 1, ended.stderr
        assert not project.exists()
    alone = command(pet_and_ct / "ct", "--second-frame", 1, "--project", project)
    assert alone.returncode == 64 and "--second-image" in alone.stderr and not project.exists()


def test_one_series_of_a_folder_is_chosen_by_its_uid(tmp_path, pet_and_ct):
    series = pydicom.dcmread(next((pet_and_ct / "pet").iterdir())).SeriesInstanceUID
    project = tmp_path / "work.kontur"
    with running(tmp_path, pet_and_ct / "ct", "--second-image", pet_and_ct, "--second-series", series, "--project", project) as server:
        assert images_of(server)[0]["identity"]["series_description"] == "pet image"
    with running(tmp_path, project) as server:
        assert images_of(server)[0]["identity"]["series_description"] == "pet image"
