# SPDX-License-Identifier: Apache-2.0
"""Images and masks of more than 2^31 voxels: offsets beyond 32 bits, within the memory that docs/reliability.md states, and a refusal
beyond the cap. Takes minutes and 6 GB, so only with KONTUR_BIG=1 (`make torture`)."""
import json
import math
import os
import subprocess
import sys

import nibabel
import numpy
import pytest

KONTUR = os.environ["KONTUR_CLI"]
pytestmark = pytest.mark.skipif(os.environ.get("KONTUR_BIG") != "1", reason="takes minutes and 6 GB: set KONTUR_BIG=1")
SHAPE = (1024, 1024, 2090)
VOXELS = math.prod(SHAPE)  # 2.19e9, above 2^31
RADIUS, CENTER = 200.0, (512.0, 512.0, 1850.0)


def sparse_image(path, shape):
    """16-bit zeros that take no room on the disk, but for the last voxel, which is 7. Axes along LPS, 1 mm."""
    header = nibabel.Nifti1Header()
    header.set_data_shape(shape)
    header.set_data_dtype(numpy.int16)
    header.set_sform(numpy.diag([-1.0, -1, 1, 1]), 1)
    header["vox_offset"] = 352
    with open(path, "wb") as file:
        file.write(header.binaryblock + bytes(4))
        file.truncate(352 + 2 * math.prod(shape))
        file.seek(-2, os.SEEK_END)
        file.write((7).to_bytes(2, "little"))


def run(folder, *words):
    """Exit code, stdout, stderr and peak memory in MB."""
    with open(folder / "stdout", "w+") as out, open(folder / "stderr", "w+") as err:
        process = subprocess.Popen([KONTUR, *map(str, words)], cwd=folder, stdout=out, stderr=err)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, (folder / "stdout").read_text(), (folder / "stderr").read_text(), usage.ru_maxrss * 1024 / 1e6


def test_an_image_is_read_to_its_last_voxel(tmp_path):
    sparse_image(tmp_path / "big.nii", SHAPE)
    code, out, err, peak = run(tmp_path, "inspect", "--json", "big.nii")
    assert code == 0, err
    print(f"inspect: {peak:.0f} MB", file=sys.stderr)
    assert json.loads(out)[0]["size"] == list(SHAPE)
    assert "7" in out
    assert peak < 2e-6 * VOXELS + 1000


def test_a_mask_is_made_beyond_32_bits(tmp_path):
    sparse_image(tmp_path / "big.nii", SHAPE)
    planes = []
    for axis in range(3):
        for offset in (-150.0, -75, 0, 75, 150):
            normal = [float(n == axis) for n in range(3)]
            radius = math.sqrt(RADIUS**2 - offset**2)
            points = []
            for k in range(90):
                p = list(CENTER)
                p[axis] += offset
                p[(axis + 1) % 3] += radius * math.cos(2 * math.pi * k / 90)
                p[(axis + 2) % 3] += radius * math.sin(2 * math.pi * k / 90)
                points.append(p)
            planes.append({"origin": [c + offset * n for c, n in zip(CENTER, normal)], "normal": normal, "contours": [{"points": points}]})
    (tmp_path / "ball.json").write_text(json.dumps({"frame": "LPS mm", "planes": planes}))
    code, out, err, peak = run(tmp_path, "segment", "ball.json", "--image", "big.nii", "--output", "mask.nii", "--report", "report.json")
    assert code == 0, err
    report = json.loads((tmp_path / "report.json").read_text())
    print(f"segment: {peak:.0f} MB, {report['seconds']}", file=sys.stderr)
    assert report["mask"]["voxels"] == pytest.approx(4 / 3 * math.pi * RADIUS**3, rel=0.01)
    assert peak < 1e-6 * VOXELS + 1300
    mask = nibabel.load(tmp_path / "mask.nii")
    assert mask.shape == SHAPE
    voxels = numpy.asanyarray(mask.dataobj[:, :, 2040])  # offsets from 2.139e9 on
    assert voxels.sum() == pytest.approx(math.pi * (RADIUS**2 - 190**2), rel=0.03)


def test_one_slice_beyond_the_cap_is_refused(tmp_path):
    shape = (1024, 1024, 2099)
    sparse_image(tmp_path / "big.nii", shape)
    code, _, err, peak = run(tmp_path, "inspect", "big.nii")
    assert code == 77 and f"{math.prod(shape)} voxels" in err
    assert peak < 300
