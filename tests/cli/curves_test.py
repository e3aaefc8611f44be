# SPDX-License-Identifier: Apache-2.0
"""3D Slicer's curves: the line between their control points, as 3D Slicer draws it or straight."""
import json
import math

import numpy
import pytest
from scipy.interpolate import CubicSpline
from support import circle, kontur, succeed, write_nifti, ball_array, write_planes

SCHEMA = "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/markups-schema-v1.0.3.json#"


def write_curves(path, *curves, kind="ClosedCurve"):
    """Each a list of points, LPS mm, as 3D Slicer saves them."""
    markups = [
        {"type": kind, "coordinateSystem": "LPS", "coordinateUnits": "mm", "controlPoints": [{"position": list(map(float, p)), "positionStatus": "defined"} for p in points]}
        for points in curves
    ]
    path.write_text(json.dumps({"@schema": SCHEMA, "markups": markups}))
    return path


def ring(count, radius=30.0, z=7.0):
    angles = 2 * math.pi * numpy.arange(count) / count
    return numpy.stack([radius * numpy.cos(angles), radius * numpy.sin(angles), numpy.full(count, z)], axis=1)


def converted(path, *options):
    """The points of each contour, and what is said."""
    out = path.with_name("converted.json")
    result = kontur("convert", path, out, *options)
    assert result.returncode == 0, result
    return [numpy.array(c["points"]) for plane in json.loads(out.read_text())["planes"] for c in plane["contours"]], result.stderr


def area(points):
    x, y = points[:, 0], points[:, 1]
    return abs(numpy.dot(x, numpy.roll(y, -1)) - numpy.dot(y, numpy.roll(x, -1))) / 2


def farthest(points, line):
    """The largest distance of a point from the line's chords."""
    start, along = line[:-1], numpy.diff(line, axis=0)
    length2 = numpy.maximum((along**2).sum(axis=1), 1e-300)
    share = [numpy.clip(((p - start) * along).sum(axis=1) / length2, 0, 1)[:, None] for p in points]
    return max(numpy.linalg.norm(start + s * along - p, axis=1).min() for p, s in zip(points, share))


def closed(points):
    return numpy.concatenate([points, points[:1]])


@pytest.mark.parametrize("count, spline_loses, polygon_loses", [(6, 0.0062, 0.173), (8, 0.0023, 0.0997), (12, 0.0007, 0.0451)])
def test_a_circle_by_few_points_keeps_its_area(tmp_path, count, spline_loses, polygon_loses):
    path = write_curves(tmp_path / "ring.mrk.json", ring(count))
    whole = math.pi * 30**2
    [points], said = converted(path)
    assert abs(area(points) / whole - 1) < spline_loses
    spline = CubicSpline(numpy.arange(count + 1), closed(ring(count)), bc_type="periodic")
    off_mm = farthest(spline(numpy.linspace(0, 1, 11)), ring(count)[:2])
    assert f"took 1 curve as the spline that 3D Slicer draws, up to {off_mm:.2g} mm off straight lines; --curves polygon" in said
    [points], said = converted(path, "--curves", "polygon")
    assert numpy.allclose(points, ring(count)) and said == ""
    assert area(points) / whole - 1 == pytest.approx(-polygon_loses, abs=5e-4)


@pytest.mark.parametrize("kind, ends", [("ClosedCurve", "periodic"), ("Curve", "clamped")])
def test_the_line_is_the_cubic_spline_of_equal_steps(tmp_path, kind, ends):
    """vtkParametricSpline on vtkCardinalSpline, not parametrized by length: unequal distances tell it from any other."""
    rng = numpy.random.default_rng(5)
    angles = numpy.sort(rng.uniform(0, 2 * math.pi, 11))
    radii = rng.uniform(15, 30, 11)
    controls = numpy.stack([radii * numpy.cos(angles), radii * numpy.sin(angles), numpy.zeros(11)], axis=1)
    knots = closed(controls) if ends == "periodic" else controls
    spline = CubicSpline(numpy.arange(len(knots)), knots, bc_type=ends)
    drawn = spline(numpy.linspace(0, len(knots) - 1, 20001))
    [points], _ = converted(write_curves(tmp_path / "blob.mrk.json", controls, kind=kind))
    assert len(points) > 3 * len(controls)
    assert farthest(points, drawn) < 1e-3
    extent = numpy.linalg.norm(numpy.ptp(controls, axis=0))
    chords_of_slicer = spline(numpy.linspace(0, len(knots) - 1, 10 * (len(knots) - 1) + 1))
    line = closed(points) if ends == "periodic" else points
    assert farthest(drawn[::20], line) < max(2e-4 * extent, 1.05 * farthest(drawn[::20], chords_of_slicer))


def test_a_curve_of_many_points_stays_as_it_is(tmp_path):
    points = ring(400)
    [kept], said = converted(write_curves(tmp_path / "ring.mrk.json", points))
    assert numpy.allclose(kept, points) and said == ""


def test_several_files_are_one_sentence(tmp_path):
    paths = [write_curves(tmp_path / f"{n}.mrk.json", ring(8, z=4.0 * n)) for n in range(5)]
    result = kontur("segment", *paths, "--spacing-mm", 3, "-o", tmp_path / "mask.nii.gz")
    assert result.returncode == 0, result
    assert result.stderr.count("3D Slicer") == 1
    assert "took 5 curves as the spline" in result.stderr


def test_konturs_own_curves_keep_their_points(tmp_path):
    write_planes(tmp_path / "few.json", [circle("z", 0, points=7)])
    succeed("convert", tmp_path / "few.json", tmp_path / "few.mrk.json")
    succeed("convert", tmp_path / "few.mrk.json", tmp_path / "again.json")
    first, again = (json.loads((tmp_path / name).read_text())["planes"][0]["contours"][0]["points"] for name in ("few.json", "again.json"))
    assert numpy.allclose(first, again)


def test_the_option_is_refused_where_no_curve_is_3d_slicers(tmp_path):
    write_planes(tmp_path / "own.json", [circle("z", 0)])
    write_nifti(tmp_path / "mask.nii", ball_array())
    for words in (
        ["convert", "own.json", "out.mrk.json"],
        ["convert", "mask.nii", "out.nrrd"],
        ["segment", "own.json", "--spacing-mm", 3, "-o", "out.nii"],
        ["suggest", "own.json"],
        ["open", "mask.nii", "--no-browser", "--project", "out.kontur", "--timeout", 1],
    ):
        result = kontur(*words, "--curves", "polygon", cwd=tmp_path)
        assert result.returncode == 65 and "--curves is for 3D Slicer's markups (.mrk.json)" in result.stderr, result
    assert not list(tmp_path.glob("out*"))
