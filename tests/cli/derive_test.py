# SPDX-License-Identifier: Apache-2.0
"""kontur derive: structures by rules, from label maps, SEG and RTSTRUCT to all of these, and a table of them."""
import csv
import json
import pathlib
import subprocess
import sys

import nibabel
import numpy as np
import pydicom
import pytest

from rois_test import images, structures  # fixtures: a DICOM series, and balls in it as ROIs
from support import kontur, names, succeed

SUPPORT = pathlib.Path(__file__).parent.parent / "support"
SPACING = (1.0, 1.0, 2.5)
AFFINE = np.diag([-1, -1, 1, 1]) @ np.diag([*SPACING, 1])


def grid():
    return np.mgrid[:50, :50, :20] * np.array(SPACING)[:, None, None, None]


def ball(center, radius):
    return np.sqrt(sum((a - c) ** 2 for a, c in zip(grid(), center))) - radius


def save(path, labels):
    nibabel.save(nibabel.Nifti1Image(labels.astype(np.uint8), AFFINE), path)


def voxels(path):
    return np.asarray(nibabel.load(path).dataobj)


@pytest.fixture
def folder(tmp_path):
    save(tmp_path / "tumour.nii.gz", ball((24, 24, 24), 8) < 0)
    save(tmp_path / "cord.nii.gz", ball((38, 24, 24), 5) < 0)
    return tmp_path


def derive(folder, *words):
    """What is printed; a warning may say which voxels two structures share."""
    result = kontur("derive", *words, "-i", folder / "tumour.nii.gz", "-i", folder / "cord.nii.gz")
    assert result.returncode == 0, result
    return result.stdout


def test_a_margin_is_a_distance_in_space(folder):
    text = derive(folder, "PTV = tumour + 5 mm", "-o", folder / "ptv.nii.gz")
    assert text.startswith("PTV: 9")
    found, exact = voxels(folder / "ptv.nii.gz"), ball((24, 24, 24), 13)
    assert (found[exact < -1.25] == 1).all() and (found[exact > 1.25] == 0).all()


def test_a_margin_less_what_is_spared(folder):
    derive(folder, "PTV_opt = PTV - (cord + 3 mm)", "PTV = tumour + 5 mm", "-o", folder / "out.nii.gz")
    found, inside, beside = voxels(folder / "out.nii.gz"), ball((24, 24, 24), 13), ball((38, 24, 24), 8)
    assert (found[(inside < -1.25) & (beside > 1.25)] == 1).all()
    assert (found[(inside < -1.25) & (beside < -1.25)] == 2).all()


def test_rules_come_from_a_file(folder):
    (folder / "plan.rules").write_text("# margins\nPTV = tumour + 5 mm  # of the tumour\n\n'PTV # 2' = PTV - cord\n")
    derive(folder, "--rules", folder / "plan.rules", "-o", folder / "file.nii.gz")
    derive(folder, "PTV = tumour + 5 mm", "'PTV # 2' = PTV - cord", "-o", folder / "words.nii.gz")
    assert (voxels(folder / "file.nii.gz") == voxels(folder / "words.nii.gz")).all()


def test_the_table_has_each_structure_against_each_other(folder):
    derive(folder, "PTV = tumour + 5 mm", "Near = cord", "--table", folder / "table.csv")
    with open(folder / "table.csv", encoding="utf-8", newline="") as lines:
        rows = {(row["a"], row["b"]): row for row in csv.DictReader(lines)}
    assert set(rows) == {("tumour", "cord"), ("tumour", "PTV"), ("tumour", "Near"), ("cord", "PTV"), ("cord", "Near"), ("PTV", "Near")}
    apart, grown = rows["tumour", "cord"], rows["tumour", "PTV"]
    assert float(apart["least_distance_mm"]) == pytest.approx(2, abs=0.5)  # between the borders of voxels
    assert float(apart["overlap_ml"]) == 0
    assert float(apart["a_beyond_b_mm"]) == pytest.approx(14 + 8 - 5, abs=0.7)
    assert float(apart["a_beyond_b_x"]) == pytest.approx(16, abs=1)
    assert float(grown["b_beyond_a_mm"]) == pytest.approx(5, abs=1)
    assert float(grown["a_beyond_b_mm"]) == 0 and grown["a_beyond_b_x"] == ""
    assert float(grown["overlap_ml"]) == float(grown["volume_a_ml"])


def test_sources_are_written_when_asked_for(folder):
    derive(folder, "PTV = tumour + 5 mm", "--with-sources", "-o", folder / "all.seg.nrrd")
    text = succeed("inspect", folder / "all.seg.nrrd")
    assert "tumour" in text and "PTV" in text


def test_contours_of_one_structure_are_kept_with_their_rule(folder):
    derive(folder, "PTV = tumour + 5 mm", "-o", folder / "ptv.json")
    found = json.loads((folder / "ptv.json").read_text())
    assert found["structure"] == "PTV"
    assert found["provenance"]["rule_1"] == "PTV = tumour + 5 mm"
    assert len(found["planes"]) == 10
    # The middle slice's line lies 13 mm from the axis, to a fraction of a voxel.
    middle = min(found["planes"], key=lambda plane: abs(plane["origin"][2] - 25))
    radii = np.linalg.norm(np.array(middle["contours"][0]["points"])[:, :2] - [24, 24], axis=1)
    assert np.abs(radii - np.sqrt(13**2 - 1)).max() < 0.6


def test_the_same_bytes_for_any_number_of_threads(folder):
    for threads in (1, 3):
        derive(folder, "PTV = tumour + {5 mm, left 2 mm} - cord", "-o", folder / f"{threads}.nii.gz", "--threads", threads)
    assert (folder / "1.nii.gz").read_bytes() == (folder / "3.nii.gz").read_bytes()


@pytest.mark.parametrize("words, sentence", [
    (["PTV = tumor + 5 mm"], "rule `PTV = ^tumor + 5 mm`, column 7: there is no structure 'tumor'; there are tumour, cord, PTV"),
    (["PTV = tumour + 5"], "rule `PTV = tumour + 5^`, column 17: 'mm' is missing here"),
    (["A = B", "B = A"], "rules run in a circle: A needs B needs A"),
    (["tumour = cord + 1 mm"], "'tumour' is there; give what the rule makes another name"),
    (["A = body()"], "body() looks at an image, and none is given"),
    ([], "there are 0 rules; give at least 1"),
])
def test_what_is_no_rule_is_refused_at_its_place(folder, words, sentence):
    before = names(folder)
    result = kontur("derive", *words, "-i", folder / "tumour.nii.gz", "-i", folder / "cord.nii.gz", "-o", folder / "out.nii.gz")
    assert result.returncode == 65 and sentence in result.stderr, result
    assert names(folder) == before


@pytest.mark.parametrize("words, sentence", [
    ([], "nothing to write; give --output, --rtstruct or --table"),
    (["-o", "out.dcm"], "would refer to the DICOM images it was made on"),
    (["--rtstruct", "out.nii"], "does not end with .dcm"),
    (["--table", "out.txt"], "does not end with .csv"),
    (["-o", "out.json", "--with-sources"], "has room for 1 structure"),
    (["-o", "out.nii", "--type", "PTV=TUMOUR"], "it is NAME=TYPE with one of GTV, CTV, PTV, ORGAN, AVOIDANCE, EXTERNAL"),
    (["-o", "out.nii", "--type", "CTV=CTV"], "--type is for 'CTV', which is not written"),
    (["-o", "out.nii", "--rules", "none.rules"], "cannot read none.rules"),
])
def test_what_cannot_be_written_is_refused(folder, words, sentence):
    result = kontur("derive", "PTV = tumour + 5 mm", "-i", "tumour.nii.gz", *words, cwd=folder)
    assert result.returncode != 0 and sentence in result.stderr, result
    assert names(folder) == ["cord.nii.gz", "tumour.nii.gz"]


def test_structures_of_two_grids_are_refused(folder):
    nibabel.save(nibabel.Nifti1Image(np.ones((4, 4, 4), np.uint8), AFFINE), folder / "small.nii.gz")
    result = kontur("derive", "A = tumour | small", "-i", folder / "tumour.nii.gz", "-i", folder / "small.nii.gz", "-o", folder / "a.nii.gz")
    assert result.returncode == 65 and "4 x 4 x 4 voxels, that of the first structure 50 x 50 x 20" in result.stderr


def test_an_empty_result_is_told(folder):
    result = kontur("derive", "A = cord - 9 mm", "-i", folder / "cord.nii.gz", "-o", folder / "a.nii.gz")
    assert result.returncode == 0 and "'A' is empty: A = cord - 9 mm" in result.stderr
    assert not voxels(folder / "a.nii.gz").any()


def test_rois_become_a_structure_set_and_a_segmentation(tmp_path, images, structures):
    words = ["Ring = PTV + 2 mm - PTV", "Spared = Ring - (Bladder + 1 mm)", "-i", structures, "--image", images, "--use-image", "off"]
    result = kontur("derive", *words, "-o", tmp_path / "seg.dcm", "--rtstruct", tmp_path / "rs.dcm", "--type", "Spared=AVOIDANCE")
    assert result.returncode == 0, result
    checked = subprocess.run([sys.executable, SUPPORT / "check_rtstruct.py", tmp_path / "rs.dcm", images], capture_output=True, text=True)
    assert checked.returncode == 0, checked
    found = pydicom.dcmread(tmp_path / "rs.dcm")
    assert [roi.ROIName for roi in found.StructureSetROISequence] == ["Ring", "Spared"]
    assert [roi.ROIGenerationAlgorithm for roi in found.StructureSetROISequence] == ["AUTOMATIC", "AUTOMATIC"]
    assert [one.RTROIInterpretedType for one in found.RTROIObservationsSequence] == ["", "AVOIDANCE"]
    seg = pydicom.dcmread(tmp_path / "seg.dcm")
    assert [one.SegmentLabel for one in seg.SegmentSequence] == ["Ring", "Spared"]
    assert {one.SegmentAlgorithmName for one in seg.SegmentSequence} == {"kontur derive"}
    assert seg.SegmentSequence[1].SegmentDescription == "derived: Spared = Ring - (Bladder + 1 mm)"


def test_rules_add_structures_to_the_rois_of_segment(tmp_path, images, structures):
    (tmp_path / "plan.rules").write_text("Far = PTV + 2 mm - PTV\n")
    words = ["--image", images, "--use-image", "off"]
    result = kontur("segment", structures, "--roi", "PTV", "--roi", "Bladder", "--rules", tmp_path / "plan.rules", *words,
                    "-o", tmp_path / "all.nii", "--report", tmp_path / "report.json")
    assert result.returncode == 0, result
    alone = kontur("derive", "Far = PTV + 2 mm - PTV", "-i", structures, *words, "-o", tmp_path / "far.nii")
    assert alone.returncode == 0, alone
    together, far = voxels(tmp_path / "all.nii"), voxels(tmp_path / "far.nii")
    assert ((together == 3) == ((far == 1) & (together != 1) & (together != 2))).all() and (together == 3).any()
    report = json.loads((tmp_path / "report.json").read_text())
    assert [(one["label"], one["name"], one["rule"]) for one in report["derived"]] == [(3, "Far", "Far = PTV + 2 mm - PTV")]
    assert report["derived"][0]["voxels"] == (far == 1).sum()
    assert len(report["structures"]) == 2


def test_one_file_of_rules_serves_a_cohort(tmp_path, images, structures):
    (tmp_path / "plan.rules").write_text("Far = PTV + 2 mm - PTV\n")
    (tmp_path / "other.rules").write_text("Near = PTV + 1 mm\n")
    row = f"{structures},{images},PTV,off"
    (tmp_path / "cases.csv").write_text(f"contours,image,roi,use-image,output,rules\n{row},a.nii,\n{row},b.nii,other.rules\n")
    result = kontur("batch", tmp_path / "cases.csv", "--rules", tmp_path / "plan.rules", "--summary", tmp_path / "summary.json")
    assert result.returncode == 0, result
    cases = json.loads((tmp_path / "summary.json").read_text())["cases"]
    assert [case["derived"][0]["name"] for case in cases] == ["Far", "Near"]
    assert sorted(np.unique(voxels(tmp_path / "a.nii"))) == [0, 1, 2]
    # A changed rule makes its case again.
    (tmp_path / "plan.rules").write_text("Far = PTV + 3 mm - PTV\n")
    again = kontur("batch", tmp_path / "cases.csv", "--rules", tmp_path / "plan.rules", "--summary", tmp_path / "again.json")
    changed = json.loads((tmp_path / "again.json").read_text())["cases"]
    assert changed[0]["derived"][0]["voxels"] > cases[0]["derived"][0]["voxels"], again
    assert changed[1] == cases[1]


def test_rules_of_segment_are_for_rois(folder, tmp_path):
    (tmp_path / "plan.rules").write_text("A = B\n")
    result = kontur("segment", folder / "none.json", "--rules", tmp_path / "plan.rules", "--spacing-mm", "1", "-o", tmp_path / "a.nii")
    assert result.returncode == 65 and "--rules is for ROIs of an RTSTRUCT" in result.stderr, result
