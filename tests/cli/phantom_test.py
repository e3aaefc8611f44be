# SPDX-License-Identifier: Apache-2.0
"""kontur phantom writes scans, exact truth and contour sets that belong together."""
import json
import signal
import subprocess
import time

import nibabel
import numpy
import pytest
from support import KONTUR, kontur, names, succeed


@pytest.fixture(scope="module")
def phantom(tmp_path_factory):
    """The small scan and every contour set."""
    folder = tmp_path_factory.mktemp("phantom") / "new"
    text = succeed("phantom", folder, "--scan", "metastasis")
    return folder, json.loads((folder / "phantom.json").read_text()), text


def test_lists_every_file_it_wrote(phantom):
    folder, listed, text = phantom
    files = [v["image"] for v in listed["volumes"]] + [t for v in listed["volumes"] for t in v["truth"].values()]
    files += [c["file"] for c in listed["contours"]]
    assert names(folder) == sorted(files + ["phantom.json"])
    for name in [v["image"] for v in listed["volumes"]] + [c["file"] for c in listed["contours"]]:
        assert f"{name}: " in text


def test_the_papers_cases_have_the_papers_size(phantom):
    folder, listed, _ = phantom
    found = {c["file"]: (c["contours"], c["points"], c["body"]) for c in listed["contours"]}
    assert found["liver_orthogonal14.json"] == (14, 6896, "liver")
    assert found["metastasis_parallel17.json"] == (17, 3121, "metastasis")
    assert found["metastasis_parallel7.json"][0] == 7
    assert found["liver_parallel14.json"][0] == 14
    assert found["self_intersecting.json"][2] is None
    assert nibabel.load(folder / "metastasis_ct.nii.gz").get_fdata().size == 1_058_508


def test_truth_lies_where_the_image_shows_it(phantom):
    folder, _, _ = phantom
    ct = nibabel.load(folder / "metastasis_ct.nii.gz")
    truth = nibabel.load(folder / "metastasis_truth_metastasis.nii.gz")
    assert numpy.array_equal(ct.affine, truth.affine)
    inside = numpy.asarray(truth.dataobj) == 1
    hu = ct.get_fdata()
    assert 0 < hu[inside].mean() < hu[~inside].mean() < 200  # a hypodense metastasis in enhanced liver


@pytest.mark.parametrize("case, least_dice", [("metastasis_parallel17", 0.998), ("metastasis_parallel7", 0.99), ("metastasis_parallel17_hand", 0.98)])
def test_segmenting_its_contours_gives_its_truth(phantom, tmp_path, case, least_dice):
    folder, _, _ = phantom
    mask = tmp_path / "mask.nii.gz"
    result = kontur("segment", folder / f"{case}.json", "--image", folder / "metastasis_ct.nii.gz", "--output", mask)
    assert result.returncode == 0, result
    found = json.loads(succeed("compare", mask, folder / "metastasis_truth_metastasis.nii.gz", "--json"))
    assert found["dice"] > least_dice


@pytest.mark.parametrize("case, least_dice", [("liver_orthogonal14", 0.9985), ("liver_oblique10", 0.9965)])
def test_the_livers_are_as_exact_with_their_image_as_contours_make_them(tmp_path, case, least_dice):
    """14 contours hold it to a twentieth of a voxel: there is nothing that its image knows better. Ten oblique ones hold it to
    a third of a millimetre (Dice 0.994), which profiles of voxels mend, but no walk on cells of four."""
    succeed("phantom", tmp_path / "demo", "--scan", "liver")
    succeed("segment", tmp_path / f"demo/{case}.json", "--image", tmp_path / "demo/liver_ct.nii.gz", "--output", tmp_path / "liver.nii.gz")
    compared = json.loads(succeed("compare", tmp_path / "liver.nii.gz", tmp_path / "demo/liver_truth_liver.nii.gz", "--json"))
    assert compared["dice"] > least_dice, compared


def test_every_contour_set_can_be_segmented(phantom):
    folder, listed, _ = phantom
    for facts in json.loads(succeed("inspect", *(folder / c["file"] for c in listed["contours"]), "--json")):
        assert facts["problems"] == [], facts["file"]


def test_an_unknown_scan_is_refused_with_the_known_ones(tmp_path):
    result = kontur("phantom", tmp_path / "new", "--scan", "spleen")
    assert result.returncode == 65
    assert "spleen" in result.stderr and "abdomen, abdomen_oblique, liver, metastasis" in result.stderr
    assert names(tmp_path) == []


def test_an_interrupt_leaves_no_folder(tmp_path):
    process = subprocess.Popen([KONTUR, "phantom", tmp_path / "new"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    time.sleep(0.7)
    process.send_signal(signal.SIGINT)
    _, stderr = process.communicate(timeout=30)
    assert process.returncode == 130
    assert "interrupted" in stderr
    assert names(tmp_path) == []
