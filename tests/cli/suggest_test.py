# SPDX-License-Identifier: Apache-2.0
"""kontur suggest: planes in which to draw next, as text, JSON and files that other commands read."""
import itertools
import json

import nibabel
import numpy
import pytest
from scipy import ndimage
from support import CENTER, RADIUS, ball_array, kontur, lps_affine, succeed, voxel_centers, write_nifti, write_planes


def plane(origin, normal):
    normal = numpy.array(normal, float)
    u = numpy.roll(normal, 1)
    return {"origin": list(origin), "normal": normal.tolist(), "u": u.tolist(), "v": numpy.cross(normal, u).tolist(), "contours": []}


@pytest.fixture
def drawn(tmp_path):
    """Circles of a ball in so many of the planes of the axes, and the ball."""
    mask = write_nifti(tmp_path / "ball.nii.gz", ball_array())

    def draw(count):
        planes = write_planes(tmp_path / "axes.json", [plane(CENTER, n) for n in numpy.eye(3)[:count]])
        succeed("trace", mask, "--planes", planes, "--output", tmp_path / "drawn.json")
        return tmp_path / "drawn.json", mask

    return draw


def test_second_plane_is_across_the_first_and_nothing_is_known_of_the_error(drawn):
    contours, mask = drawn(1)
    found = json.loads(kontur("suggest", contours, "--image", mask, "--json").stdout)
    [suggested] = found["planes"]
    assert abs(numpy.dot(suggested["normal"], numpy.eye(3)[0])) < 1e-6
    assert "expected_dice" not in suggested
    assert found["about"] == "1 plane does not tell how sure the surface is; 3 are needed"


def test_planes_are_written_for_trace_and_sketches_for_segment(drawn, tmp_path):
    contours, mask = drawn(3)
    result = succeed("suggest", contours, "--image", mask, "--planes", 2, "--output", tmp_path / "planes.json",
                     "--sketch", tmp_path / "sketch.json")
    assert len(result.splitlines()) == 4 and "expected Dice" in result
    assert "the image is a mask or a label map; not used" in result
    planes = json.loads((tmp_path / "planes.json").read_text())["planes"]
    assert len(planes) == 2
    succeed("trace", mask, "--planes", tmp_path / "planes.json", "--output", tmp_path / "more.json")
    traced = json.loads((tmp_path / "more.json").read_text())["planes"]
    sketched = json.loads((tmp_path / "sketch.json").read_text())["planes"]
    assert [len(p["contours"]) for p in traced] == [len(p["contours"]) for p in sketched] == [1, 1]
    for one in sketched:
        points = numpy.array(one["contours"][0]["points"]) - CENTER
        assert numpy.abs(numpy.linalg.norm(points, axis=1) - RADIUS).max() < 2
    succeed("segment", contours, tmp_path / "sketch.json", "--image", mask, "--output", tmp_path / "all.nii.gz")


def test_slices_of_the_image_are_whole_layers(drawn):
    contours, mask = drawn(3)
    found = json.loads(succeed("suggest", contours, "--image", mask, "--planes", 2, "--among", "image-slices", "--json"))
    for suggested in found["planes"]:
        axis = "ijk".index(suggested["slice"]["axis"])
        assert abs(suggested["normal"][axis]) == pytest.approx(1)
        assert suggested["slice"]["index"] >= 0
        assert suggested["expected_dice_with_it"]["value"] >= suggested["expected_dice"]["value"]


def test_skipping_gives_other_planes_in_order(drawn):
    contours, mask = drawn(3)

    def suggested(*words):
        return json.loads(succeed("suggest", contours, "--image", mask, "--json", *words))["planes"]

    [best], [second], [third] = suggested(), suggested("--skip", 1), suggested("--skip", 2)
    assert best["gain"] > 0  # after three planes by another rule than the gain
    # Each is the best that shifting and tilting leads to: the next search may end a little higher.
    assert second["gain"] > 0.98 * third["gain"] > 0
    for one, other in ((best, second), (best, third), (second, third)):
        is_parallel = abs(numpy.dot(one["normal"], other["normal"])) > 1 - 1e-9
        apart = abs(numpy.dot(one["normal"], numpy.subtract(one["origin_mm"], other["origin_mm"])))
        assert not is_parallel or apart > 0.05 * RADIUS
    assert suggested("--skip", 0) == [best]


def test_an_empty_plane_is_not_suggested_again_and_the_surface_keeps_out_of_it(drawn, tmp_path):
    contours, mask = drawn(1)
    above = plane(numpy.add(CENTER, [0.6 * RADIUS, 0, 0]), [1, 0, 0])
    empty = write_planes(tmp_path / "empty.json", [above])
    whole = json.loads(contours.read_text()) | {"empty_planes": [above]}
    (tmp_path / "whole.json").write_text(json.dumps(whole))
    sketches = []
    for words in ([contours, "--empty-planes", empty], [tmp_path / "whole.json"], [contours]):
        kontur("suggest", *words, "--image", mask, "--planes", 3, "--sketch", tmp_path / "s.json", "--output", tmp_path / "p.json")
        points = [c["points"] for p in json.loads((tmp_path / "s.json").read_text())["planes"] for c in p["contours"]]
        sketches.append(numpy.vstack(points)[:, 0].max() - CENTER[0])
    assert sketches[0] == sketches[1] < 0.6 * RADIUS < sketches[2]


@pytest.fixture
def lobed(tmp_path):
    """A ball with lobes and hollows between four drawn planes: its contours, and an image that shows it."""
    affine = lps_affine(1.5, (-45, -45, -45))
    centers = voxel_centers((61, 61, 61), affine)
    distance = numpy.linalg.norm(centers, axis=-1) + 1e-9
    radius = numpy.full(distance.shape, 30.0)
    for x, y, z in itertools.product((-1, 1), repeat=3):
        apart = centers / distance[..., None] - (0.6 * x, 0.5 * y, 0.62 * z)
        radius += 7 * x * y * z * numpy.exp(-(apart**2).sum(-1) / 0.18)
    mask = write_nifti(tmp_path / "body.nii.gz", (distance < radius).astype(numpy.uint8), affine)
    noise = numpy.random.default_rng(7).normal(0, 8, distance.shape)
    image = write_nifti(tmp_path / "ct.nii.gz", (60 + 40 * numpy.tanh((radius - distance) / 1.5) + noise).astype(numpy.float32), affine)
    drawn = [plane((0, 0, -8), (0, 0, 1)), plane((0, 0, 5), (0, 0, 1)), plane((4, 0, 0), (1, 0, 0)), plane((0, -3, 0), (0, 1, 0))]
    succeed("trace", mask, "--planes", write_planes(tmp_path / "four.json", drawn), "--output", tmp_path / "drawn.json")
    return tmp_path / "drawn.json", image


def test_what_the_image_knows_counts_less(lobed, tmp_path):
    contours, image = lobed
    words = ("suggest", contours, "--image", image, "--planes", 2)
    plain, asked = (json.loads(succeed(*words, "--json", *more)) for more in (("--use-image", "off"), ()))
    assert "image" not in plain
    assert asked["image"]["verdict"] == "used"
    expected = [found["planes"][0]["expected_dice"]["value"] for found in (plain, asked)]
    assert expected[0] + 0.01 < expected[1]
    assert [p["normal"] for p in plain["planes"]] != [p["normal"] for p in asked["planes"]]
    assert asked["image"]["sentence"] in succeed(*words).splitlines()
    assert "image" not in succeed(*words, "--use-image", "off")

    # What the report of segment says, and a suggestion from an image that tells nothing is that without one.
    succeed("segment", contours, "--image", image, "--output", tmp_path / "m.nii.gz", "--report", tmp_path / "r.json")
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["image"]["sentence"] == asked["image"]["sentence"]
    assert report["uncertainty"]["expected_dice"]["value"] == expected[1]
    noise = numpy.random.default_rng(1).normal(0, 8, (61, 61, 61)).astype(numpy.float32)
    write_nifti(image, noise, lps_affine(1.5, (-45, -45, -45)))
    blank = json.loads(succeed(*words, "--json"))
    assert blank["image"]["verdict"] == "no_help" and blank["planes"] == plain["planes"]


def test_works_without_an_image(drawn):
    contours, _ = drawn(3)
    assert "1: through" in kontur("suggest", contours).stdout


@pytest.mark.parametrize("words, sentence", [
    (["--among", "image-slices"], "slices of an image are asked for; give --image"),
    (["--use-image", "auto"], "--use-image requires --image"),
    (["--output", "planes.txt"], "planes.txt does not end with .json"),
])
def test_says_what_is_wrong(drawn, tmp_path, words, sentence):
    contours, _ = drawn(3)
    result = kontur("suggest", contours, *words, cwd=tmp_path)
    assert result.returncode in (64, 65, 69) and sentence in result.stderr, result.stderr


def test_report_and_summary_of_segment_say_how_sure_the_surface_is(drawn, tmp_path):
    contours, mask = drawn(3)
    result = succeed("segment", contours, "--image", mask, "--output", tmp_path / "m.nii.gz", "--report", tmp_path / "r.json")
    told = json.loads((tmp_path / "r.json").read_text())["uncertainty"]
    assert told["known"] and told["planes"] == 3
    assert told["expected_dice"]["low"] < told["expected_dice"]["value"] < told["expected_dice"]["high"]
    truth_ml = 4 / 3 * numpy.pi * RADIUS**3 / 1000
    assert told["volume_ml"]["low"] < truth_ml < told["volume_ml"]["high"]
    assert "expected Dice" in result

    contours, _ = drawn(2)
    kontur("segment", contours, "--image", mask, "--output", tmp_path / "m.nii.gz", "--report", tmp_path / "r.json")
    assert json.loads((tmp_path / "r.json").read_text())["uncertainty"] == {"planes": 2, "known": False}


def test_band_is_written_as_image_and_as_property_of_a_ply(drawn, tmp_path):
    contours, mask = drawn(3)
    for name in ("band.nii.gz", "band.ply"):
        succeed("segment", contours, "--image", mask, "--output", tmp_path / "m.nii.gz", "--uncertainty", tmp_path / name)
    band = numpy.asarray(nibabel.load(tmp_path / "band.nii.gz").dataobj)
    inside = numpy.asarray(nibabel.load(tmp_path / "m.nii.gz").dataobj) > 0
    border = inside & ~ndimage.binary_erosion(inside)
    assert (band[border] > 0).all() and (band[ndimage.binary_erosion(inside, iterations=2)] == 0).all()
    assert b"property float half_width_mm\n" in (tmp_path / "band.ply").read_bytes()[:1000]

    contours, _ = drawn(2)
    result = kontur("segment", contours, "--image", mask, "--output", tmp_path / "n.nii.gz", "--uncertainty", tmp_path / "n.nii")
    assert result.returncode == 65
    assert "contours lie in 2 different planes; of fewer than 3 nothing is known" in result.stderr
    assert not (tmp_path / "n.nii.gz").exists()


@pytest.fixture
def wrong(tmp_path):
    """An image of the ball, and a mask of it as label 2 that is too wide around one slice, beside another label."""
    ball = ball_array()
    noise = numpy.random.default_rng(47).normal(scale=8, size=ball.shape)
    image = write_nifti(tmp_path / "image.nii.gz", (100 * ball + noise).astype(numpy.float32))
    k = ball.shape[2] // 2 + 4
    labels = 2 * ball.astype(numpy.uint8)
    labels[..., k - 2 : k + 3][ndimage.binary_dilation(ball[..., k - 2 : k + 3], iterations=4)] = 2
    labels[:2, :2, :2] = 5
    return write_nifti(tmp_path / "labels.nii.gz", labels), image, k


def test_of_a_mask_the_plane_is_where_its_border_is_unlike_the_image(wrong, tmp_path):
    mask, image, k = wrong
    words = ["suggest", "--mask", mask, "--label", 2, "--image", image, "--among", "image-slices"]
    found = json.loads(succeed(*words, "--json", "--output", tmp_path / "planes.json", "--sketch", tmp_path / "sketch.json"))
    [one] = found["planes"]
    assert one["slice"]["axis"] == "k" and abs(one["slice"]["index"] - k) <= 2, one
    assert one["doubtful_mm2"] > 0 and "misses whole wrong parts" in found["about"]
    [plane] = json.loads((tmp_path / "planes.json").read_text())["planes"]
    assert plane["origin"] == pytest.approx(one["origin_mm"], abs=1e-6)
    sketched = json.loads((tmp_path / "sketch.json").read_text())["planes"]
    assert len(sketched[0]["contours"]) == 1
    after = json.loads(succeed("suggest", tmp_path / "sketch.json", *words[1:], "--json"))
    assert after["planes"][0]["slice"] != one["slice"], "the sketch confirms the plane as it is"
    skipped = json.loads(succeed(*words, "--json", "--skip", 1))
    assert skipped["planes"][0]["slice"] == after["planes"][0]["slice"]
    assert f"slice k = {one['slice']['index']}; " in succeed(*words)


@pytest.mark.parametrize("words, said", [
    ([], "CONTOURS is required"),
    (["--mask", "labels.nii.gz"], "--mask requires --image"),
    (["--mask", "labels.nii.gz", "--image", "image.nii.gz"], "--label"),
    (["--mask", "labels.nii.gz", "--image", "labels.nii.gz", "--label", "2"], "holds labels"),
    (["--mask", "labels.nii.gz", "--image", "image.nii.gz", "--label", "2", "--kernel", "biharmonic"], "--mask excludes --kernel"),
])
def test_of_a_mask_what_makes_no_sense_is_refused(wrong, tmp_path, words, said):
    result = kontur("suggest", *words, cwd=tmp_path)
    assert result.returncode in (2, 64, 65) and said in result.stderr, result
