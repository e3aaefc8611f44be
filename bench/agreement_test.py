# SPDX-License-Identifier: Apache-2.0
"""bench/agreement.py: the phantom's sections, and each of its measurements on a small body."""
import csv
import json
import pathlib
import subprocess
import sys

import kontur
import nibabel
import numpy as np
import pytest

import agreement
import phantom_sections
import tables

BENCH = pathlib.Path(__file__).parent


@pytest.fixture(scope="module")
def metastasis():
    return phantom_sections.Organ("metastasis_parallel17")


def test_sections_lie_on_the_surface_in_their_planes_and_have_as_many_points_as_asked(metastasis):
    planes = agreement.oblique(metastasis.box, 5, 1)
    contours = phantom_sections.sections(metastasis.body, planes, 500)
    assert contours.point_count == 500
    for contour in contours:
        assert np.abs(metastasis.body.values(contour.points)).max() < 1e-6
        assert np.abs(contour.plane.distance_to(contour.points)).max() < 1e-9
        sides = np.linalg.norm(contour.points - np.roll(contour.points, 1, axis=0), axis=1)
        assert sides.max() < 2 * sides.mean()


def test_sections_are_those_of_the_phantoms_own_drawing():
    drawn = kontur.phantom_case("vertebra_parallel11")
    planes = list({tuple(contour.plane.origin): contour.plane for contour in drawn.contours}.values())
    found = phantom_sections.sections(drawn.body, planes, drawn.contours.point_count)
    assert sorted(contour.hole for contour in found) == sorted(contour.hole for contour in drawn.contours)
    masks = [kontur.segment(contours, drawn.grid).mask for contours in (found, drawn.contours)]
    assert kontur.compare(*masks).dice > 0.998


def test_shares_are_whole_and_exact_in_sum():
    assert phantom_sections.shares([1, 1, 1], 10).tolist() == [4, 3, 3]
    assert phantom_sections.shares([3.0, 1.0], 8).tolist() == [6, 2]


def test_the_first_plane_of_a_stack_is_a_share_of_a_gap_inside(metastasis):
    low, high = metastasis.box[:, 2]
    heights = [plane.origin[2] for plane in agreement.stack(metastasis.box, 2, 4.0, 0.3)]
    assert heights[0] == pytest.approx(low + 1.2) and np.allclose(np.diff(heights), 4) and 0 < high - heights[-1] <= 4


def test_more_planes_agree_better_and_every_direction_and_method_is_measured(metastasis):
    rows = [dict(zip(agreement.COUNT_FIELDS, row)) for row in agreement.rows_by_count([metastasis], counts=(3, 8))]
    assert len(rows) == 2 * (2 + agreement.SERIES) * 2
    few, many = ([float(r["dice"]) for r in rows if r["planes"] == n and r["method"] == "kontur"] for n in (3, 8))
    assert min(few) > 0.8 and np.mean(many) > np.mean(few)


def test_what_lies_beyond_the_ends_is_counted_there_alone():
    grid = kontur.Grid.from_spacing([10, 10, 10], [1, 1, 1])
    truth, made = np.zeros((10, 10, 10), np.uint8), np.zeros((10, 10, 10), np.uint8)
    truth[2:8, 2:8, 2:8] = 1
    made[3:9, 2:8, 2:8] = 1  # the last axis is x
    contours = kontur.ContourSet([kontur.Contour([[2, 2, z], [7, 2, z], [7, 7, z]]) for z in (3.0, 7.0)])
    beyond = agreement.beyond_ends(kontur.Mask(made, grid), kontur.Mask(truth, grid), contours, 2)
    assert [float(share) for share in beyond] == pytest.approx([100 / 6, 100 / 6], abs=0.01)


def test_a_drawing_stored_otherwise_gives_the_same_mask(tmp_path):
    x, y, z = np.indices((40, 40, 40)) - 19.5
    truth = (x / 14) ** 2 + (y / 12) ** 2 + (z / 10) ** 2 < 1
    folder = tmp_path / "body"
    folder.mkdir()
    nibabel.save(nibabel.Nifti1Image(truth.astype(np.uint8), np.diag([-1.0, -1, 1, 1])), folder / "truth.nii.gz")
    turns = np.linspace(0, 2 * np.pi, 50, endpoint=False)
    planes = []
    for height in (-6, -2, 2, 6):
        size = np.sqrt(1 - (height / 10) ** 2)
        ring = 19.5 + np.column_stack([14 * size * np.cos(turns), 12 * size * np.sin(turns), np.full(50, height)])
        planes.append({"origin": ring[0].tolist(), "normal": [0, 0, 1], "contours": [{"points": ring.tolist()}]})
    (folder / "slices.json").write_text(json.dumps({"frame": "LPS mm", "planes": planes}))
    done = subprocess.run([sys.executable, BENCH / "agreement.py", "stored", tmp_path], check=True, capture_output=True, text=True)
    rows = [line.split(",") for line in done.stdout.splitlines()]
    assert rows[0] == agreement.STORED_FIELDS and [row[2] for row in rows[1:]] == [name for name, _, _ in agreement.ways()]
    assert min(float(row[3]) for row in rows[1:]) > 0.999 and max(float(row[6]) for row in rows[1:]) < 0.05


def test_the_published_table_is_made_from_the_published_results():
    with open(BENCH / "results/counts.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    published = (BENCH.parent / "docs/accuracy/drawings.md").read_text()
    assert tables.filled(published, rows, {"counts": agreement.count_table}) == published


def test_the_plot_and_the_table_show_every_direction(tmp_path):
    table = tmp_path / "counts.csv"
    lines = [",".join(agreement.COUNT_FIELDS)]
    for direction in agreement.DIRECTIONS:
        for method in ("kontur", "paper"):
            lines += [f"ball,{direction},1,{n},{n},{method},{1 - 0.5 / n},{9 / n},{1 / n}" for n in (3, 5, 8)]
    table.write_text("\n".join(lines) + "\n")
    done = subprocess.run([sys.executable, BENCH / "agreement.py", "plot", table, tmp_path / "plot.svg"], check=True,
                          capture_output=True, text=True)
    assert "| ball | .833, .833, .833 | .900, .900, .900 |" in done.stdout
    assert all(f">{word}</text>" in (tmp_path / "plot.svg").read_text() for word in (*agreement.DIRECTIONS, "the paper's method"))
