# SPDX-License-Identifier: Apache-2.0
"""The moving picture of docs/moving.md is what its commands make."""
import os
import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).parents[2]


def chunks(path):
    data, at = path.read_bytes(), 8
    while at < len(data):
        size = int.from_bytes(data[at:at + 4], "big")
        yield data[at + 4:at + 8], data[at + 8:at + 8 + size]
        at += size + 12


def shape(path):
    """Size, number of pictures, and the time of each in ms."""
    found = list(chunks(path))
    return dict(found)[b"IHDR"][:8], dict(found)[b"acTL"], [int.from_bytes(body[20:22], "big") for kind, body in found if kind == b"fcTL"]


def test_the_commands_of_the_page_make_its_moving_picture(tmp_path):
    pytest.importorskip("nibabel")
    kontur = pathlib.Path(os.environ["KONTUR_BUILD"]) / "bin" / "kontur"
    subprocess.run([sys.executable, ROOT / "tools" / "beating_heart", tmp_path], check=True)
    result = subprocess.run([kontur, "segment", tmp_path / "beating.json", "--image", tmp_path / "cine.nii.gz", "--output",
                             tmp_path / "masks.nii.gz", "--picture", tmp_path / "beating.apng"], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    made = shape(tmp_path / "beating.apng")
    assert made == shape(ROOT / "docs" / "images" / "beating.png")
    assert made[2] == [45] * 20
    fraction = float(result.stdout.split("ejection fraction ")[1].split(" %")[0])
    assert fraction == pytest.approx(62.5, abs=3)
