# SPDX-License-Identifier: Apache-2.0
"""find, fetch, send and segment against an archive that misbehaves: one sentence, a documented exit code, nothing half on the disk."""
import os
import signal
import subprocess
import time
import urllib.request

import pydicom
import pytest
from misbehaving import CORRUPT, FAULTS, INPUT, IO, STOPPED, STOW_FAULTS, Hostile, made_file
from support import KONTUR, Archive, certificate, context_of, kontur, make_series, running


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    return make_series(tmp_path_factory.mktemp("series"))


@pytest.fixture
def archive(files):
    with running(Hostile(files)) as server:
        yield server


def one_sentence(result, code, *words):
    """The program ended with this code and one sentence that has these words, and that gives no secret away."""
    lines = result.stderr.splitlines()
    assert result.returncode == code and lines and lines[-1].startswith("kontur: error: "), result
    for word in words:
        assert word in lines[-1], (word, lines[-1])
    assert "secret" not in result.stdout + result.stderr, result
    return lines[-1]


@pytest.mark.parametrize("counts", [True, False])
def test_without_a_fault_a_series_comes_byte_for_byte(tmp_path, archive, counts):
    archive.counts = counts
    result = kontur("fetch", archive.series_address, "-o", tmp_path / "out")
    assert (result.returncode, result.stderr) == (0, ""), result
    arrived = {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()}
    assert arrived == {uid + ".dcm": data for uid, data in archive.objects.items()} and len(arrived) == 9
    pages = sum(path.endswith("/instances") for _, path, _ in archive.requests)
    assert pages == (0 if counts else 4), "of four each, until one is empty, where the archive does not say how many objects there are"
    before = len(archive.requests)
    assert kontur("fetch", archive.series_address, "-o", tmp_path / "out").returncode == 0
    assert all(path.endswith("/instances") for _, path, _ in archive.requests[before:]), "what is whole is not fetched again"


@pytest.mark.parametrize(("fault", "code", "words"), FAULTS)
def test_each_fault_is_one_sentence_and_leaves_nothing_half(tmp_path, archive, fault, code, words):
    with running(Archive()) as other:
        archive.elsewhere, archive.fault = f"http://127.0.0.1:{other.port}", fault
        one_sentence(kontur("fetch", archive.series_address, "-o", tmp_path / "out", "--give-up-s", 2), code, words)
        assert other.requests == [], "another host is never asked"
    assert not (tmp_path / "out").exists()
    for path in (tmp_path / "out.part").glob("*"):
        assert path.read_bytes() == archive.objects[path.stem], "what is there is whole"


@pytest.mark.parametrize("fault", ["401", "404", "early", "wrong-border", "slow", "html"])
def test_segment_makes_nothing_of_a_series_that_does_not_come(tmp_path, archive, fault):
    archive.fault = fault
    (tmp_path / "contours.json").write_text('{"frame": "LPS mm", "planes": []}')
    result = kontur("segment", tmp_path / "contours.json", "--image", archive.series_address, "-o", tmp_path / "mask.nii.gz", "--give-up-s", 2, cache=tmp_path / "cache")
    assert result.returncode in (INPUT, CORRUPT, IO), result
    assert "Traceback" not in result.stderr and not (tmp_path / "mask.nii.gz").exists()
    assert [path for path in (tmp_path / "cache").rglob(archive.series)] == []


@pytest.mark.parametrize(("counts", "first"), [(True, 1), (True, 301), (False, 1)])
def test_a_picture_is_of_the_middle_and_needs_no_list_where_objects_count_from_one(tmp_path, archive, counts, first):
    """Archives take seconds to list 600 objects."""
    archive.counts, archive.first_number = counts, first
    command = [KONTUR, "open", "--archive", archive.address, "--no-browser", "--token", "secret", "--timeout", "60"]
    environment = {name: value for name, value in os.environ.items() if "proxy" not in name.lower()} | {"XDG_DATA_HOME": str(tmp_path)}
    viewer = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment)
    page = viewer.stdout.readline().strip().split("#")[0].rstrip("/")
    host = page.removeprefix("http://").split("/")[0]
    asked = urllib.request.Request(f"http://{host}/api/archive/picture?study={archive.study}&series={archive.series}",
                                   headers={"Origin": f"http://{host}", "Authorization": "Bearer secret"})
    with urllib.request.build_opener(urllib.request.ProxyHandler({})).open(asked, timeout=30) as answer:
        assert answer.read() == b"\xff\xd8\xff" + list(archive.objects)[4].encode()
    lists = [query for (_, path, _), query in zip(archive.requests, archive.queries) if path.endswith("/instances")]
    assert (lists == ["limit=1&InstanceNumber=5"]) == (counts and first == 1), lists
    viewer.send_signal(signal.SIGINT)
    viewer.communicate(timeout=30)


def test_an_early_end_goes_on_where_it_was(tmp_path, archive):
    archive.fault = "early"
    sentence = one_sentence(kontur("fetch", archive.series_address, "-o", tmp_path / "out"), IO, "goes on from there", "out.part")
    kept = len(list((tmp_path / "out.part").iterdir()))
    assert 0 < kept < 9 and f"{kept} of 9 objects" in sentence
    archive.fault, archive.requests = "", []
    assert kontur("fetch", archive.series_address, "-o", tmp_path / "out").returncode == 0
    assert sum("/instances/" in path for _, path, _ in archive.requests) == 9 - kept, "only what was missing is asked for"
    assert {path.stem: path.read_bytes() for path in (tmp_path / "out").iterdir()} == archive.objects
    assert not (tmp_path / "out.part").exists()


def test_ctrl_c_stops_at_once_and_keeps_what_came(tmp_path, archive):
    archive.fault = "slow"
    process = subprocess.Popen([KONTUR, "fetch", archive.series_address, "-o", tmp_path / "out"], stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 20
    while len(list((tmp_path / "out.part").glob("*.dcm"))) < 3:
        assert time.monotonic() < deadline
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    start = time.monotonic()
    _, words = process.communicate(timeout=20)
    assert time.monotonic() - start < 3
    assert process.returncode == STOPPED and "interrupted; 3 of 9 objects" in words and not (tmp_path / "out").exists()


def test_a_folder_that_lacks_some_is_not_touched(tmp_path, archive):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "mine.txt").write_text("mine")
    one_sentence(kontur("fetch", archive.series_address, "-o", tmp_path / "out"), INPUT, "name a new folder")
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["mine.txt"]


def test_a_redirect_within_the_archive_is_followed(tmp_path, archive):
    archive.fault = "redirect-here"
    assert kontur("fetch", archive.series_address, "-o", tmp_path / "out").returncode == 0
    assert len(list((tmp_path / "out").iterdir())) == 9


@pytest.mark.parametrize(("fault", "code", "words"), STOW_FAULTS)
def test_what_is_not_stored_is_said_and_kept(tmp_path, archive, files, fault, code, words):
    file, archive.sent = made_file(tmp_path, files)
    before = file.read_bytes()
    with running(Archive()) as other:
        archive.elsewhere, archive.fault = f"http://127.0.0.1:{other.port}", fault
        one_sentence(kontur("send", file, "--archive", archive.address), code, words)
        assert other.requests == []
    assert archive.stored == {} and file.read_bytes() == before


def test_objects_are_stored_once_and_never_over_others(tmp_path, archive, files):
    file, uid = made_file(tmp_path, files)
    first = kontur("send", file, files[3], "--archive", archive.address)
    assert first.returncode == 0 and "new.dcm: stored in" in first.stdout and "was there already" in first.stdout
    assert archive.stored == {uid: file.read_bytes()}
    assert kontur("send", file, "--archive", archive.address).stdout.count("was there already") == 1
    assert sum(method == "POST" for method, _, _ in archive.requests) == 1


def test_a_doubt_of_the_archive_is_a_warning(tmp_path, archive, files):
    file, archive.sent = made_file(tmp_path, files)
    archive.fault = "changed"
    result = kontur("send", file, "--archive", archive.address)
    assert result.returncode == 0 and "kontur: warning: " in result.stderr and "elements were changed (B000)" in result.stderr


def test_of_several_objects_each_is_told_by_itself(tmp_path, archive, files):
    file, archive.sent = made_file(tmp_path, files)
    archive.fault = "failed"
    result = kontur("send", files[0], file, "--archive", archive.address)
    one_sentence(result, IO, "1 of 2 objects were not stored")
    assert "was there already" in result.stdout and "new.dcm: refused" in result.stderr


def test_a_study_that_the_archive_does_not_have_gets_nothing(tmp_path, archive, files):
    dataset = pydicom.dcmread(files[0])
    dataset.StudyInstanceUID = "1.2.3"
    dataset.SOPInstanceUID = dataset.file_meta.MediaStorageSOPInstanceUID = pydicom.uid.generate_uid()
    dataset.save_as(tmp_path / "lost.dcm")
    one_sentence(kontur("send", tmp_path / "lost.dcm", "--archive", archive.address), INPUT, "does not have the study 1.2.3")
    (tmp_path / "text.dcm").write_text("text")
    one_sentence(kontur("send", files[0], tmp_path / "text.dcm", "--archive", archive.address), CORRUPT, "text.dcm")
    assert archive.stored == {}


def test_credentials_come_from_a_file_or_the_environment_and_are_nowhere_else(tmp_path, archive, files):
    file = tmp_path / "who"
    file.write_text("me:top-secret\n")
    one_sentence(kontur("find", archive.address, "--credentials", file), INPUT, "chmod 600")
    file.chmod(0o600)
    assert kontur("find", archive.address, "--credentials", file).returncode == 0
    assert archive.requests[-1][2]["Authorization"] == "Basic bWU6dG9wLXNlY3JldA=="
    assert kontur("find", archive.address, KONTUR_ARCHIVE_CREDENTIALS="Bearer top-secret").returncode == 0
    assert archive.requests[-1][2]["Authorization"] == "Bearer top-secret"
    archive.fault = "401"
    one_sentence(kontur("find", archive.address, "--credentials", file), IO, "does not accept the user or token of --credentials")
    one_sentence(kontur("find", archive.address, KONTUR_ARCHIVE_CREDENTIALS="me:top-secret"), IO, "KONTUR_ARCHIVE_CREDENTIALS")
    one_sentence(kontur("find", "http://archive.invalid/dicom-web", KONTUR_ARCHIVE_CREDENTIALS="me:top-secret"), INPUT, "https://")
    one_sentence(kontur("find", "https://me:top-secret@archive.invalid/x"), INPUT, "--credentials")
    archive.fault = ""
    contours = tmp_path / "contours.json"
    convert = kontur("convert", archive.series_address, tmp_path / "ct.nrrd", "--credentials", file, cache=tmp_path / "cache")
    assert convert.returncode == 0, (convert, contours)
    for path in tmp_path.rglob("*"):
        if path.is_file() and path != file:
            assert b"top-secret" not in path.read_bytes() and b"dG9wLXNlY3JldA" not in path.read_bytes(), path
    assert "secret" not in convert.stdout + convert.stderr
    assert (tmp_path / "cache/kontur/archive").stat().st_mode & 0o077 == 0, "nobody else may look into it"


def test_options_for_archives_need_an_address(tmp_path, files):
    (tmp_path / "who").write_text("me:word")
    (tmp_path / "who").chmod(0o600)
    one_sentence(kontur("convert", files[0].parent, tmp_path / "ct.nrrd", "--credentials", tmp_path / "who"), INPUT, "https://")


def test_nobody_there(tmp_path):
    one_sentence(kontur("find", "http://127.0.0.1:9/dicom-web"), IO, "cannot reach 127.0.0.1:9")
    one_sentence(kontur("find", "https://archive.invalid/dicom-web"), IO, "cannot reach archive.invalid")


def test_certificates_are_verified(tmp_path, files):
    good = certificate(tmp_path, "good", "-days", "2")
    with running(Archive(files, context_of(good))) as archive:
        one_sentence(kontur("find", archive.address), IO, "is not trusted", "--ca")
        assert archive.requests == []
        assert kontur("find", archive.address, "--ca", good[0]).returncode == 0
        other = certificate(tmp_path, "other", "-days", "2")
        one_sentence(kontur("find", archive.address, "--ca", other[0]), IO, "is not trusted")
        one_sentence(kontur("find", archive.address.replace("127.0.0.1", "localhost"), "--ca", good[0]), IO, "is not trusted")
        one_sentence(kontur("find", archive.address, "--ca", tmp_path / "good.key"), IO, "holds no certificate")
        one_sentence(kontur("find", archive.address, "--ca", tmp_path / "nothing"), IO, "--ca")


def test_a_certificate_that_is_out_of_date_is_refused(tmp_path, files):
    old = expired_certificate(tmp_path)
    with running(Archive(files, context_of(old))) as archive:
        one_sentence(kontur("fetch", archive.series_address, "-o", tmp_path / "out", "--ca", old[0]), IO, "certificate has expired")
        assert archive.requests == [] and not (tmp_path / "out").exists()


def expired_certificate(folder):
    """Of the year 2020, by openssl's small authority, which can say from when and until when."""
    (folder / "index.txt").write_text("")
    (folder / "serial").write_text("01\n")
    (folder / "ca.cnf").write_text(
        f"[ca]\ndefault_ca=d\n[d]\ndir={folder}\ndatabase={folder}/index.txt\nserial={folder}/serial\nnew_certs_dir={folder}\ndefault_md=sha256\npolicy=p\n"
        "x509_extensions=x\n[p]\ncommonName=supplied\n[x]\nsubjectAltName=IP:127.0.0.1\nbasicConstraints=CA:true\n"
    )
    run = lambda *words: subprocess.run(["openssl", *words], check=True, capture_output=True, cwd=folder)  # noqa: E731
    run("req", "-newkey", "rsa:2048", "-nodes", "-subj", "/CN=127.0.0.1", "-keyout", "old.key", "-out", "old.csr")
    run("ca", "-batch", "-selfsign", "-config", "ca.cnf", "-keyfile", "old.key", "-in", "old.csr", "-out", "old.pem", "-startdate", "20200101000000Z", "-enddate", "20200201000000Z")
    return folder / "old.pem", folder / "old.key"


def test_only_who_asks_an_archive_loads_libcurl(archive):
    for words, loads in ((["--version"], False), (["find", archive.address], True)):
        result = kontur(*words, LD_DEBUG="files")
        assert result.returncode == 0 and "libc.so.6" in result.stderr
        assert ("libcurl" in result.stderr) == loads, words
