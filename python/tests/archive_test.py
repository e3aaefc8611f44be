# SPDX-License-Identifier: Apache-2.0
"""kontur.archive against an archive that misbehaves: the same results and sentences as find, fetch and send have."""
import json
import pathlib
import re
import subprocess
import sys
import threading
import time
import urllib.parse

import kontur
import numpy
import pytest

pytest.importorskip("pydicom")
ROOT = pathlib.Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests/archive"))
import support
from misbehaving import CORRUPT, FAULTS, INPUT, IO, STOW_FAULTS, TOO_LARGE, Hostile, made_file
from support import certificate, context_of, make_series, running

EXCEPTIONS = {INPUT: kontur.InvalidInputError, CORRUPT: kontur.CorruptFileError, IO: kontur.FileError, TOO_LARGE: kontur.TooLargeError}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    return make_series(tmp_path_factory.mktemp("series"))


@pytest.fixture
def archive(files, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.delenv("KONTUR_ARCHIVE_CREDENTIALS", raising=False)
    for name in ("http_proxy", "https_proxy", "all_proxy", "HTTP_PROXY", "HTTPS_PROXY", "ALL_PROXY"):
        monkeypatch.delenv(name, raising=False)
    with running(Hostile(files)) as server:
        yield server


def words_of(option):
    """The command's option as a keyword."""
    return option.removeprefix("--").replace("-", "_") if option.startswith("--") else option


@pytest.mark.parametrize(("fault", "code", "words"), FAULTS)
def test_each_fault_is_the_commands_sentence_and_leaves_nothing_half(tmp_path, archive, fault, code, words):
    with running(support.Archive()) as other:
        archive.elsewhere, archive.fault = f"http://127.0.0.1:{other.port}", fault
        with pytest.raises(EXCEPTIONS[code]) as raised:
            kontur.archive.fetch(archive.series_address, tmp_path / "out", give_up_s=1)
        assert other.requests == [], "another host is never asked"
    sentence = str(raised.value)
    assert words_of(words) in sentence and "--" not in sentence and "secret" not in sentence
    assert not (tmp_path / "out").exists()
    for path in (tmp_path / "out.part").glob("*"):
        assert path.read_bytes() == archive.objects[path.stem], "what is there is whole"


@pytest.mark.parametrize(("fault", "code", "words"), STOW_FAULTS)
def test_what_is_not_stored_is_raised_and_kept(tmp_path, archive, files, fault, code, words):
    file, archive.sent = made_file(tmp_path, files)
    before = file.read_bytes()
    with running(support.Archive()) as other:
        archive.elsewhere, archive.fault = f"http://127.0.0.1:{other.port}", fault
        with pytest.raises(EXCEPTIONS[code]) as raised:
            kontur.archive.send([file], archive.address)
        assert other.requests == []
    assert words_of(words) in str(raised.value)
    assert archive.stored == {} and file.read_bytes() == before


def test_an_archive_is_looked_through_as_find_does(archive):
    [study] = kontur.archive.find(archive.address)
    [series] = kontur.archive.find(study.address)
    objects = kontur.archive.find(series.address)
    assert series.address == archive.series_address and series.modality == "CT" and series.objects == 9
    assert [one.address.split("/")[-1] for one in objects] == [one.instance_uid for one in objects] == list(archive.objects)
    for address, found in ((archive.address, [study]), (study.address, [series]), (series.address, objects)):
        listed = json.loads(support.kontur("find", address, "--json").stdout)
        assert listed == [{name: getattr(one, name) for name in row} for row, one in zip(listed, found, strict=True)]
    assert repr(study) == f"<Study '{study.address}'>"
    kontur.archive.find(archive.address, name="doe", patient_id="7", date="2024-01-01..", modality="CT", most=5)
    asked = dict(term.split("=") for term in urllib.parse.unquote(archive.queries[-1]).split("&"))
    wanted = {"PatientName": "doe*", "PatientID": "7", "StudyDate": "20240101-", "ModalitiesInStudy": "CT", "limit": "6"}
    assert asked.items() >= wanted.items()
    with pytest.raises(kontur.InvalidInputError, match="^name, patient_id, date, modality and most choose studies"):
        kontur.archive.find(study.address, name="doe")
    with pytest.raises(kontur.InvalidInputError, match="date yesterday is no date"):
        kontur.archive.find(archive.address, date="yesterday")


def test_a_series_comes_as_it_is_stored_and_is_read(tmp_path, archive, files):
    told = []
    folder = kontur.archive.fetch(archive.series_address, tmp_path / "out", progress=lambda stage, share: told.append((stage, share)))
    assert folder == tmp_path / "out" and told[-1] == ("fetch", 1)
    assert {path.stem: path.read_bytes() for path in folder.iterdir()} == archive.objects
    study = kontur.archive.fetch(archive.series_address.split("/series")[0], tmp_path / "study")
    assert [path.name for path in study.iterdir()] == [archive.series]
    one = kontur.archive.fetch(kontur.archive.find(archive.series_address)[0].address, tmp_path / "one.dcm")
    assert one.read_bytes() == next(iter(archive.objects.values()))
    before = len(archive.requests)
    kept = kontur.archive.fetch(archive.series_address)
    assert kept.is_relative_to(tmp_path / "cache") and kontur.archive.fetch(archive.series_address) == kept
    assert sum("/instances" not in path for _, path, _ in archive.requests[before:]) == 2, "one question how many, one for all"
    assert numpy.array_equal(kontur.read_image(kept).samples, kontur.read_image(files[0].parent).samples)
    assert kontur.archive.fetch(archive.series_address.split("/series")[0]) == kept
    with pytest.raises(kontur.InvalidInputError, match="has no series of modality MR"):
        kontur.archive.fetch(archive.series_address.split("/series")[0], tmp_path / "mr", modality="MR")
    for wrong in ({"modality": "CT"}, {"series": archive.series, "output": tmp_path / "x"}):
        with pytest.raises(kontur.InvalidInputError, match="chooses"):
            kontur.archive.fetch(archive.series_address.split("/series")[0], **wrong)


def test_the_documented_lines_find_fetch_and_send(tmp_path, archive, files, monkeypatch):
    [program] = re.findall(r"```python[^\n]*\n(.*?)```", (ROOT / "docs/pacs.md").read_text(), re.DOTALL)
    uids = []
    for name in ("seg.dcm", "contours.dcm"):
        file, uid = made_file(tmp_path, files)
        file.rename(tmp_path / name)
        uids.append(uid)
    monkeypatch.chdir(tmp_path)
    names = {"kontur": kontur, "archive": archive.address}
    exec(program, names)
    assert numpy.array_equal(names["image"].samples, kontur.read_image(files[0].parent).samples)
    assert list(archive.stored) == uids


def test_an_early_end_goes_on_where_it_was(tmp_path, archive):
    archive.fault = "early"
    with pytest.raises(kontur.FileError, match=r"\d of 9 objects are in .*out.part, and the same again goes on from there"):
        kontur.archive.fetch(archive.series_address, tmp_path / "out")
    kept = len(list((tmp_path / "out.part").iterdir()))
    archive.fault, archive.requests = "", []
    kontur.archive.fetch(archive.series_address, tmp_path / "out")
    assert 0 < kept < 9 and sum("/instances/" in path for _, path, _ in archive.requests) == 9 - kept
    assert {path.stem: path.read_bytes() for path in (tmp_path / "out").iterdir()} == archive.objects


def test_a_stop_ends_it_at_once_and_keeps_what_came(tmp_path, archive):
    archive.fault, stop = "slow", threading.Event()
    part = tmp_path / "out.part"

    def stop_after_three():
        while len(list(part.glob("*.dcm"))) < 3:
            time.sleep(0.02)
        stop.set()

    threading.Thread(target=stop_after_three, daemon=True).start()
    start = time.monotonic()
    with pytest.raises(kontur.CancelledError):
        kontur.archive.fetch(archive.series_address, tmp_path / "out", stop=stop)
    assert time.monotonic() - start < 20 and len(list(part.iterdir())) == 3


def test_files_are_sent_once_and_each_is_told_of(tmp_path, archive, files):
    file, uid = made_file(tmp_path, files)
    new, old = kontur.archive.send([file, files[3]], archive.address)
    assert (new.outcome, old.outcome, new.path) == ("stored", "was there", file) and new.study in archive.series_address
    assert archive.stored == {uid: file.read_bytes()}
    (tmp_path / "second").mkdir()
    second, archive.sent = made_file(tmp_path / "second", files)
    archive.fault = "changed"
    [doubted] = kontur.archive.send([second], archive.address)
    assert doubted.outcome == "stored with doubt" and "elements were changed (B000)" in doubted.reason
    archive.fault = "failed"
    with pytest.raises(kontur.FileError, match=r"(?s)1 of 2 objects were not stored.*refused: the archive takes no objects"):
        kontur.archive.send([files[0], second], archive.address)
    with pytest.raises(kontur.InvalidInputError, match="^archive .* names a study"):
        kontur.archive.send([file], archive.series_address)
    (tmp_path / "text.dcm").write_text("text")
    with pytest.raises(kontur.CorruptFileError, match="text.dcm"):
        kontur.archive.send([tmp_path / "text.dcm"], archive.address)


def test_who_asks_is_verified_and_not_told(tmp_path, archive, files, monkeypatch):
    file = tmp_path / "who"
    file.write_text("me:top-secret\n")
    with pytest.raises(kontur.InvalidInputError, match="others may read credentials .*chmod 600"):
        kontur.archive.find(archive.address, credentials=file)
    file.chmod(0o600)
    kontur.archive.find(archive.address, credentials=file)
    assert archive.requests[-1][2]["Authorization"] == "Basic bWU6dG9wLXNlY3JldA=="
    monkeypatch.setenv("KONTUR_ARCHIVE_CREDENTIALS", "Bearer top-secret")
    kontur.archive.find(archive.address)
    assert archive.requests[-1][2]["Authorization"] == "Bearer top-secret"
    monkeypatch.delenv("KONTUR_ARCHIVE_CREDENTIALS")
    with pytest.raises(kontur.InvalidInputError, match="give_up_s is 0 s"):
        kontur.archive.find(archive.address, give_up_s=0)
    good = certificate(tmp_path, "good", "-days", "2")
    with running(support.Archive(files, context_of(good))) as encrypted:
        with pytest.raises(kontur.FileError, match="is not trusted .*; ca FILE names"):
            kontur.archive.find(encrypted.address)
        assert len(kontur.archive.find(encrypted.address, ca=good[0])) == 1


def test_libcurl_is_loaded_by_the_first_request_alone(archive):
    program = ("import kontur; read = lambda: 'libcurl' in open('/proc/self/maps').read(); before = read(); "
               f"kontur.archive.find({archive.address!r}); print(before, read())")
    assert subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout == "False True\n"
