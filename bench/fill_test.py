# SPDX-License-Identifier: Apache-2.0
"""bench/fill.py: each of its commands on small bodies whose whole is known."""
import csv
import os
import pathlib
import subprocess
import sys
import types

import nibabel
import numpy as np
import pytest

import slices
from filling import kept, methods, together, topology

BENCH = pathlib.Path(__file__).parent
KONTUR = os.environ["KONTUR"]


def ball(shape, middle, radius):
    return sum((axis - m) ** 2 for axis, m in zip(np.indices(shape), middle)) <= radius**2


def run(*words):
    return subprocess.run([sys.executable, BENCH / "fill.py", *words, "--kontur", KONTUR], check=True, capture_output=True, text=True,
                          timeout=200).stdout


def rows_of(markdown):
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in markdown.splitlines() if line.startswith("|")]


def test_kept_slices_stay_as_they_are():
    truth = ball((40, 40, 30), (20, 20, 15), 12)
    at = slices.kept(truth, 4)
    made = methods.filled(KONTUR, methods.sparse_map(truth, at), np.eye(4)) > 0
    assert np.array_equal(made[:, :, at], truth[:, :, at])
    assert 2 * (made & truth).sum() / (made.sum() + truth.sum()) > 0.95


def test_every_method_fills_what_was_left_out():
    truth = ball((40, 40, 34), (20, 20, 17), 13)
    options = types.SimpleNamespace(itk=None, images=False, words=None, kontur=KONTUR, all_starts=False, data=None)
    rows = [dict(zip(kept.FIELDS, row)) for row in kept.measure(("real", "ball", truth, np.eye(4), options))]
    assert {(row["step"], row["method"]) for row in rows} == {(s, m) for s in slices.STEPS for m in ("shape-based", "kontur fill")}
    for row in rows:
        assert float(row["dice_left_out"]) > (0.95 if row["step"] < 8 else 0.85)


def test_all_starts_are_measured_where_they_are_asked_for():
    truth = ball((24, 24, 24), (12, 12, 12), 9)
    options = types.SimpleNamespace(itk=None, images=False, words=None, kontur=KONTUR, all_starts=True, data=None)
    found = {(row[2], row[3]) for row in kept.measure(("real", "ball", truth, np.eye(4), options))}
    assert found == {(step, start) for step in slices.STEPS for start in range(step)}


@pytest.mark.parametrize("mask, parts, tunnels", [
    (ball((30, 30, 30), (15, 15, 15), 10), 1, 0),
    (ball((40, 20, 20), (10, 10, 10), 6) | ball((40, 20, 20), (30, 10, 10), 6), 2, 0),
    (np.abs(np.hypot(*(np.indices((40, 40, 9))[:2] - 20)) - 12) < 4, 1, 1),
    (ball((30, 30, 30), (15, 15, 15), 10) & ~ball((30, 30, 30), (15, 15, 15), 5), 1, 0),
], ids=["ball", "two balls", "ring", "shell"])
def test_parts_and_tunnels_are_counted(mask, parts, tunnels):
    assert topology.parts_and_tunnels(mask) == (parts, tunnels)


def test_the_band_around_a_shared_border_has_two_voxels_to_either_side():
    labels = np.zeros((12, 6, 6), np.int16)
    labels[2:6], labels[6:10] = 1, 2
    assert set(np.flatnonzero(together.border_band(labels)[:, 3, 3])) == {4, 5, 6, 7}


def test_together_less_is_left_without_a_label_and_more_is_right(tmp_path):
    x, y, z = np.indices((40, 40, 40)) - 19.5
    labels = np.where(x**2 + y**2 + z**2 < 15**2, np.where(x + 0.3 * z < 0, 1, np.where(y < 0, 7, 8)), 0).astype(np.int16)
    folder = tmp_path / "06_mr_brain_MRIcrop"
    folder.mkdir()
    nibabel.save(nibabel.Nifti1Image(labels, np.diag([-1.0, -1, 1, 1])), folder / "MRIcrop-seg.nii.gz")
    rows = rows_of(run("together", str(tmp_path), "--cases", "1"))[2:]
    assert [row[2] for row in rows] == ["alone", "together"] * 4
    for alone, both in zip(rows[::2], rows[1::2]):
        assert float(both[4]) < float(alone[4]) and float(both[5]) > float(alone[5]) > 0.85


def test_tubes_hang_together_while_their_sections_overlap():
    rows = rows_of(run("peers", "--only", "tubes"))
    assert rows[0][1:] == ["shape-based", "kontur fill"]
    for row in rows[2:5]:
        assert row[2].endswith("in 1") and float(row[2].split()[0]) > 0.9


def test_memory_and_time_of_a_large_map_are_printed():
    [row] = rows_of(run("peers", "--only", "large", "--size", "60"))[2:]
    assert row[0] == "kontur fill" and float(row[2]) > 1 and float(row[3]) > 0.95


def test_the_picture_is_drawn_and_filling_together_comes_closer_than_each_alone(tmp_path):
    printed = dict(line.rsplit(": ", 1) for line in run("picture", str(tmp_path / "fill.png")).splitlines())
    assert (tmp_path / "fill.png").read_bytes().startswith(b"\x89PNG")
    assert float(printed["kontur fill"]) > max(float(printed["kontur fill --alone"]), 0.9)


def test_results_are_written_row_by_row(tmp_path):
    rows = methods.written(tmp_path / "out" / "a.csv", ["x", "y"], [("one", [[1, 2]]), ("two", [[3, 4], [5, 6]])])
    assert rows == [[1, 2], [3, 4], [5, 6]]
    with open(tmp_path / "out" / "a.csv", newline="", encoding="utf-8") as file:
        assert list(csv.reader(file)) == [["x", "y"], ["1", "2"], ["3", "4"], ["5", "6"]]
