# SPDX-License-Identifier: Apache-2.0
"""kontur.derive gives what the command gives, byte for byte."""
import os
import subprocess

import kontur
import numpy as np
import pytest


def ball(center, radius, grid):
    z, y, x = np.mgrid[:grid.shape[0], :grid.shape[1], :grid.shape[2]]
    points = np.stack([x, y, z, np.ones_like(x)], -1) @ np.asarray(grid.index_to_mm).T
    return kontur.Mask(np.linalg.norm(points[..., :3] - center, axis=-1) < radius, grid)


@pytest.fixture
def masks():
    grid = kontur.Grid((50, 48, 20), np.diag([0.9, 1, 3, 1]), frame="LPS")
    return {"CTV": ball([22, 24, 30], 9, grid), "Cord": ball([34, 24, 30], 5, grid)}


def test_command_and_python_agree_byte_for_byte(masks, tmp_path):
    rules = ["PTV = CTV + 5 mm", "Opt = PTV - (Cord + 3 mm)", "Wall = CTV - (CTV - {2 mm, left 4 mm})", "Up = CTV + 7 mm along superior"]
    for name, mask in masks.items():
        kontur.write_mask(tmp_path / f"{name}.nii.gz", mask)
    inputs = [word for name in masks for word in ("-i", tmp_path / f"{name}.nii.gz")]
    read = {name: kontur.read_mask(tmp_path / f"{name}.nii.gz") for name in masks}
    made = kontur.derive(rules, read)
    assert list(made) == ["PTV", "Opt", "Wall", "Up"]
    needed = {"PTV": rules[:1], "Opt": rules[:2], "Wall": rules[2:3], "Up": rules[3:]}
    for name, its in needed.items():
        words = ["derive", its[-1] if len(its) == 1 else its[1], *(its[:1] if len(its) == 2 else []), *inputs, "-o", tmp_path / "out.seg.nrrd"]
        subprocess.run([os.environ["KONTUR_CLI"], *map(str, words)], check=True, capture_output=True)
        found = kontur.read_mask(tmp_path / "out.seg.nrrd", label=1)
        assert found.values.tobytes() == made[name].mask.values.tobytes(), name
        assert found.values.any()


def test_operators_are_rules(masks):
    ctv, cord = masks.values()
    made = kontur.derive(["A = CTV + 5 mm", "B = CTV - 3 mm", "C = CTV | Cord", "D = CTV & Cord", "E = CTV - Cord"], masks)
    for name, mask in zip("ABCDE", (ctv + 5, ctv - 3.0, ctv | cord, ctv & cord, ctv - cord)):
        assert np.array_equal(mask.values, made[name].mask.values), name
    with pytest.raises(kontur.InvalidInputError, match="at least 0"):
        ctv + -3
    with pytest.raises(TypeError):
        ctv + "5 mm"


def test_structures_of_contours_keep_their_surface():
    case = kontur.phantom_case("metastasis_parallel7")
    made = kontur.segment(case.contours, case.grid)
    by_function = kontur.derive("PTV = A + 5 mm", {"A": made})["PTV"]
    by_mask = kontur.derive("PTV = A + 5 mm", {"A": made.mask})["PTV"]
    assert kontur.compare(by_function.mask, by_mask.mask).dice > 0.97
    assert by_function.sources == ["A"] and by_function.outlines.name == "PTV"


def test_errors_name_the_place(masks):
    with pytest.raises(kontur.InvalidInputError, match=r"`PTV = \^CTW`, column 7"):
        kontur.derive("PTV = CTW", masks)
    with pytest.raises(TypeError, match="Mask or a Segmentation"):
        kontur.derive("PTV = CTV", {"CTV": 5})
