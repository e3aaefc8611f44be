# SPDX-License-Identifier: Apache-2.0
"""The benchmark runs, its solvers and searches agree, and its tables can be made."""
import csv
import json
import os
import pathlib
import subprocess
import sys
import xml.etree.ElementTree

import pytest

import drawings
from tables import filled, seconds

TABLES = pathlib.Path(__file__).parent / "tables.py"
GROWTH = TABLES.with_name("growth.py")
DOCS = pathlib.Path(__file__).parent.parent / "docs"


@pytest.fixture(scope="module")
def json_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("bench") / "quick.json"
    subprocess.run([os.environ["KONTUR_BENCH"], "--quick", "--json", path], check=True, timeout=100)
    return path


@pytest.fixture(scope="module")
def results(json_file):
    return json.loads(json_file.read_text())


def test_every_solver_meets_the_constraints(results):
    assert {row["solver"] for row in results["solving"]} == {"dense", "cholesky", "iterative"}
    assert max(row["residual_mm"] for row in results["solving"]) <= 1e-3


def test_tracking_finds_what_evaluating_every_voxel_finds(results):
    for normals in ("in-plane", "surface"):
        rows = [row for row in results["voxelizing"] if row["normals"] == normals]
        assert {row["voxelizer"] for row in rows} == {"tracked", "adaptive", "exhaustive"}
        assert len({row["surface_cells"] for row in rows if row["voxelizer"] != "adaptive"}) == 1
        assert all(row["jaccard_exhaustive"] == 1 for row in rows if row["voxelizer"] != "adaptive")
        assert min(row["jaccard_exhaustive"] for row in rows) > 0.9999
        evaluations = {row["voxelizer"]: row["evaluations"] for row in rows}
        assert evaluations["adaptive"] < 0.5 * evaluations["tracked"] < 0.5 * evaluations["exhaustive"]


def test_iterative_and_adaptive_come_close_to_the_exact_mask(results):
    shares = [row["jaccard_exact"] for row in results["end_to_end"] if "jaccard_exact" in row]
    assert len(shares) == 3 and min(shares) > 0.999


def test_pipelines_come_close_to_the_truth(results):
    assert min(row["dice_truth"] for row in results["end_to_end"]) > 0.99


def test_a_preview_has_the_time_of_each_stage(results):
    for row in results["editing"]:
        assert list(row["stages_s"]) == ["prepare", "fit", "mesh"]
        assert 0 < sum(row["stages_s"].values()) <= row["median_s"]


def test_a_correction_costs_less_where_the_mask_is_known(results):
    rows = {row["what"]: row for row in results["correcting"]}
    assert list(rows) == ["opened", "edited", "anew"] and min(row["cpu_s"] for row in rows.values()) > 0


def test_rules_are_worked_out_beside_a_preview(results):
    rows = {row["what"]: row for row in results["deriving"]}
    assert set(rows) == {"preview", "margin", "spared", "six lengths", "cropped to the body"}
    assert all((row["preview_and_this"] > 1) == (what != "preview") for what, row in rows.items())


def test_full_quality_is_what_the_others_are_compared_with(results):
    assert all((row["jaccard"] == 1) == (row["quality"] == 1) for row in results["reduction"])


def test_the_tables_show_every_experiment(json_file, results):
    tables = subprocess.run([sys.executable, TABLES, json_file], check=True, capture_output=True, text=True).stdout
    for row in (row for row in results["end_to_end"] if row["pipeline"] != "default, tight"):
        assert f"| {row['pipeline']} | {row['centres']:,} |" in tables
    for what in ("dsysv (Eq. 6 as printed)", "projected Cholesky", "iterative (default)", "tracked", "adaptive", "exhaustive"):
        assert f"| {what} |" in tables
    for row in results["reduction"]:
        assert f" | {100 * row['jaccard']:.2f} | {100 * row['dice_truth']:.2f} |" in tables
    for row in results["editing"]:
        assert f"| {row['edits']} | {seconds(row['median_s'])} |" in tables


def test_a_document_is_filled_between_its_markers_and_stays_as_it_is_elsewhere(json_file, tmp_path):
    names = ("machine", "solving", "voxelizing", "reduction", "end_to_end", "stages", "editing", "correcting")
    document = tmp_path / "performance.md"
    document.write_text("".join(f"before {n}\n<!-- begin {n} -->\nold\n<!-- end {n} -->\nafter\n" for n in names))
    for _ in range(2):
        subprocess.run([sys.executable, TABLES, json_file, document], check=True)
        text = document.read_text()
        assert "old" not in text and text.count("after\n") == len(names) and all(f"before {n}\n" in text for n in names)


@pytest.mark.parametrize("page, results", [("performance.md", "performance.json"), ("correct.md", "correcting.json")])
def test_the_published_tables_are_made_from_the_published_results(page, results, tmp_path):
    published = (DOCS / page).read_text()
    copy = tmp_path / page
    copy.write_text(published)
    subprocess.run([sys.executable, TABLES, TABLES.with_name("results") / results, copy], check=True)
    assert copy.read_text() == published


def test_the_tables_of_drawings_are_made_from_the_published_results():
    rows = list(csv.DictReader((TABLES.with_name("results") / "drawings.csv").read_text().splitlines()))
    published = (DOCS / "accuracy/drawings.md").read_text()
    assert filled(published, rows, drawings.TABLES) == published


def test_a_drawing_measured_by_one_fit_alone_leaves_the_others_empty():
    row = {"object": "ball", "drawing": "x", "contours": 3, "kontur": {"dice": 0.91234, "hausdorff95_mm": 1.04}}
    cells = drawings.flat(row)
    assert (cells["kontur_dice"], cells["kontur_hd95_mm"], cells["kontur_mean_mm"], cells["paper_dice"]) == ("0.9123", "1.0", "", "")


def test_growth_is_measured_tabulated_and_drawn(tmp_path):
    json_path, plot, document = tmp_path / "growth.json", tmp_path / "growth.svg", tmp_path / "performance.md"
    subprocess.run(
        [os.environ["KONTUR_BENCH"], "--growth", "--most", "2000", "--repeat", "1", "--json", json_path], check=True, timeout=100
    )
    growth = json.loads(json_path.read_text())["growth"]
    assert [row["n"] for row in growth["rows"][:2]] == [1000, 2000] and len(growth["rows"]) == 4
    assert all(row["residual_mm"] <= growth["tolerance_mm"] for row in growth["rows"])
    document.write_text("before\n<!-- begin growth -->\nold\n<!-- end growth -->\nafter\n")
    subprocess.run([sys.executable, GROWTH, json_path, plot, document], check=True)
    text = document.read_text()
    assert "old" not in text and text.startswith("before\n") and text.endswith("after\n") and text.count("| 1,000 |") == 2 and "| 2,000 |" not in text
    assert xml.etree.ElementTree.parse(plot).getroot().tag.endswith("svg")
