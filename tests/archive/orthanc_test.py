# SPDX-License-Identifier: Apache-2.0
"""Against Debian's Orthanc: images come by DICOMweb, results go back, are found again, and are what was sent."""
import json
import os
import pathlib

import nibabel
import numpy
import pydicom
import pytest
from support import Orthanc, kontur, make_series, running

REAL = "03_sarcoma_STS_002/CT/image"



@pytest.fixture(scope="module")
def files(tmp_path_factory):
    return make_series(tmp_path_factory.mktemp("series"))


@pytest.fixture(scope="module")
def orthanc(tmp_path_factory, files):
    with running(Orthanc(tmp_path_factory.mktemp("orthanc"))) as server:
        server.put(files)
        header = pydicom.dcmread(files[0], stop_before_pixels=True)
        server.study, server.series = header.StudyInstanceUID, header.SeriesInstanceUID
        server.study_address = f"{server.address}/studies/{server.study}"
        yield server


@pytest.fixture
def contours(tmp_path):
    """Three circles of 3.5 mm about a point that the images show."""
    angles = 2 * numpy.pi * numpy.arange(40) / 40
    planes = []
    for z in (107.5, 110.0, 112.5):
        ring = numpy.stack([3.5 * numpy.cos(angles) - 15, 3.5 * numpy.sin(angles) - 25, 0 * angles + z], -1)
        planes.append({"origin": [-15, -25, z], "normal": [0, 0, 1], "u": [1, 0, 0], "v": [0, 1, 0], "contours": [{"closed": True, "hole": False, "points": ring.tolist()}]})
    (tmp_path / "contours.json").write_text(json.dumps({"frame": "LPS mm", "structure": "ball", "planes": planes}))
    return tmp_path / "contours.json"


def run(*words, **more):
    result = kontur(*words, **more)
    assert result.returncode == 0, result
    return result


def found(*words):
    return json.loads(run("find", *words, "--json").stdout)


def test_studies_are_found_by_what_is_known_of_them(orthanc, files):
    (study,) = found(orthanc.address)
    header = pydicom.dcmread(files[0], stop_before_pixels=True)
    assert study["address"] == orthanc.study_address and study["modalities"] == ["CT"] and study["objects"] == 9
    assert study["patient_id"] == header.PatientID
    name, date = str(header.PatientName), study["date"]
    hits = ["--name", name[:3].lower()], ["--name", "*" + name[-3:]], ["--id", header.PatientID], ["--modality", "CT"]
    for words in (*hits, ["--date", f"{date}..{date}"], ["--date", date], ["--date", f"..{date}"]) if date else hits:
        assert found(orthanc.address, *words) == [study], words
    for words in (["--name", "nobody"], ["--id", "0000"], ["--modality", "MR"], ["--date", "..1900-01-01"]):
        assert found(orthanc.address, *words) == [], words
    assert "nothing found" in run("find", orthanc.address, "--name", "nobody").stdout
    (series,) = found(orthanc.study_address)
    assert series["series_uid"] == orthanc.series and series["objects"] == 9
    assert len(found(series["address"])) == 9


def test_a_series_comes_as_it_is_stored(tmp_path, orthanc, files):
    run("fetch", f"{orthanc.study_address}/series/{orthanc.series}", "-o", tmp_path / "out")
    sent = {pydicom.dcmread(file, stop_before_pixels=True).SOPInstanceUID: file.read_bytes() for file in files}
    assert {path.stem: path.read_bytes() for path in (tmp_path / "out").iterdir()} == sent


def test_an_address_in_place_of_the_images_gives_the_same_mask(tmp_path, orthanc, files, contours):
    local = run("segment", contours, "--image", files[0].parent, "-o", tmp_path / "local.nii.gz")
    remote = run("segment", contours, "--image", orthanc.study_address, "-o", tmp_path / "remote.nii.gz", cache=tmp_path / "cache")
    assert (tmp_path / "local.nii.gz").read_bytes() == (tmp_path / "remote.nii.gz").read_bytes()
    assert local.stdout.splitlines()[1:-1] == remote.stdout.splitlines()[1:-1]  # the last has the time
    folder = tmp_path / "cache/kontur/archive" / orthanc.address.split("/")[2].replace(":", "_") / orthanc.study / orthanc.series
    assert len(list(folder.iterdir())) == 9 and str(folder) in remote.stderr
    run("convert", f"{orthanc.study_address}/series/{orthanc.series}", tmp_path / "ct.nrrd", cache=tmp_path / "cache")
    assert (tmp_path / "ct.nrrd").stat().st_size > 0


def test_a_cohort_may_name_addresses(tmp_path, orthanc, contours):
    (tmp_path / "cases.csv").write_text(f"contours,image,output\n{contours},{orthanc.study_address},mask.nii.gz\n")
    run("batch", tmp_path / "cases.csv", cache=tmp_path / "cache")
    assert (tmp_path / "mask.nii.gz").stat().st_size > 0


def test_results_go_back_and_are_found_loaded_and_equal(tmp_path, orthanc, files, contours):
    seg, rtstruct = tmp_path / "seg.dcm", tmp_path / "rtstruct.dcm"
    run("segment", contours, "--image", orthanc.study_address, "-o", seg, "--rtstruct", rtstruct, "--series-description", "Ball, first reader", cache=tmp_path / "cache")
    sent = run("send", seg, rtstruct, "--archive", orthanc.address)
    assert sent.stdout.count("stored in " + orthanc.study_address) == 2 and sent.stderr == ""
    assert run("send", seg, rtstruct, "--archive", orthanc.address).stdout.count("was there already") == 2
    series = {one["modality"]: one for one in found(orthanc.study_address)}
    assert set(series) == {"CT", "SEG", "RTSTRUCT"} and series["SEG"]["description"] == "Ball, first reader"
    assert len(found(orthanc.address)) == 1 and len(found(orthanc.address, "--modality", "SEG")) == 1
    run("fetch", orthanc.study_address, "-o", tmp_path / "study")
    for file in (seg, rtstruct):
        (back,) = (tmp_path / "study" / series["SEG" if file == seg else "RTSTRUCT"]["series_uid"]).iterdir()
        assert back.read_bytes() == file.read_bytes()
    masks = []
    for word in (seg, series["SEG"]["address"]):
        run("convert", word, tmp_path / "mask.nii.gz", cache=tmp_path / "cache")
        masks.append(numpy.asarray(nibabel.load(tmp_path / "mask.nii.gz").dataobj))
    assert masks[0].any() and numpy.array_equal(*masks)
    (instance,) = found(series["RTSTRUCT"]["address"])
    run("convert", instance["address"], tmp_path / "again.json", cache=tmp_path / "cache")
    run("convert", rtstruct, tmp_path / "here.json")
    again, here = (json.loads((tmp_path / name).read_text())["planes"] for name in ("again.json", "here.json"))
    assert again == here
    result = kontur("segment", contours, "--image", orthanc.study_address, "-o", tmp_path / "mask2.nii.gz", cache=tmp_path / "cache")
    assert result.returncode == 0, "structure sets and segmentations are no second series of images"


def test_a_wrong_password_is_refused_and_a_right_one_let_in(tmp_path, files):
    with running(Orthanc(tmp_path, AuthenticationEnabled=True, RegisteredUsers={"reader": "pass:word"})) as server:
        refused = kontur("find", server.address, KONTUR_ARCHIVE_CREDENTIALS="reader:wrong-one")
        assert refused.returncode == 74 and "does not accept" in refused.stderr and "wrong-one" not in refused.stderr
        assert kontur("find", server.address).returncode == 74
        assert run("find", server.address, KONTUR_ARCHIVE_CREDENTIALS="reader:pass:word").stdout == "nothing found\n"


def test_a_real_series_comes_and_is_read_as_it_lies_on_the_disk(tmp_path, orthanc):
    folder = pathlib.Path(os.environ.get("KONTUR_TEST_DATA") or os.environ.get("KONTUR_TEST_DATA_DEFAULT", ""))
    images = sorted((folder / REAL).rglob("*.dcm"))
    if not images:
        pytest.skip(f"real data not found: {folder / REAL} (set KONTUR_TEST_DATA)")
    orthanc.put(images)
    header = pydicom.dcmread(images[0], stop_before_pixels=True)
    address = f"{orthanc.address}/studies/{header.StudyInstanceUID}/series/{header.SeriesInstanceUID}"
    run("convert", address, tmp_path / "remote.nrrd", cache=tmp_path / "cache")
    run("convert", images[0].parent, tmp_path / "local.nrrd")
    assert (tmp_path / "remote.nrrd").read_bytes() == (tmp_path / "local.nrrd").read_bytes()
