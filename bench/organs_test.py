# SPDX-License-Identifier: Apache-2.0
"""Hands, shapes, slices and the command that compares kontur with its peers on organs."""
import csv
import json
import os
import pathlib
import subprocess
import sys
import xml.etree.ElementTree

import matplotlib
import nibabel
import numpy as np
import pytest

BENCH = pathlib.Path(__file__).parent
DOCS = BENCH.parent / "docs"
sys.path.insert(0, str(BENCH))
import hands
import losses
import organ_sources
import organs
import organs_report
import paper_steps
import plain
import shape_groups
import slices
import structures
import tables

SHEARED = np.array([[1.5, 0, 0, -40], [0, 1.5, -0.8, -30], [0, 0, 3, -20], [0, 0, 0, 1.0]])
PLANE = {"origin": [3, 4, 5], "normal": [0, 0, 1], "u": [1, 0, 0], "v": [0, 1, 0]}


def circle(radius, count=400):
    angles = 2 * np.pi * np.arange(count) / count
    return np.column_stack([3 + radius * np.cos(angles), 4 + radius * np.sin(angles), np.full(count, 5.0)])


def ellipsoid(shape, centre, radii):
    return sum(((axis - c) / r) ** 2 for axis, c, r in zip(np.indices(shape), centre, radii)) <= 1


def radii_of(points):
    return np.linalg.norm(points[:, :2] - (3, 4), axis=1)


@pytest.mark.parametrize("hand", hands.HANDS)
def test_a_hand_is_a_function_of_its_seed_and_stays_near_the_contour_in_its_plane(hand):
    drawn = [hands.HANDS[hand](circle(30), PLANE, 1.0, np.random.default_rng(seed)) for seed in (1, 1, 2)]
    assert np.array_equal(drawn[0], drawn[1])
    assert drawn[0].shape != drawn[2].shape or not np.allclose(drawn[0], drawn[2])
    assert np.allclose(drawn[0][:, 2], 5)
    assert np.abs(radii_of(drawn[0]) - 30).max() < 4


def test_waves_are_long_and_tremble_is_short_and_each_has_its_size():
    def spectrum(hand, seed):
        points = hands.HANDS[hand](circle(30), PLANE, 1.0, np.random.default_rng(seed))
        away = radii_of(points) - 30
        return np.abs(np.fft.rfft(away - away.mean())) ** 2 / len(away) ** 2

    for hand, rms in (("wave", hands.WAVE_MM), ("jitter", hands.JITTER_MM)):
        power = sum(spectrum(hand, seed)[:100] for seed in range(40)) / 40
        assert np.sqrt(2 * power[1:].sum()) == pytest.approx(rms, rel=0.15)
        within_waves = power[1:hands.WAVE_HARMONICS + 1].sum() / power[1:].sum()
        assert within_waves > 0.99 if hand == "wave" else within_waves < 0.4


def test_a_clicked_polygon_is_coarse_and_lies_on_half_voxels():
    voxel = 0.8
    points = hands.coarse(circle(30), PLANE, voxel, np.random.default_rng(3))
    assert hands.COARSE_LEAST <= len(points) < 2 * np.pi * 30 / hands.COARSE_STEP_MM
    steps = (points[:, :2] - (3, 4)) / (voxel / 2)
    assert np.abs(steps - np.rint(steps)).max() < 1e-9
    assert len(np.unique(np.rint(steps), axis=0)) > 6


def test_a_tiny_contour_moves_less_than_a_large_one():
    for hand in ("wave", "jitter"):
        moved = [np.std(radii_of(hands.HANDS[hand](circle(r), PLANE, 1.0, np.random.default_rng(5)))) for r in (1, 30)]
        assert moved[0] < moved[1] / 2


def test_shapes_fall_into_the_groups_that_one_would_name():
    grid = np.indices((60, 60, 60)) - 30
    x, y, z = grid
    rod = (x**2 + y**2 < 25) & (abs(z) < 28)
    rods = [abs(a) <= 28 for a in grid]
    tree = sum((a**2 + b**2 < 6) & c for a, b, c in ((x, y, rods[2]), (y, z, rods[0]), (z, x, rods[1]))) > 0
    for mask, group in ((x**2 + y**2 + z**2 < 400, "compact"), (rod, "elongated"), (tree, "thin or branched"),
                        ((abs(x) < 3) & (abs(y) < 25) & (abs(z) < 25), "thin or branched")):
        assert shape_groups.group(mask, np.eye(4)) == group
        coarse = np.diag([2, 0.5, 1, 1.0])
        assert shape_groups.group(np.repeat(mask[::2], 2, axis=1), coarse) == group  # the voxels' shape does not matter
    elongation, fill = shape_groups.measures(x**2 / 100 + y**2 / 100 + z**2 / 784 < 1, np.eye(4))
    assert elongation == pytest.approx(2.8, rel=0.02) and fill == pytest.approx(1, abs=0.15)


def test_filling_agrees_with_the_even_odd_rule_point_by_point():
    random = np.random.default_rng(0)
    contours = [random.uniform(2, 38, size=(n, 2)) for n in (5, 9, 30)]
    contours.append(np.array([[4, 4], [4, 20], [20, 20], [20, 4.0]]))  # through voxel centres
    points = np.indices((40, 40)).reshape(2, -1).T.astype(float)
    brute = plain.inside(contours, points + (1e-9, -1e-9)).reshape(40, 40)
    found = slices.filled(contours, (40, 40))
    assert found.any() and (found != brute).sum() <= 2 * 17  # on the edges through centres either is right


def test_slices_are_counted_from_the_first_occupied_one_and_numbered_in_a_sheared_grid():
    mask = np.zeros((4, 4, 20), bool)
    mask[1, 1, 3:15] = True
    assert slices.kept(mask, 4).tolist() == [3, 7, 11]
    assert not len(slices.kept(mask, 13))
    assert slices.kept(mask, 4, 2).tolist() == [5, 9, 13]
    planes = slices.slice_planes([0, 3, 7], SHEARED)
    assert np.allclose(slices.slice_numbers(planes, SHEARED), [0, 3, 7])


def test_shape_based_interpolation_of_a_cone_is_a_cone_between_the_kept_slices():
    x, y, z = np.indices((81, 81, 17)) - np.array([40, 40, 0]).reshape(3, 1, 1, 1)
    cone = np.hypot(x, y) < 10.2 + 1.5 * z
    found = slices.shape_based(cone, np.array([2, 6, 14]), (1, 1, 3))
    assert not found[:, :, :2].any() and not found[:, :, 15:].any()
    assert np.array_equal(found[:, :, [2, 6, 14]], cone[:, :, [2, 6, 14]])
    inner = found[:, :, 2:15], cone[:, :, 2:15]
    assert plain.dice(*inner) > 0.99
    assert plain.dice(slices.repeated(cone, np.array([2, 6, 14]), (1, 1, 3))[:, :, 2:15], cone[:, :, 2:15]) < 0.95


def test_shape_based_interpolation_ends_a_part_that_the_next_slice_does_not_have():
    mask = np.zeros((30, 30, 5), bool)
    mask[5:10, 5:10] = mask[20:26, 20:26, :4] = True
    found = slices.shape_based(mask, np.array([0, 4]), (1, 1, 1))
    assert found[5:10, 5:10].all() and found[22, 22, 0] and not found[20:26, 20:26, 3:].any()
    alone = slices.shape_based(mask & (np.arange(5) != 2), np.array([0, 2, 4]), (1, 1, 1))  # an empty slice is nowhere near
    assert not alone[:, :, 1:4].any()


def test_surfaces_two_voxels_apart_are():
    a = np.zeros((30, 30, 30), bool)
    a[5:25, 5:25, 5:15] = True
    assert organs.surface_distances(a, a, np.eye(4)) == (0, 0)
    b = np.zeros_like(a)
    b[3:27, 3:27, 3:17] = True
    p95, mean = organs.surface_distances(a, b, np.diag([1.5, 1.5, 1.5, 1]))
    assert 3 <= mean < 3.5 and p95 >= 3
    assert organs.surface_distances(a, np.zeros_like(a), np.eye(4)) == (np.inf, np.inf)


def test_errors_are_shared_out_between_the_hull_of_what_was_drawn_and_beyond():
    corners = np.array(np.meshgrid([2, 8], [2, 8], [2, 8])).reshape(3, -1).T.astype(float)
    within = losses.within_hull(corners @ SHEARED[:3, :3].T + SHEARED[:3, 3], (12, 12, 12), SHEARED)
    cube = np.zeros((12, 12, 12), bool)
    cube[2:9, 2:9, 2:9] = True
    assert np.array_equal(within, cube)
    truth, mask = np.zeros_like(cube), np.zeros_like(cube)
    truth[2:9, 2:9, 4:9] = True
    mask[2:9, 2:9, 3:8] = mask[2:9, 2:9, 10] = True
    assert losses.shares(mask, truth, within) == pytest.approx([1 / 5, 1 / 5, 1 / 5, 0])


def test_planes_of_another_seed_are_others_and_still_cut_the_object():
    points = np.argwhere(ellipsoid((40, 40, 40), (20, 20, 20), (15, 8, 6))).astype(float)
    for name in structures.PLANE_SETS:
        one, other = (structures.turned(name, points, np.random.default_rng(seed)) for seed in (1, 2))
        assert not np.allclose(one[0]["normal"], other[0]["normal"])
        for plane in one:
            u, v, normal = (np.array(plane[key]) for key in ("u", "v", "normal"))
            assert np.allclose(np.cross(u, v), normal) and np.linalg.norm(u) == pytest.approx(1)
            heights = (points - plane["origin"]) @ normal
            assert heights.min() < 0 < heights.max()


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    """A folder of scans with one label map: a ball, an egg and a cigar; no structure set."""
    folder = tmp_path_factory.mktemp("organs")
    labels = np.zeros((40, 40, 30), np.uint8)
    labels[ellipsoid(labels.shape, (13, 13, 10), (8, 8, 7))] = 2
    labels[ellipsoid(labels.shape, (28, 13, 12), (7, 7, 9))] = 3
    labels[ellipsoid(labels.shape, (20, 31, 10), (16, 5, 4.4))] = 4
    path = folder / "data" / organ_sources.LABEL_MAPS["brain"]
    path.parent.mkdir(parents=True)
    nibabel.save(nibabel.Nifti1Image(labels, np.diag([-1, -1, 1.5, 1])), path)
    return folder


def run(data, output, *extra):
    subprocess.run([sys.executable, BENCH / "organs.py", data / "data", data / output, "--kontur", os.environ["KONTUR"], *extra],
                   check=True, timeout=500, capture_output=True)
    return data / output


@pytest.fixture(scope="module")
def once(data):
    return run(data, "once", "--hands-every", "2")


def test_every_drawing_is_measured_by_every_method_that_can(once):
    rows = list(csv.DictReader((once / "results.csv").open()))
    groups = {row["structure"]: row["group"] for row in rows}
    assert groups == {"brain_002": "compact", "brain_003": "compact", "brain_004": "elongated"}
    for structure, with_hands in (("brain_002", True), ("brain_003", False), ("brain_004", True)):
        own = [row for row in rows if row["structure"] == structure]
        drawn = {(row["drawing"], row["hand"]) for row in own}
        planes = {(name, hand) for name in structures.PLANE_SETS for hand in ("exact", *(hands.HANDS if with_hands else ()))}
        # One slice in eight of the ball are its middle and a pole, which is too small to be drawn.
        kept = {(f"slices{step}", "exact") for step in slices.STEPS if structure != "brain_002" or step < 8}
        assert drawn == planes | kept
        for name, hand in drawn:
            methods = {row["method"] for row in own if (row["drawing"], row["hand"]) == (name, hand)}
            assert methods == {"kontur", "plain"} | ({"shape-based", "nearest slice"} if "slices" in name else set())
    exact = [float(row["dice"]) for row in rows if (row["method"], row["hand"], row["structure"]) == ("kontur", "exact", "brain_002")]
    assert min(exact) > 0.85
    between = {row["method"]: float(row["dice_left_out"]) for row in rows if (row["structure"], row["drawing"]) == ("brain_002", "slices2")}
    assert min(between.values()) > 0.85 and between["shape-based"] > between["nearest slice"]


def test_the_report_has_all_tables_and_plots(once):
    written = (once / "tables.md").read_text()
    for name in organs_report.TABLES:
        assert len(written.split(f"<!-- begin {name} -->")[1].split("<!-- end")[0].strip().splitlines()) > 3
    for plot in ("organs_gains.svg", "organs_slices.svg"):
        assert xml.etree.ElementTree.parse(once / plot).getroot().tag.endswith("svg")


def test_the_published_tables_and_plots_are_made_from_the_published_results(tmp_path):
    entries = organs_report.read(BENCH / "results/organs.csv")
    published = (DOCS / "accuracy/organs.md").read_text()
    for name in organs_report.TABLES:
        assert f"<!-- begin {name} -->\n| " in published
    assert tables.filled(published, entries, organs_report.TABLES) == published
    for name, make in organs_report.PLOTS.items():
        make(entries, tmp_path / name)
        published = (DOCS / "images" / name).read_text()
        if f"Matplotlib v{matplotlib.__version__}," in published:  # another release draws other bytes
            assert (tmp_path / name).read_text() == published


def test_losses_tell_what_is_wrong_with_each_method(once):
    done = subprocess.run([sys.executable, BENCH / "losses.py", once / "drawings", "--kontur", os.environ["KONTUR"], "--every", "3",
                           "--methods", "kontur", "in-plane normals", "r^3"], check=True, timeout=500, capture_output=True, text=True)
    rows = list(csv.DictReader(done.stdout.splitlines()))
    assert {row["structure"] for row in rows} == {"brain_002"} and len(rows) == 3 * (len(structures.PLANE_SETS) + 2)
    by_method = {row["method"]: row for row in rows if row["drawing"] == "ortho1x3"}
    assert len({row["dice"] for row in by_method.values()}) > 1
    for row in rows:
        too_much, missing = (sum(float(row[f"{kind} {where}"]) for where in ("within", "beyond")) for kind in ("too much", "missing"))
        assert float(row["dice"]) == pytest.approx(2 * (1 - missing) / (2 - missing + too_much), abs=1e-4)
    assert "| ortho1x3 | 1 | r^3 |" in done.stderr


def test_the_picture_of_losses_is_drawn(tmp_path):
    done = subprocess.run([sys.executable, BENCH / "loss_pictures.py", "--kontur", os.environ["KONTUR"], tmp_path / "losses.png"],
                          check=True, timeout=500, capture_output=True, text=True)
    assert (tmp_path / "losses.png").read_bytes().startswith(b"\x89PNG")
    dice = {tuple(line.rsplit(" ", 1)[0].split(": ")): float(line.rsplit(" ", 1)[1]) for line in done.stdout.splitlines()}
    assert dice["cut off flat", "shape-based"] > 0.95 > dice["cut off flat", "plain"]
    assert dice["a slanted plate of 6 mm", "shape-based"] < 0.8 < dice["a slanted plate of 6 mm", "kontur"]


def test_drawings_are_the_same_again_and_others_with_another_seed(data, once):
    again = run(data, "again", "--hands-every", "2", "--only", "draw")
    other = run(data, "other", "--hands-every", "2", "--only", "draw", "--seed", "x")
    names = [path.relative_to(once) for path in sorted(once.glob("drawings/*/*.json"))]
    assert len(names) == 5 * 3 + 5 * 3 * 2 + 2 + 3 + 3
    for name in names:
        assert (again / name).read_bytes() == (once / name).read_bytes()
        same = (other / name).read_bytes() == (once / name).read_bytes()
        assert same == name.stem.startswith("slices")


def test_the_papers_method_done_twice_gives_one_mask_from_the_same_points_offset_and_scatter(once):
    for path in (once / f"drawings/{drawing}.json" for drawing in ("brain_002/ortho3x3", "brain_003/oblique10")):
        truth, affine = plain.read_truth(path.with_name("truth.nii.gz"))
        ours = paper_steps.kontur_mask(path, os.environ["KONTUR"], *paper_steps.OURS["kontur's, offset, points and scatter"])
        peer = paper_steps.plain_mask(path, truth, affine)
        assert plain.dice(ours, peer) > 0.999
        assert plain.dice(paper_steps.plain_mask(path, truth, affine, offset_mm=3, smoothing=0.1), peer) < 0.998
