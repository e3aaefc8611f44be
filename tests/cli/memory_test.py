# SPDX-License-Identifier: Apache-2.0
"""A run that would take too much memory is refused with the estimate before the work, and the estimate is worth something."""
import json
import re

import numpy
import pytest
from support import SANITIZED, ball_planes, circle, kontur, names, succeed, write_planes


def by_an_unsteady_hand(plane):
    """Of a smooth line a third of the points would take part."""
    for contour in plane["contours"]:
        points = numpy.array(contour["points"])
        around = 1 + 0.005 * (-1.0) ** numpy.arange(len(points))[:, None]
        contour["points"] = (points.mean(0) + around * (points - points.mean(0))).tolist()
    return plane


MANY = [by_an_unsteady_hand(circle(axis, -9 + 18 * n / 11, points=200)) for axis in "xyz" for n in range(12)]


def estimate_and_peak(folder, planes, *words):
    write_planes(folder / "ball.json", planes)
    succeed("segment", "ball.json", "--output", "out.nrrd", "--report", "report.json", *words, cwd=folder)
    report = json.loads((folder / "report.json").read_text())
    return report["estimated_memory_mb"], report["peak_memory_mb"]


@pytest.mark.parametrize(
    "planes, words",
    [
        (ball_planes(), ["--spacing-mm", "1"]),
        (ball_planes(), ["--spacing-mm", "0.1", "--mesh", "out.ply"]),
        (ball_planes(), ["--spacing-mm", "0.1", "--voxelizer", "tracked", "--margin-mm", "20"]),
        (ball_planes(), ["--spacing-mm", "0.25", "--voxelizer", "exhaustive"]),
        (MANY, ["--spacing-mm", "1"]),
        (MANY[::6], ["--spacing-mm", "1", "--solver", "dense"]),
    ],
)
def test_the_estimate_is_above_the_peak_and_near_it(tmp_path, planes, words):
    estimate, peak = estimate_and_peak(tmp_path, planes, *words)
    assert SANITIZED or 0.95 * peak < estimate < 4 * peak


@pytest.mark.parametrize("words", [["--spacing-mm", "0.025", "--margin-mm", "2"], ["--spacing-mm", "0.5", "--max-memory-mb", "20"]])
def test_a_run_beyond_the_limit_is_refused_with_the_estimate(tmp_path, words):
    write_planes(tmp_path / "ball.json", ball_planes())
    before = names(tmp_path)
    limit = [] if "--max-memory-mb" in words else ["--max-memory-mb", "1000"]
    result = kontur("segment", "ball.json", "--output", "out.nrrd", *words, *limit, cwd=tmp_path)
    assert result.returncode == 77
    sentence = r"kontur: error: this would take about (\d+) MB of memory; the limit is (\d+) MB \(max_memory_mb\)\n"
    match = re.fullmatch(sentence, result.stderr)
    assert match and int(match[1]) > int(match[2])
    assert names(tmp_path) == before
