# SPDX-License-Identifier: Apache-2.0
"""Several ROIs of one structure set at once, as pydicom and nibabel see them, and names of ROIs in other capitals."""
import copy
import json
import pathlib
import subprocess
import sys

import numpy
import pydicom
import pytest
from support import circle, kontur, names, read_nifti, real_data, write_planes

SUPPORT = pathlib.Path(__file__).parent.parent / "support"
BALLS = {"Bladder": ((-15.0, -25.0, 110.0), 3.5), "rectum": ((-15.0, -21.0, 110.0), 3.5), "PTV": ((-9.0, -31.0, 110.0), 2.5)}


@pytest.fixture(scope="module")
def images(tmp_path_factory):
    """A DICOM series of 9 axial slices, 2.5 mm apart."""
    folder = tmp_path_factory.mktemp("images") / "axial"
    subprocess.run([sys.executable, SUPPORT / "make_dicom_series.py", "axial", folder], check=True)
    return folder / "dicom"


@pytest.fixture(scope="module")
def structures(tmp_path_factory, images):
    """Three balls, two of which overlap, as the ROIs 1 to 3, and one without contours."""
    folder = tmp_path_factory.mktemp("structures")
    for name, (center, radius) in BALLS.items():
        planes = [circle("z", offset, center=center, radius=radius) for offset in (-1.5, 0, 1.5)]
        write_planes(folder / f"{name}.json", planes)
        result = kontur("convert", folder / f"{name}.json", folder / f"{name}.dcm", "--image", images)
        assert result.returncode == 0, result
    merged = pydicom.dcmread(folder / "Bladder.dcm")
    for sequence in ("StructureSetROISequence", "ROIContourSequence", "RTROIObservationsSequence"):
        items = [pydicom.dcmread(folder / f"{name}.dcm")[sequence].value[0] for name in BALLS]
        for number, (item, name) in enumerate(zip(items, BALLS), 1):
            if sequence == "StructureSetROISequence":
                item.ROINumber, item.ROIName = number, name
            else:
                item.ReferencedROINumber = number
        merged[sequence].value = items
    empty = pydicom.Dataset()
    empty.ROINumber, empty.ROIName, empty.ROIGenerationAlgorithm = 4, "CTV", ""
    empty.ReferencedFrameOfReferenceUID = merged.FrameOfReferenceUID
    merged.StructureSetROISequence.append(empty)
    merged.save_as(folder / "RS.dcm")
    return folder / "RS.dcm"


def one_by_one(folder, structures, images):
    """The mask of each ROI by itself."""
    masks = {}
    for name in BALLS:
        result = kontur("segment", structures, "--roi", name, "--image", images, "--output", folder / f"one_{name}.nii")
        assert result.returncode == 0, result
        masks[name] = read_nifti(folder / f"one_{name}.nii") != 0
    return masks


def test_several_rois_become_one_label_map(tmp_path, structures, images):
    masks = one_by_one(tmp_path, structures, images)
    words = ["--roi", "bladder", "--roi", "RECTUM", "--roi", "3", "--image", images]
    result = kontur("segment", structures, *words, "--output", tmp_path / "all.nii", "--report", tmp_path / "all.json")
    assert result.returncode == 0, result
    both = numpy.count_nonzero(masks["Bladder"] & masks["rectum"])
    assert both > 10
    sentence = f"{both} voxels of 'rectum' lie in 'Bladder', too, and keep its label 1"
    assert sentence in result.stderr
    expected = numpy.zeros(masks["PTV"].shape, int)
    for label, name in reversed(list(enumerate(BALLS, 1))):
        expected[masks[name]] = label
    numpy.testing.assert_array_equal(read_nifti(tmp_path / "all.nii"), expected)
    report = json.loads((tmp_path / "all.json").read_text())
    assert [(s["label"], s["name"], s["mask"]["voxels"]) for s in report["structures"]] == [
        (n, name, numpy.count_nonzero(masks[name])) for n, name in enumerate(BALLS, 1)]
    assert any(sentence in warning for warning in report["warnings"])
    digests = [report["provenance"][f"contours_sha256_{n}"] for n in (1, 2, 3)]
    assert len(set(digests)) == 3 and {"version", "options_1", "image_sha256"} <= set(report["provenance"])


def test_of_all_rois_the_smaller_keeps_what_it_shares(tmp_path, structures, images):
    small = [circle("z", offset, center=BALLS["Bladder"][0], radius=2.0) for offset in (-1.5, 0, 1.5)]
    write_planes(tmp_path / "small.json", small)
    assert kontur("convert", tmp_path / "small.json", tmp_path / "small.dcm", "--image", images).returncode == 0
    within = pydicom.dcmread(structures)
    within.ROIContourSequence[1].ContourSequence = pydicom.dcmread(tmp_path / "small.dcm").ROIContourSequence[0].ContourSequence
    within.save_as(tmp_path / "RS.dcm")  # the rectum is now in the bladder
    voxels = {}
    for words in (["--roi", "1", "--roi", "2"], ["--all-rois"]):
        result = kontur("segment", tmp_path / "RS.dcm", *words, "--image", images, "--output", tmp_path / "all.nii")
        assert result.returncode == 0, result
        voxels[words[0]] = numpy.count_nonzero(read_nifti(tmp_path / "all.nii") == 2)
    assert voxels["--roi"] == 0 < voxels["--all-rois"]
    assert "voxels of 'Bladder' lie in 'rectum', too, and keep its label 2" in result.stderr


def test_a_mask_that_needs_more_room_says_which_option_makes_it(tmp_path):
    write_planes(tmp_path / "a.json", [circle("z", 0)])
    words = ("segment", tmp_path / "a.json", "--spacing-mm", 1, "--output", tmp_path / "a.nii")
    assert "beyond the 1 mm of --margin-mm around the contours and is cut off there" in kontur(*words, "--margin-mm", 1).stderr
    assert "cut off" not in kontur(*words, "--margin-mm", 12).stderr


@pytest.mark.parametrize("together", [(), ("--together", "--may-overlap", "Bladder:rectum")])
def test_several_rois_become_layers_that_keep_what_overlaps(tmp_path, structures, images, together):
    words = ["--all-rois", "--image", images, *together]
    result = kontur("segment", structures, *words, "--output", tmp_path / "all.seg.nrrd")
    assert result.returncode == 0 and "keep its label" not in result.stderr, result
    assert kontur("segment", structures, *words, "--output", tmp_path / "all.dcm").returncode == 0
    [layers], [seg] = (json.loads(kontur("inspect", tmp_path / name, "--json").stdout) for name in ("all.seg.nrrd", "all.dcm"))
    said = ("number", "name", "voxels", "shared_voxels", "color")
    assert [{key: s[key] for key in said} for s in layers["segments"]] == [{key: s[key] for key in said} for s in seg["segments"]]
    assert [s["name"] for s in layers["segments"]] == list(BALLS) and layers["segments"][0]["shared_voxels"] > 10


def test_several_rois_become_a_seg_that_keeps_what_overlaps_and_an_rtstruct(tmp_path, structures, images):
    masks = one_by_one(tmp_path, structures, images)
    words = ["--roi", "PTV", "--roi", "Bladder", "--roi", "rectum", "--image", images]
    result = kontur("segment", structures, *words, "--output", tmp_path / "seg.dcm", "--rtstruct", tmp_path / "rs.dcm")
    assert result.returncode == 0, result
    assert "lie in" not in result.stderr
    seg = pydicom.dcmread(tmp_path / "seg.dcm")
    assert [item.SegmentLabel for item in seg.SegmentSequence] == ["PTV", "Bladder", "rectum"]
    voxels = numpy.zeros(3, int)
    for frame, group in zip(seg.pixel_array, seg.PerFrameFunctionalGroupsSequence):
        voxels[group.SegmentIdentificationSequence[0].ReferencedSegmentNumber - 1] += numpy.count_nonzero(frame)
    assert voxels.tolist() == [numpy.count_nonzero(masks[name]) for name in ("PTV", "Bladder", "rectum")]
    checked = subprocess.run([sys.executable, SUPPORT / "check_rtstruct.py", tmp_path / "rs.dcm", images], capture_output=True, text=True)
    assert checked.returncode == 0, checked
    assert [item.ROIName for item in pydicom.dcmread(tmp_path / "rs.dcm").StructureSetROISequence] == ["PTV", "Bladder", "rectum"]


@pytest.mark.parametrize(
    "words, part",
    [
        (["--roi", "Bladder", "--roi", "CTV"], "the ROI 'CTV' has no contour; at least 1 is needed"),
        (["--roi", "Bladder", "--roi", "1"], "the ROI '1' is named twice"),
        (["--roi", "Bladder", "--roi", "Liver"], "there is no ROI 'Liver'; the ROIs are: 1 'Bladder'"),
        (["--roi", "CTV"], "RS.dcm: the structure 'CTV' has no contour; at least 1 is needed"),
        (["--roi", "Bladder", "--roi", "PTV", "--mesh", "a.stl"], "--mesh has room for one structure"),
        (["--roi", "Bladder", "--roi", "PTV", "--name", "x"], "--name has room for one structure"),
        (["--roi", "Bladder", "--roi", "PTV", "--label-value", "7"], "--label-value is for one structure"),
    ],
)
def test_what_cannot_be_is_refused_and_leaves_nothing(tmp_path, structures, images, words, part):
    result = kontur("segment", structures, *words, "--image", images, "--output", "a.nii", cwd=tmp_path)
    assert result.returncode == 65, result
    assert part in result.stderr
    assert names(tmp_path) == []


def test_names_that_dicom_cannot_hold_are_told(tmp_path, structures, images):
    name = "x" * 70
    result = kontur("segment", structures, "--roi", "ptv", "--image", images, "--output", tmp_path / "seg.dcm", "--rtstruct",
                    tmp_path / "rs.dcm", "--name", name)
    assert result.returncode == 0, result
    assert result.stderr.count("has 70 characters, of which DICOM has room for 64") == 2
    assert pydicom.dcmread(tmp_path / "rs.dcm").StructureSetROISequence[0].ROIName == "x" * 64


def test_a_batch_makes_several_rois_of_a_row_as_segment_does(tmp_path, structures, images):
    (tmp_path / "RS.dcm").write_bytes(structures.read_bytes())
    (tmp_path / "cases.csv").write_text(
        f"case,contours,image,output,roi\nboth,RS.dcm,{images},all.nii,bladder; 3\none,RS.dcm,{images},one.nii,PTV\n")
    result = kontur("batch", tmp_path / "cases.csv", "--summary", tmp_path / "summary.json")
    assert result.returncode == 0, result
    assert "both: 2 structures, " in result.stdout
    words = ["--roi", "Bladder", "--roi", "PTV", "--image", images]
    segmented = kontur("segment", structures, *words, "--output", tmp_path / "expected.nii", "--report", tmp_path / "expected.json")
    assert segmented.returncode == 0, segmented
    numpy.testing.assert_array_equal(read_nifti(tmp_path / "all.nii"), read_nifti(tmp_path / "expected.nii"))
    expected = json.loads((tmp_path / "expected.json").read_text())["structures"]
    both, one = json.loads((tmp_path / "summary.json").read_text())["cases"]
    assert both["structures"] == [{key: s[key] for key in ("label", "name", "mask", "residual_mm", "section_check", "uncertainty")} for s in expected]
    assert both["residual_mm"]["max"] == max(s["residual_mm"]["max"] for s in expected)
    assert both["warnings"] == [f"{s['name']}: {warning}" for s in expected for warning in s["warnings"]]
    assert one["mask"] == expected[1]["mask"] and "structures" not in one


@pytest.mark.parametrize(
    "roi, part",
    [("Bladder;Bladder", "the ROI 'Bladder' is named twice"), ("Bladder;Liver", "there is no ROI 'Liver'"), (" ; ", "line 2: the cell below 'roi' names none")],
)
def test_a_batch_refuses_rois_that_make_no_sense(tmp_path, structures, images, roi, part):
    (tmp_path / "cases.csv").write_text(f"contours,image,output,roi\n{structures},{images},all.nii,{roi}\n")
    result = kontur("batch", tmp_path / "cases.csv")
    assert result.returncode in (1, 65) and part in result.stdout + result.stderr
    assert "all.nii" not in names(tmp_path)


def test_together_no_voxel_has_two_structures_that_exclude_each_other(tmp_path, structures, images):
    apart = one_by_one(tmp_path, structures, images)
    assert (apart["Bladder"] & apart["rectum"]).any()
    words = ("--all-rois", "--together", "--image", images)
    result = kontur("segment", structures, *words, "--output", tmp_path / "all.dcm", "--report", tmp_path / "all.json",
                    "--rtstruct", tmp_path / "all_rs.dcm")
    assert result.returncode == 0, result
    assert "'Bladder' and 'rectum': " in result.stderr
    masks = {}
    for number, name in enumerate(BALLS, 1):
        done = kontur("convert", tmp_path / "all.dcm", tmp_path / f"{name}.nii", "--label", number)
        assert done.returncode == 0, done
        masks[name] = read_nifti(tmp_path / f"{name}.nii") != 0
    if "'Bladder' and 'rectum': exclusive" in result.stderr:
        assert not (masks["Bladder"] & masks["rectum"]).any()
    report = json.loads((tmp_path / "all.json").read_text())
    assert [one["name"] for one in report["structures"]] == list(BALLS)  # CTV has no contours
    assert [one["mask"]["voxels"] for one in report["structures"]] == [int(masks[name].sum()) for name in BALLS]
    assert (masks["PTV"].sum() > 0) and pydicom.dcmread(tmp_path / "all_rs.dcm").Modality == "RTSTRUCT"


def masks_together(tmp_path, structures, images, *rules):
    """The mask of each ROI, all segmented together by these rules, and the report."""
    words = ("--all-rois", "--together", *rules, "--image", images, "--output", tmp_path / "all.dcm", "--report", tmp_path / "all.json")
    result = kontur("segment", structures, *words)
    assert result.returncode == 0, result
    masks = {}
    for number, name in enumerate(BALLS, 1):
        assert kontur("convert", tmp_path / "all.dcm", tmp_path / f"{name}.nii", "--label", number).returncode == 0
        masks[name] = read_nifti(tmp_path / f"{name}.nii") != 0
    return masks, json.loads((tmp_path / "all.json").read_text())["together"]


def test_rules_say_what_two_structures_are_to_each_other(tmp_path, structures, images):
    alone = one_by_one(tmp_path, structures, images)
    both = numpy.count_nonzero(alone["Bladder"] & alone["rectum"])
    masks, together = masks_together(tmp_path, structures, images, "--may-overlap", "bladder:RECTUM", "--inside", "3:1")
    assert numpy.count_nonzero(masks["Bladder"] & masks["rectum"]) == both
    assert not (masks["PTV"] & ~masks["Bladder"]).any() and (masks["PTV"] == alone["PTV"]).all()
    relations = {(pair["first"], pair["second"]): (pair["relation"], pair["given"], pair["shared_voxels"]) for pair in together["pairs"]}
    assert relations[("Bladder", "rectum")] == ("overlap", True, both)
    assert relations[("PTV", "Bladder")][:2] == ("inside", True)

    masks, together = masks_together(tmp_path, structures, images, "--exclusive", "rectum:Bladder")
    assert not (masks["Bladder"] & masks["rectum"]).any()
    assert together["contested_voxels"] >= both
    assert not ((alone["Bladder"] | alone["rectum"]) & ~(masks["Bladder"] | masks["rectum"] | masks["PTV"])).any()


def test_the_image_is_asked_for_each_structure(tmp_path, structures, images):
    masks_together(tmp_path, structures, images)
    report = json.loads((tmp_path / "all.json").read_text())
    assert [one["image"]["verdict"] in ("used", "no_help", "unknown", "labels") for one in report["structures"]] == [True] * 3


def test_of_all_rois_the_smaller_keeps_what_it_shares(tmp_path, structures, images):
    masks = one_by_one(tmp_path, structures, images)
    result = kontur("segment", structures, "--all-rois", "--image", images, "--output", tmp_path / "all.nii")
    assert result.returncode == 0, result
    labels = read_nifti(tmp_path / "all.nii")
    by_size = sorted(enumerate(BALLS, 1), key=lambda item: -numpy.count_nonzero(masks[item[1]]))
    sizes = [numpy.count_nonzero(masks[name]) for _, name in by_size]
    assert sizes[0] > sizes[1] and (masks["Bladder"] & masks["rectum"]).any()
    smaller = next(number for number, name in reversed(by_size) if name != "PTV")
    assert (labels[masks["Bladder"] & masks["rectum"]] == smaller).all()


def test_a_mask_that_needs_more_room_says_which_option_makes_it(tmp_path):
    write_planes(tmp_path / "a.json", [circle("z", 0)])
    words = ("segment", tmp_path / "a.json", "--spacing-mm", 1, "--output", tmp_path / "a.nii")
    assert "beyond the 1 mm of --margin-mm around the contours and is cut off there" in kontur(*words, "--margin-mm", 1).stderr
    assert "cut off" not in kontur(*words, "--margin-mm", 12).stderr


@pytest.mark.parametrize("together", [(), ("--together", "--inside", "far:Bladder")])
def test_of_all_rois_those_outside_of_the_image_are_left_out(tmp_path, structures, images, together):
    """One lies elsewhere, one is a line without area: the others are what they are without these."""
    more = pydicom.dcmread(structures)
    for sequence, number in (("StructureSetROISequence", "ROINumber"), ("ROIContourSequence", "ReferencedROINumber"),
                             ("RTROIObservationsSequence", "ReferencedROINumber")):
        more[sequence].value = [copy.deepcopy(more[sequence].value[0]), *more[sequence].value, copy.deepcopy(more[sequence].value[0])]
        for item, its in ((more[sequence].value[0], 8), (more[sequence].value[-1], 9)):
            setattr(item, number, its)
    more.StructureSetROISequence[0].ROIName, more.StructureSetROISequence[-1].ROIName = "far", "flat"
    for contour in more.ROIContourSequence[0].ContourSequence:
        contour.ContourData = [value + 500 for value in contour.ContourData]
    for contour in more.ROIContourSequence[-1].ContourSequence:
        contour.ContourData = [value if n % 3 else contour.ContourData[0] for n, value in enumerate(contour.ContourData)]
    more.save_as(tmp_path / "more.dcm")
    outputs = {}
    for name, file in (("all", structures), ("more", tmp_path / "more.dcm")):
        rules = [word for word in together if "far" not in word and (word != "--inside")] if name == "all" else together
        result = kontur("segment", file, "--all-rois", *rules, "--image", images, "--output", tmp_path / f"{name}.nii",
                        "--report", tmp_path / f"{name}.json")
        assert result.returncode == 0, result
        outputs[name] = result, json.loads((tmp_path / f"{name}.json").read_text())
    (_, before), (result, after) = outputs["all"], outputs["more"]
    assert [(one["name"], one["number"]) for one in before["left_out"]] == [("CTV", 4)] and len(before["structures"]) == 3
    assert [(one["name"], one["number"]) for one in after["left_out"]] == [("CTV", 4), ("flat", 9), ("far", 8)]
    assert [one["reason"] for one in after["left_out"][:2]] == ["there is no contour; at least 1 is needed"] * 2
    far = after["left_out"][2]["reason"]
    assert "contour points lie outside of the image" in far and f"the ROI 'far' is left out: {far}" in result.stderr
    assert "the ROI 'flat' is left out: " in result.stderr and "the ROI 'CTV'" not in result.stderr
    assert [one["name"] for one in after["structures"]] == list(BALLS)
    assert (read_nifti(tmp_path / "more.nii") == read_nifti(tmp_path / "all.nii")).all()
    named = kontur("segment", tmp_path / "more.dcm", "--roi", "far", "--roi", "Bladder", "--image", images, "--output", tmp_path / "x.nii")
    assert named.returncode == 65 and "ROI 'far': all " in named.stderr and not (tmp_path / "x.nii").exists(), named


def read_region_mesh(path):
    """Points, triangles with the regions behind and in front of them, and the regions' names."""
    header, body = path.read_bytes().split(b"end_header\n", 1)
    lines = header.decode().splitlines()
    points, faces = (int(next(line for line in lines if line.startswith(f"element {name}")).split()[2]) for name in ("vertex", "face"))
    names = {int(line.split()[3][:-1]): line.split(": ", 1)[1] for line in lines if line.startswith("comment kontur region")}
    rows = numpy.frombuffer(body, [("n", "u1"), ("corners", "<u4", 3), ("sides", "<u4", 2)], faces, 24 * points)
    assert (rows["n"] == 3).all() and len(body) == 24 * points + 21 * faces
    return numpy.frombuffer(body, "<f8", 3 * points).reshape(-1, 3), rows["corners"], rows["sides"], names


def test_surfaces_of_structures_that_touch_share_their_border(tmp_path, structures, images):
    words = ("--all-rois", "--together", "--exclusive", "1:2", "--may-overlap", "1:3", "--image", images, "--output", tmp_path / "all.nii")
    result = kontur("segment", structures, *words, "--mesh", tmp_path / "all.ply")
    assert result.returncode == 0, result
    points, corners, sides, names = read_region_mesh(tmp_path / "all.ply")
    assert names[0] == "outside" and {"Bladder", "rectum", "PTV"} <= {part for name in names.values() for part in name.split(" and ")}
    assert len(numpy.unique(points, axis=0)) == len(points) and corners.max() == len(points) - 1
    for structure in BALLS:
        inside = numpy.array([structure in names[n].split(" and ") for n in range(len(names))])
        own = inside[sides[:, 0]] != inside[sides[:, 1]]
        turned = numpy.where(inside[sides[own, 1]][:, None], corners[own][:, ::-1], corners[own])
        edges = numpy.concatenate([turned[:, [0, 1]], turned[:, [1, 2]], turned[:, [2, 0]]])
        forward, backward = (sorted(map(tuple, pair)) for pair in (edges, edges[:, ::-1]))
        assert forward == backward and own.any()
        a, b, c = (points[turned[:, n]] for n in range(3))
        assert (a * numpy.cross(b, c)).sum() > 0  # turned outward
    pair = [n for n, name in names.items() if name in ("Bladder", "rectum")]
    assert (numpy.isin(sides, pair).all(axis=1)).any()  # triangles known from both sides


def test_without_an_image_the_labels_lie_on_a_grid_around_all_that_was_drawn(tmp_path, structures):
    done = kontur("segment", structures, "--all-rois", "--together", "--spacing-mm", 1, "--margin-mm", 6, "--output", tmp_path / "all.nii.gz")
    assert done.returncode == 0, done
    labels = read_nifti(tmp_path / "all.nii.gz")
    assert set(numpy.unique(labels)) == {0, 1, 2, 3}
    for axis in range(3):  # 6 mm of room on each side
        seen = numpy.flatnonzero(labels.any(axis=tuple({0, 1, 2} - {axis})))
        assert seen[0] >= 1 and seen[-1] <= labels.shape[axis] - 2
    for number, name in enumerate(BALLS, 1):
        done = kontur("segment", structures, "--roi", name, "--spacing-mm", 1, "--output", tmp_path / f"{name}.nii", "--report", tmp_path / f"{name}.json")
        assert done.returncode == 0, done
        alone = json.loads((tmp_path / f"{name}.json").read_text())["mask"]["volume_ml"]
        assert (labels == number).sum() * 0.001 == pytest.approx(alone, rel=0.4), name  # the others take what they share
    done = kontur("segment", structures, "--all-rois", "--spacing-mm", 0.01, "--output", tmp_path / "huge.nii")
    assert done.returncode == 77 and "a spacing of 0.01 mm gives the mask" in done.stderr and not (tmp_path / "huge.nii").exists(), done


def test_together_small_structures_borrow_no_border_from_afar(tmp_path):
    """A scar at the rim of a tumour's bed and its block: their lines run 20 to 45 mm from what was drawn of it."""
    structures = real_data("09_rtstruct_breast_dicompyler") / "rtss.dcm"
    chosen = [word for name in ("Nodes", "Scar", "Tumor Bed", "Tumor Bed Block") for word in ("--roi", name)]
    done = kontur("segment", structures, *chosen, "--together", "--spacing-mm", 3, "--output", tmp_path / "all.nii", "--report", tmp_path / "all.json")
    assert done.returncode == 0 and "contradicts" not in done.stderr, done
    for one in json.loads((tmp_path / "all.json").read_text())["structures"]:
        done = kontur("segment", structures, "--roi", one["name"], "--spacing-mm", 3, "--output", tmp_path / "one.nii", "--report", tmp_path / "one.json")
        assert done.returncode == 0, done
        alone = json.loads((tmp_path / "one.json").read_text())["mask"]["volume_ml"]
        assert one["mask"]["volume_ml"] == pytest.approx(alone, rel=0.1, abs=0.1), one["name"]


@pytest.mark.parametrize("words, code, sentence", [
    (("--together", "--roi", "PTV"), 65, "--together is for several ROIs"),
    (("--all-rois", "--roi", "PTV"), 64, "--roi excludes --all-rois"),
    (("--all-rois", "--mesh", "out.stl"), 65, "--mesh has room for one structure"),
    (("--all-rois", "--together", "--mesh", "out.stl"), 65, "out.stl: the surfaces of several ROIs share their borders; only a .ply"),
    (("--all-rois", "--inside", "PTV:Bladder"), 64, "--inside requires --together"),
    (("--all-rois", "--together", "--inside", "PTV:GTV"), 65, "--inside is 'PTV:GTV'; two different ROIs of 'Bladder', 'rectum', 'PTV', 'CTV' are needed"),
    (("--all-rois", "--together", "--exclusive", "PTV"), 65, "--exclusive is 'PTV'; two different ROIs"),
    (("--all-rois", "--together", "--inside", "PTV:Bladder", "--may-overlap", "1:3"), 65, "2 rules are about 'Bladder' and 'PTV'; 1 is possible"),
])
def test_words_about_all_rois_that_make_no_sense(tmp_path, structures, images, words, code, sentence):
    result = kontur("segment", structures, *words, "--image", images, "--output", tmp_path / "out.nii")
    assert result.returncode == code and sentence in result.stderr and result.stderr.count("\n") == 1, result
    assert names(tmp_path) == []
