# SPDX-License-Identifier: Apache-2.0
"""kontur correct: outlines and strokes put a mask right, and nothing else changes."""
import json

import nibabel
import numpy as np
import pytest

from support import kontur, succeed

SPACING = (1.0, 1.0, 2.5)


@pytest.fixture
def case(tmp_path):
    """A ball with a bite, beside another label, and the ball's outline in the middle slice."""
    x, y, z = np.mgrid[:50, :50, :20] * np.array(SPACING)[:, None, None, None]
    ball = (x - 25) ** 2 + (y - 25) ** 2 + (z - 25) ** 2 < 15**2
    labels = np.where(ball & ~((x - 42) ** 2 + (y - 25) ** 2 + (z - 25) ** 2 < 64), 3, 0).astype(np.uint8)
    labels[2:6, 2:6, 2:6] = 7
    affine = np.diag([-1, -1, 1, 1]) @ np.diag([*SPACING, 1])
    nibabel.save(nibabel.Nifti1Image(labels, affine), tmp_path / "mask.nii.gz")
    angle = np.linspace(0, 2 * np.pi, 90, endpoint=False)
    write(tmp_path / "fix.json", np.stack([25 + 15 * np.cos(angle), 25 + 15 * np.sin(angle), 25 + 0 * angle], 1))
    return tmp_path, labels, ball


def write(path, points, **members):
    contour = {"points": np.round(points, 4).tolist()}
    if not members.pop("closed", True):
        contour["closed"] = False
    plane = {"origin": [0, 0, 25], "normal": [0, 0, 1], "u": [1, 0, 0], "v": [0, 1, 0], "contours": [contour]}
    path.write_text(json.dumps({"format": "kontur contours", "version": 1, "frame": "LPS mm", "planes": [plane], **members}))


def voxels(path):
    return np.asarray(nibabel.load(path).dataobj)


def dice(a, b):
    return 2 * (a & b).sum() / (a.sum() + b.sum())


def ring(z, radius):
    """The plane entry of a circle around the ball's axis."""
    angle = np.linspace(0, 2 * np.pi, 90, endpoint=False)
    points = np.stack([25 + radius * np.cos(angle), 25 + radius * np.sin(angle), z + 0 * angle], 1)
    return {"origin": [0, 0, z], "normal": [0, 0, 1], "u": [1, 0, 0], "v": [0, 1, 0],
            "contours": [{"points": np.round(points, 4).tolist()}]}


def image_of(case):
    """Shows the ball, with noise."""
    folder, labels, ball = case
    values = 100 * ball + np.random.default_rng(3).normal(size=ball.shape, scale=10)
    affine = np.diag([-1, -1, 1, 1]) @ np.diag([*SPACING, 1])
    nibabel.save(nibabel.Nifti1Image(values.astype(np.float32), affine), folder / "image.nii.gz")


def rings_of(heights):
    """Contours of the ball in some slices."""
    return [ring(z, np.sqrt(15**2 - (z - 25) ** 2)) for z in heights]


def save_planes(path, planes):
    path.write_text(json.dumps({"format": "kontur contours", "version": 1, "frame": "LPS mm", "planes": planes}))


def test_the_image_takes_part_from_three_planes_on(case):
    folder, labels, ball = case
    image_of(case)
    words = ["correct", "mask.nii.gz", "three.json", "--label", 3, "--image", "image.nii.gz", "-o", "new.nii.gz", "--report",
             "r.json"]
    for heights, planes in (([25], 0), ([20, 25, 30], 3)):
        save_planes(folder / "three.json", rings_of(heights))
        result = kontur(*words, cwd=folder)
        assert result.returncode == 0, result
        assert ("takes part from three" in result.stderr) == (planes == 0)
        assert json.loads((folder / "r.json").read_text())["image"]["planes_left_out"] == planes
    assert dice(voxels(folder / "new.nii.gz") == 3, ball) > 0.985
    succeed(*words, "--use-image", "off", cwd=folder)
    assert json.loads((folder / "r.json").read_text())["image"] is None


def test_a_mask_may_be_contours_on_the_images_slices(case):
    folder, labels, ball = case
    image_of(case)
    inside = [k for k in range(20) if ball[:, :, k].any()]
    smaller = rings_of([2.5 * k for k in inside])
    for plane in smaller[2:5]:
        points = np.array(plane["contours"][0]["points"])
        plane["contours"][0]["points"] = (np.array([25, 25, 0]) + (points - [25, 25, 0]) * [0.7, 0.7, 1]).tolist()
    save_planes(folder / "mask.json", smaller)
    save_planes(folder / "fix.json", rings_of([2.5 * inside[3]]))
    succeed("correct", "mask.json", "fix.json", "--image", "image.nii.gz", "--use-image", "off", "-o", "new.seg.nrrd", cwd=folder)
    succeed("convert", "new.seg.nrrd", "new.nii.gz", cwd=folder)
    new = voxels(folder / "new.nii.gz") != 0
    before = ball.copy()
    x, y, z = np.mgrid[:50, :50, :20] * np.array(SPACING)[:, None, None, None]
    for k in inside[2:5]:
        before[:, :, k] = ((x - 25) ** 2 + (y - 25) ** 2 < 0.49 * (15**2 - (z - 25) ** 2))[:, :, k]
    assert dice(new, ball) > dice(before, ball) + 0.01


def test_an_outline_mends_the_label_and_leaves_the_others(case):
    folder, labels, ball = case
    succeed("correct", "mask.nii.gz", "fix.json", "--label", 3, "-o", "new.nii.gz", "--report", "r.json",
            "--provenance-map", "who.nii.gz", cwd=folder)
    new, who, report = voxels(folder / "new.nii.gz"), voxels(folder / "who.nii.gz"), json.loads((folder / "r.json").read_text())
    assert new.dtype == labels.dtype
    assert dice(new == 3, ball) > dice(labels == 3, ball) + 0.01
    assert ((new == 7) == (labels == 7)).all()
    assert ((new == 3)[:, :, 10] == ball[:, :, 10]).mean() > 0.995
    assert (np.isin(who, (2, 4)) == ((new == 3) & (labels != 3))).all()
    assert (np.isin(who, (3, 5)) == ((new != 3) & (labels == 3))).all()
    assert report["planes"][0]["kind"] == "outline" and report["voxels"]["added_carried"] > 0
    assert report["volume_ml"] > report["volume_before_ml"]


def test_a_stroke_replaces_a_piece(case):
    folder, labels, ball = case
    angle = np.linspace(-0.7, 0.7, 30)
    write(folder / "stroke.json", np.stack([25 + 15 * np.cos(angle), 25 + 15 * np.sin(angle), 25 + 0 * angle], 1), closed=False)
    succeed("correct", "mask.nii.gz", "stroke.json", "--label", 3, "-o", "new.nii.gz", "--report", "r.json", cwd=folder)
    assert dice(voxels(folder / "new.nii.gz") == 3, ball) > dice(labels == 3, ball) + 0.01
    assert json.loads((folder / "r.json").read_text())["planes"][0]["kind"] == "piece"


def test_confirmed_planes_change_nothing(case):
    folder, labels, _ = case
    plane = {"origin": [25, 25, 25], "normal": [0, 0, 1], "u": [1, 0, 0], "v": [0, 1, 0]}
    (folder / "ok.json").write_text(json.dumps(
        {"format": "kontur contours", "version": 1, "frame": "LPS mm", "planes": [], "confirmed_planes": [plane]}))
    result = succeed("correct", "mask.nii.gz", "ok.json", "--label", 3, "-o", "new.nii.gz", cwd=folder)
    assert "nothing changed" in result
    assert (voxels(folder / "new.nii.gz") == labels).all()


def test_labels_follow_where_they_touched(case):
    """Half of a ball is 3, the other one 5; the border should lie farther on the side of 3."""
    folder, _, ball = case
    x, y, z = np.mgrid[:50, :50, :20] * np.array(SPACING)[:, None, None, None]
    labels = np.where(ball, np.where(x < 28, 3, 5), 0).astype(np.uint8)
    affine = np.diag([-1, -1, 1, 1]) @ np.diag([*SPACING, 1])
    nibabel.save(nibabel.Nifti1Image(labels, affine), folder / "halves.nii.gz")
    heights = np.sqrt(15**2 - (24 - 25) ** 2)
    line = np.linspace(-heights, heights, 60)
    write(folder / "line.json", np.stack([24 + 0 * line, 25 + line, 25 + 0 * line], 1), closed=False)
    words = ["correct", "halves.nii.gz", "line.json", "--label", 3, "-o"]
    succeed(*words, "alone.nii.gz", cwd=folder)
    followed = kontur(*words, "new.nii.gz", "--shared-borders", cwd=folder)
    alone, new = voxels(folder / "alone.nii.gz"), voxels(folder / "new.nii.gz")
    assert ((alone == 3) == (new == 3)).all() and ((alone == 5) == (labels == 5)).all()
    gap = ball & (alone == 0)
    assert gap[:, :, 10].sum() > 80
    inner = gap & ((x - 25) ** 2 + (y - 25) ** 2 + (z - 25) ** 2 < 10**2)
    assert (new[inner] == 5).all() and inner.sum() > 80
    assert (new[labels == 5] == 5).all() and (new[~ball] == 0).all()
    assert f"label 5 gets {(new == 5).sum() - (labels == 5).sum()} voxels of label 3" in followed.stderr


@pytest.mark.parametrize("words, said", [
    (["rings.json", "fix.json", "--image", "image.nii.gz", "--shared-borders"], "--shared-borders is for label maps"),
    (["mask.nii.gz", "fix.json"], "--label"),
    (["mask.nii.gz", "fix.json", "--label", "5"], "5"),
    (["mask.nii.gz", "fix.json", "--label", "3", "--reach", "9"], "between 0.25 and 4"),
    (["fix.json", "fix.json"], "with --image"),
    (["ball.stl", "fix.json"], "with --image"),
    (["mask.nii.gz", "fix.json", "--label", "3", "--image", "mask.nii.gz"], "holds labels"),
    (["mask.nii.gz", "fix.json", "--label", "3", "--use-image", "off"], "--use-image"),
    (["mask.nii.gz", "fix.json", "--mask-roi", "ball"], "--mask-roi"),
    (["rings.json", "fix.json", "--image", "image.nii.gz"], "fill 2 of the 6 slices"),
])
def test_what_cannot_be_understood_is_refused(case, words, said):
    folder, *_ = case
    (folder / "ball.stl").write_bytes(b"solid")
    image_of(case)
    rings = [ring(25, 14), ring(37.5, 8)]
    (folder / "rings.json").write_text(json.dumps(
        {"format": "kontur contours", "version": 1, "frame": "LPS mm", "planes": rings}))
    result = kontur("correct", *words, "-o", "new.nii.gz", cwd=folder)
    assert result.returncode != 0 and said in result.stderr
    assert not (folder / "new.nii.gz").exists()
