# SPDX-License-Identifier: Apache-2.0
"""Solids of ten kinds: their drawings are exact, and no result of them is wrong in a drawn plane and silent."""
import csv
import io
import pathlib
import sys

import numpy as np
import pytest

import hunt
import shapes
import solids
import tubes
from tables import filled

BENCH = pathlib.Path(__file__).parent
PAGE = BENCH.parent / "docs/accuracy/shapes.md"
SIZE_MM = 60


@pytest.mark.parametrize("kind", solids.KINDS)
@pytest.mark.parametrize("way", shapes.PLANES)
def test_drawn_points_lie_on_the_surface_and_in_their_planes(kind, way):
    random = np.random.default_rng(3)
    solid = solids.solid(kind, SIZE_MM, random)
    planes, contours = shapes.drawn(solid, SIZE_MM, way, 9, random)
    points = np.vstack([contour.points for contour in contours.contours])
    assert (points > solid.bounds[0]).all() and (points < solid.bounds[1]).all()
    assert np.quantile(np.abs(solid.values(points)), 0.98) < 0.002 * SIZE_MM
    for contour in contours.contours:
        off = min(np.abs((contour.points - plane.origin) @ plane.normal).max() for plane in planes)
        assert off < 1e-6 * SIZE_MM


@pytest.mark.parametrize("kind", solids.KINDS)
def test_a_hole_is_marked_where_the_solid_is_around_it(kind):
    random = np.random.default_rng(5)
    solid = solids.solid(kind, SIZE_MM, random)
    _, contours = shapes.drawn(solid, SIZE_MM, "parallel", 8, random)
    for contour in contours.contours:
        middle = contour.plane.to_uv(contour.points)
        shrunk = contour.plane.from_uv(middle.mean(axis=0) + 1.02 * (middle - middle.mean(axis=0)))
        grows_into = np.mean(solid.values(shrunk) > solid.values(contour.points))
        assert contour.hole == (grows_into > 0.5)


@pytest.mark.parametrize("kind", solids.KINDS)
def test_no_section_is_wrong_by_more_than_a_tenth_without_a_sentence(kind):
    for way in ("parallel", "oblique"):
        row = shapes.measure(kind, SIZE_MM, way, 8, shapes.random_for("test", kind, way))
        assert not shapes.is_silent(row), row


def test_what_is_wrong_and_silent_is_counted():
    right = {"wrong": "0.01", "island": "0", "sentences": 0, "seconds": "1", "ball_seconds": "0.5"}
    assert not shapes.is_silent(right) and not shapes.is_silent(right | {"wrong": "0.2", "sentences": 1})
    assert shapes.is_silent(right | {"wrong": "0.2"})
    rows = [right, right | {"sentences": 1}, right | {"wrong": "0.2"}, right | {"island": "0.01", "sentences": 1}]
    assert shapes.summary(rows) == ("4 drawings: 1 wrong by more than a tenth and silent; of 2 right ones 1 spoken of; "
                                    "at most 2.0 times the time of a ball")


def test_the_tables_are_made_from_the_published_results():
    rows = list(csv.DictReader((BENCH / "results/shapes.csv").read_text().splitlines()))
    assert len(rows) == len(solids.KINDS) * len(shapes.SIZES_MM) * len(shapes.PLANES)
    assert not any(map(shapes.is_silent, rows))
    published = PAGE.read_text()
    assert filled(published, rows, shapes.TABLES) == published


@pytest.mark.parametrize("shape", tubes.SHAPES)
def test_rings_lie_on_their_tube_at_even_distances(shape):
    curve_of, count = tubes.SHAPES[shape]
    curve = curve_of(5, (count - 1) * 4 * 5, np.random.default_rng(2))
    contours = tubes.rings_of(curve, 5, count, 0, np.array([0, 1, 0]))
    middles = np.array([np.mean(contour.points, axis=0) for contour in contours])
    line = curve(np.linspace(0, 1, 5000))
    for contour, middle in zip(contours, middles):
        assert np.linalg.norm(line - middle, axis=1).min() < 0.05
        assert np.allclose(np.linalg.norm(contour.points - middle, axis=1), 5)
    assert np.ptp(tubes.at_even_ways(curve, count)[1:]) > 0.5
    assert tubes.curve_length(curve) == pytest.approx((count - 1) * 20, rel=1e-3)


def test_the_table_of_tubes_is_made_from_the_published_results():
    published = PAGE.read_text()
    assert filled(published, tubes.read(BENCH / "results/tubes.csv"), {"tubes": tubes.by_drawing}) == published


def test_the_hunt_draws_what_its_solids_are_and_leaves_empty_what_is_empty():
    ways = set()
    for number in range(12):
        solid, _, size_mm, way, planes, contours = hunt.made_drawing(number, 1)
        ways.add(way.split()[0])
        if not way.startswith(("odd", "slab")):
            points = np.vstack([contour.points for contour in contours.contours])
            assert np.quantile(np.abs(solid.values(points)), 0.98) < 0.002 * size_mm
        assert all(hunt.is_empty(solid, plane, size_mm) for plane in contours.empty_planes)
    assert len(ways) > 4


def test_a_fault_is_silent_where_neither_the_check_nor_a_warning_speaks():
    fault = {"wrong": "0.2", "volume_ml": "1", "truth_ml": "1", "sentences": 0, "warnings": 0}
    assert hunt.is_silent(fault) and hunt.is_silent(fault | {"wrong": "0", "volume_ml": "1.6"})
    assert not hunt.is_silent(fault | {"wrong": "0"}) and not hunt.is_silent(fault | {"warnings": 1})


def test_rows_are_written_as_they_are_measured(monkeypatch):
    out = io.StringIO()
    monkeypatch.setattr(sys, "stdout", out)
    row = shapes.measure("wedge", SIZE_MM, "parallel", 6, np.random.default_rng(1))
    shapes.written([row], shapes.FIELDS)
    assert list(csv.DictReader(out.getvalue().splitlines())) == [{name: str(value) for name, value in row.items()}]
