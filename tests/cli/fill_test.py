# SPDX-License-Identifier: Apache-2.0
"""kontur fill: a ball painted on some slices becomes a ball; what cannot be filled is refused in one sentence."""
import json

import nibabel
import numpy
import pytest
from support import ball_array, dice, kontur, names, read_nifti, succeed, write_nifti


def painted(step=4, axis=2):
    """The ball on every step-th slice across an axis, as label 5."""
    array = ball_array() * 5
    keep = numpy.arange(array.shape[axis]) % step == 1
    shape = [1, 1, 1]
    shape[axis] = -1
    return array * keep.reshape(shape).astype(array.dtype)


def read(path):
    return numpy.asarray(nibabel.load(path).dataobj)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_ball_is_filled_and_what_was_painted_stays(tmp_path, axis):
    sparse = painted(axis=axis)
    file = write_nifti(tmp_path / "sparse.nii.gz", sparse)
    text = succeed("fill", file, "--output", tmp_path / "full.nii.gz", "--report", tmp_path / "fill.json")
    full = read(tmp_path / "full.nii.gz")
    assert set(numpy.unique(full)) == {0, 5}
    assert (full[sparse > 0] == 5).all()
    between = numpy.flatnonzero(sparse.any(axis=tuple({0, 1, 2} - {axis})))
    inner = numpy.arange(between[0], between[-1] + 1)
    a, b = full.take(inner, axis) > 0, ball_array().take(inner, axis) > 0
    assert 2 * (a & b).sum() / (a.sum() + b.sum()) > 0.98
    report = json.loads((tmp_path / "fill.json").read_text())
    [label] = report["labels"]
    assert label["slices"][axis] == len(between) and sum(label["slices"]) == len(between)
    assert label["painted_voxels"] + label["added_voxels"] == (full == 5).sum()
    assert f"painted on {len(between)} slices across {'ijk'[axis]}; " in text
    assert report["provenance"]["options"].startswith("ends=closed")


def test_the_same_input_gives_the_same_bytes(tmp_path):
    file = write_nifti(tmp_path / "sparse.nii.gz", painted())
    for name, threads in (("a.nii", 1), ("b.nii", 2)):
        succeed("fill", file, "--output", tmp_path / name, "--threads", threads)
    assert (tmp_path / "a.nii").read_bytes() == (tmp_path / "b.nii").read_bytes()


def test_segments_keep_names(tmp_path):
    file = write_nifti(tmp_path / "sparse.nii.gz", painted())
    succeed("convert", file, tmp_path / "sparse.seg.nrrd")
    succeed("fill", tmp_path / "sparse.seg.nrrd", "--output", tmp_path / "full.seg.nrrd")
    before, after = ((tmp_path / name).read_bytes().split(b"\n\n")[0] for name in ("sparse.seg.nrrd", "full.seg.nrrd"))
    name = [line for line in before.split(b"\n") if line.startswith(b"Segment0_Name:=")]
    assert len(name) == 1 and name[0] in after


def test_whole_numbers_stored_as_floats_become_a_segmentation(tmp_path):
    file = write_nifti(tmp_path / "sparse.nii.gz", painted().astype("float32") * 100)
    for name in ("full.nii.gz", "full.seg.nrrd"):
        succeed("fill", file, "--output", tmp_path / name)
    assert b"type: int16" in (tmp_path / "full.seg.nrrd").read_bytes()
    succeed("convert", tmp_path / "full.seg.nrrd", tmp_path / "again.nii.gz")
    assert (read(tmp_path / "again.nii.gz") == read(tmp_path / "full.nii.gz")).all()
    result = kontur("fill", write_nifti(tmp_path / "big.nii.gz", painted().astype("float32") * 1e9), "--output", tmp_path / "big.seg.nrrd")
    assert result.returncode == 69 and "the labels 0 to 5000000000" in result.stderr and "integers of 32 bits" in result.stderr, result
    assert not (tmp_path / "big.seg.nrrd").exists()


def overlapping_segments(path):
    """Two balls of 3D Slicer that overlap, each a layer, painted on every fourth slice."""
    balls = [painted() > 0, numpy.roll(painted(), 4, axis=0) > 0]
    header = ["NRRD0004", "type: uint8", "dimension: 4", "space: left-posterior-superior", "sizes: 2 40 40 40",
              "space directions: none (1,0,0) (0,1,0) (0,0,1)", "kinds: list domain domain domain", "encoding: raw",
              "space origin: (-8,-27,-15)"]
    for n, name in enumerate(("cyst", "kidney")):
        header += [f"Segment{n}_ID:=s{n}", f"Segment{n}_Name:={name}", f"Segment{n}_LabelValue:={n + 1}", f"Segment{n}_Layer:={n}",
                   f"Segment{n}_Color:=1 0 0.5", f"Segment{n}_Tags:=Status:done|"]
    layers = numpy.stack([ball * (n + 1) for n, ball in enumerate(balls)], axis=-1).astype("u1")
    path.write_bytes("\n".join(header).encode() + b"\n\n" + layers.transpose(2, 1, 0, 3).tobytes())
    return balls


def test_segments_that_overlap_are_filled_each_by_itself(tmp_path):
    balls = overlapping_segments(tmp_path / "two.seg.nrrd")
    assert (balls[0] & balls[1]).any()
    refused = kontur("fill", tmp_path / "two.seg.nrrd", "--output", tmp_path / "full.nii")
    assert refused.returncode == 65 and "segments of" in refused.stderr and "overlap" in refused.stderr, refused
    assert names(tmp_path) == ["two.seg.nrrd"]
    succeed("fill", tmp_path / "two.seg.nrrd", "--label", 2, "--output", tmp_path / "full.seg.nrrd", "--report", tmp_path / "fill.json")
    assert b"Name:=kidney" in (tmp_path / "full.seg.nrrd").read_bytes() and b"cyst" not in (tmp_path / "full.seg.nrrd").read_bytes()
    [label] = json.loads((tmp_path / "fill.json").read_text())["labels"]
    succeed("convert", tmp_path / "full.seg.nrrd", tmp_path / "full.nii")
    full = read(tmp_path / "full.nii")
    assert set(numpy.unique(full)) == {0, 2} and (full[balls[1]] == 2).all()
    assert label["label"] == 2 and label["painted_voxels"] + label["added_voxels"] == (full == 2).sum()
    succeed("fill", write_nifti(tmp_path / "alone.nii", (balls[1] * 2).astype("u1")), "--output", tmp_path / "alone_full.nii")
    assert (full == read(tmp_path / "alone_full.nii")).all()
    report = succeed("fill", tmp_path / "two.seg.nrrd", "--output", tmp_path / "both.seg.nrrd", "--report", tmp_path / "fill.json")
    assert "label 1 (cyst): " in report and "label 2 (kidney): " in report
    assert [label["name"] for label in json.loads((tmp_path / "fill.json").read_text())["labels"]] == ["cyst", "kidney"]
    header = (tmp_path / "both.seg.nrrd").read_bytes()
    assert b"sizes: 2 40 40 40" in header and b"Segment1_Tags:=Status:done|" in header
    succeed("convert", tmp_path / "both.seg.nrrd", tmp_path / "second.nii", "--frame", 2)
    assert (read(tmp_path / "second.nii") == full).all()
    unknown = kontur("fill", tmp_path / "two.seg.nrrd", "--label", 7, "--output", tmp_path / "x.nii")
    assert unknown.returncode == 65 and "the label 7 is to be filled, but no segment has it" in unknown.stderr, unknown


def test_the_image_is_asked_and_said(tmp_path):
    noise = numpy.random.default_rng(5).normal(0, 10, ball_array().shape)
    file, image = write_nifti(tmp_path / "sparse.nii.gz", painted()), write_nifti(tmp_path / "mr.nii.gz", (ball_array() * 100 + noise).astype("int16"))
    text = succeed("fill", file, "--image", image, "--output", tmp_path / "full.nii.gz", "--report", tmp_path / "fill.json")
    [label] = json.loads((tmp_path / "fill.json").read_text())["labels"]
    assert label["image"]["verdict"] in ("used", "no_help") and label["image"]["planes_left_out"] > 0
    assert "label 5: " in text and "image" in text


@pytest.mark.parametrize("words, code, sentence", [
    (("--use-image", "auto"), 64, "--use-image requires --image"),
    (("--image", "sparse.nii.gz", "--use-image", "off"), 65, "--image is for --use-image auto"),
    (("--label", "9"), 65, "the label 9 is to be filled, but no voxel has it"),
    (("--smoothing-voxels", "-1"), 65, "the smoothing of the painted outlines"),
    (("--ends", "flat"), 64, "closed|half|open, not flat"),
    (("--report", "fill.txt"), 69, "fill.txt does not end with .json"),
])
def test_words_that_cannot_be_followed(tmp_path, words, code, sentence):
    file = write_nifti(tmp_path / "sparse.nii.gz", painted())
    result = kontur("fill", file, "--output", tmp_path / "full.nii.gz", *words)
    assert result.returncode == code and sentence in result.stderr and result.stderr.count("\n") == 1, result
    assert names(tmp_path) == ["sparse.nii.gz"]


def test_maps_that_cannot_be_filled(tmp_path):
    for array, sentence in ((painted() * 0, "nothing is painted"), (painted() * 0.5, "is no label map")):
        file = write_nifti(tmp_path / "sparse.nii.gz", array)
        result = kontur("fill", file, "--output", tmp_path / "full.nii.gz")
        assert result.returncode == 65 and sentence in result.stderr and "sparse.nii.gz" in result.stderr, result
        assert names(tmp_path) == ["sparse.nii.gz"]


def test_an_image_in_place_of_its_label_map_is_refused(tmp_path):
    noise = numpy.random.default_rng(5).normal(0, 10, ball_array().shape)
    file = write_nifti(tmp_path / "ct.nii.gz", (ball_array() * 100 + noise).astype("int16"))
    result = kontur("fill", file, "--output", tmp_path / "full.nii.gz")
    assert result.returncode == 65 and "ct.nii.gz: this looks like an image, not like a label map: " in result.stderr, result
    assert result.stderr.count("\n") == 1 and names(tmp_path) == ["ct.nii.gz"]


def test_nothing_left_out_is_said(tmp_path):
    file = write_nifti(tmp_path / "sparse.nii.gz", ball_array())
    result = kontur("fill", file, "--output", tmp_path / "full.nii.gz")
    assert result.returncode == 0 and "label 1: no slice was left out" in result.stderr
    assert (read(tmp_path / "full.nii.gz") == ball_array()).all()


def test_painted_slices_are_filled_on_a_finer_grid(tmp_path):
    """A ball painted on slices of 6 mm, wanted on slices of 1 mm."""
    def ball(spacing_k, count_k):
        i, j, k = numpy.meshgrid(numpy.arange(60), numpy.arange(60), numpy.arange(count_k), indexing="ij")
        return ((i - 30.0) ** 2 + (j - 29.0) ** 2 + (k * spacing_k - 30.0) ** 2 < 22.0**2).astype(numpy.uint8)

    coarse = write_nifti(tmp_path / "coarse.nii.gz", 3 * ball(6.0, 11), numpy.diag([1.0, 1.0, 6.0, 1.0]))
    truth = ball(1.0, 61)
    fine = write_nifti(tmp_path / "fine.nii.gz", truth, numpy.eye(4))
    result = kontur("fill", coarse, "--image", fine, "--on-image", "--use-image", "off", "--ends", "half", "-o", tmp_path / "full.nii.gz")
    assert result.returncode == 0, result
    full = read_nifti(tmp_path / "full.nii.gz")
    assert set(numpy.unique(full)) == {0, 3} and full.shape == truth.shape
    assert dice(full > 0, truth) > 0.98
    assert kontur("convert", coarse, tmp_path / "nearest.nii.gz", "--image", fine).returncode == 0
    assert dice(full > 0, truth) > dice(read_nifti(tmp_path / "nearest.nii.gz") > 0, truth) + 0.01
    for k in range(11):
        assert numpy.array_equal(full[..., 6 * k] > 0, ball(6.0, 11)[..., k] > 0)
    tilted = numpy.eye(4)
    tilted[0, 2] = tilted[2, 0] = 0.3
    write_nifti(tmp_path / "tilted.nii.gz", truth, tilted)
    result = kontur("fill", coarse, "--image", tmp_path / "tilted.nii.gz", "--on-image", "-o", tmp_path / "out.nii.gz")
    assert result.returncode == 65 and "its slices are not parallel to those of the image" in result.stderr, result
