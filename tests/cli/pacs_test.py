# SPDX-License-Identifier: Apache-2.0
"""docs/pacs.md word by word against Debian's Orthanc: a study is found, segmented, and the results come back."""
import json
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import time
import urllib.request

import pydicom
import pytest
from support import KONTUR, circle, write_planes

ROOT = pathlib.Path(__file__).parents[2]
PLUGINS = pathlib.Path("/usr/share/orthanc/plugins")


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def ask(port, path):
    with urllib.request.urlopen(f"http://127.0.0.1:{port}{path}", timeout=20) as answer:
        return json.load(answer)


@pytest.fixture
def archive(tmp_path):
    """Orthanc with one series of CT; gives its two ports and the study's and the series' UID."""
    if not shutil.which("Orthanc") or not shutil.which("storescu") or not shutil.which("getscu"):
        pytest.skip("orthanc or dcmtk is not installed")
    if not (PLUGINS / "libOrthancDicomWeb.so").exists():
        pytest.skip("orthanc-dicomweb is not installed")
    http, dicom = free_port(), free_port()
    settings = {"StorageDirectory": str(tmp_path / "db"), "IndexDirectory": str(tmp_path / "db"), "HttpPort": http, "DicomPort": dicom, "DicomAet": "ORTHANC"}
    settings |= {"AuthenticationEnabled": False, "RemoteAccessAllowed": False, "DicomAlwaysAllowGet": True, "Plugins": [str(PLUGINS / "libOrthancDicomWeb.so")]}
    (tmp_path / "orthanc.json").write_text(json.dumps(settings))
    subprocess.run([sys.executable, ROOT / "tests/support/make_dicom_series.py", "axial", tmp_path / "axial"], check=True)
    files = sorted((tmp_path / "axial" / "dicom").iterdir())
    with open(tmp_path / "orthanc.log", "w") as log:
        server = subprocess.Popen(["Orthanc", tmp_path / "orthanc.json"], stdout=log, stderr=log)
    try:
        for _ in range(300):
            try:
                ask(http, "/system")
                break
            except OSError:
                time.sleep(0.1)
        subprocess.run(["storescu", "-R", "-aec", "ORTHANC", "127.0.0.1", str(dicom), *files], check=True)
        first = pydicom.dcmread(files[0])
        yield http, dicom, first.StudyInstanceUID, first.SeriesInstanceUID
    finally:
        server.terminate()
        server.wait(timeout=30)


def test_the_documented_lines_find_segment_send_and_fetch(tmp_path, archive):
    http, dicom, study, series = archive
    write_planes(tmp_path / "contours.json", [circle("z", offset, center=(-15.0, -25.0, 110.0), radius=3.5) for offset in (-2.5, 0, 2.5)])
    blocks = re.findall(r"```text\n(.*?)```", (ROOT / "docs/pacs.md").read_text(), re.S)
    assert len(blocks) == 5
    own = {name: value for name, value in os.environ.items() if "proxy" not in name.lower()}
    own |= {"ARCHIVE": f"http://127.0.0.1:{http}/dicom-web", "STUDY": study, "SERIES": series, "XDG_CACHE_HOME": str(tmp_path / "cache")}
    own["PATH"] = f"{pathlib.Path(KONTUR).parent}:{os.environ['PATH']}"
    (tmp_path / "images").mkdir()
    stored = []
    for block in blocks:
        lines = block.replace("127.0.0.1 4242", f"127.0.0.1 {dicom}")
        result = subprocess.run(["bash", "-e", "-c", lines], cwd=tmp_path, env=own, capture_output=True, text=True, timeout=120)
        assert result.returncode == 0, (lines, result)
        stored.append(ask(http, "/statistics")["CountInstances"])
    images = len(list((tmp_path / "images").iterdir()))
    assert images == 9 and stored == [images, images, images + 2, images + 2, images + 2]
    assert sorted(len(list(folder.iterdir())) for folder in (tmp_path / "study").iterdir()) == [1, 1, 9]
    found = {tags["Modality"]: tags for tags in (one["MainDicomTags"] for one in ask(http, "/series?expand"))}
    assert set(found) == {"CT", "SEG", "RTSTRUCT"}
    assert found["SEG"]["SeriesDescription"] == found["RTSTRUCT"]["SeriesDescription"] == "Liver, first reader"
    assert len(ask(http, "/studies")) == 1, "all belong to one study"
