# SPDX-License-Identifier: Apache-2.0
"""Whatever the public headers declare is in Python, or stands in left_out.csv with a reason."""
import csv
import pathlib
import re

import kontur
import numpy
import pytest

ROOT = pathlib.Path(__file__).parents[2]
SOURCES = ROOT / "src"

# Names that say the same in another way, and options structs, which are keywords in Python.
SAME = {
    "make_plane": "Plane", "make_affine": "Grid", "select_mask": "Mask", "drop_duplicate_points": "without_duplicate_points", "leave_out_lines": "without_lines",
    "read_contour": "read_contours",
    "gradient": "ImplicitFunction", "contains": "EdgeMap", "volume_ml": "Mask", "point_count": "ContourSet", "bounding_box": "ContourSet",
    "smallest_ball": "ContourSet", "diameter_mm": "ContourSet", "Ball3": "ContourSet",
    "sample": "Image", "Result": "Segmentation", "Filling": "fill_labels", "DicomSeg": "read_dicom_seg", "DicomAlgorithm": "write_dicom_seg", "LabelName": "write_image",
    "ReadContours": "read_contours", "PictureFact": "make_picture", "RgbImage": "write_png", "Pixel": "EdgeMap", "PixelPosition": "EdgeMap",
    "DenseLiver": "dense_liver_case", "ErrorKind": "Error", "Severity": "Finding", "FindingKind": "Finding", "UnitFrame": "ImplicitFunction",
    "BoundaryPoint": "PreparedContours", "Work": "segment", "Affine3": "Grid", "Vec3": "Contour", "Index3": "Grid", "Box3": "grid_around",
    "NamedStructure": "derive", "OutlineLine": "outline", "whole_mask": "Together", "MeshRegions": "write_region_mesh", "Window": "suggest_window",
}


def public_headers(*umbrellas):
    found, waiting = [], list(umbrellas)
    while waiting:
        header = waiting.pop()
        if header in found:
            continue
        found.append(header)
        waiting += re.findall(r'^#include "(kontur/[^"]+)"', (SOURCES / header).read_text(), re.MULTILINE)
    return found


def declared(header):
    """Functions and types at namespace scope: lines that start in the first column."""
    text = re.sub(r"//[^\n]*", "", (SOURCES / header).read_text())
    functions = re.findall(r"^(?! |using|template|#|friend|\})[\w:<>,&\*\[\] ]+?[ &\*](\w+)\(", text, re.MULTILINE)
    types = re.findall(r"^(?:class|struct) (\w+)\b(?!;)", text, re.MULTILINE)
    return {name for name in functions + types if not name.endswith("Options") and not name.startswith("operator") and name != "name"}


def left_out():
    """The headers and names of left_out.csv, each with its reason."""
    with open(pathlib.Path(__file__).parent / "left_out.csv", encoding="utf-8", newline="") as lines:
        rows = list(csv.DictReader(lines))
    assert all(len(row["reason"]) > 20 for row in rows)
    return {name for row in rows for name in row["names"].split()}


def test_everything_public_is_in_python_or_left_out_by_name():
    without = left_out()
    missing, used = {}, set()
    for header in public_headers("kontur/kontur.h", "kontur/stages.h"):
        short = header.removeprefix("kontur/")
        if short in without:
            used.add(short)
            continue
        for name in declared(header):
            if any(hasattr(module, word) for module in (kontur, kontur.stages) for word in (name, SAME.get(name, "?"))):
                continue
            if name in without:
                used.add(name)
            else:
                missing.setdefault(short, []).append(name)
    assert missing == {}
    assert without - used == set(), "left out, but not there"


def test_stages_are_in_their_module_alone_and_all_other_names_are_stable_ones():
    stable = set().union(*map(declared, public_headers("kontur/kontur.h")))
    every = set().union(*map(declared, public_headers("kontur/kontur.h", "kontur/stages.h")))
    assert set(kontur.__all__) & set(kontur.stages.__all__) == set()
    assert set(kontur.stages.__all__) - every == set()
    assert set(kontur.__all__) & (every - stable) == set()
    assert [name for name in kontur.__all__ if "sha256" in name] == []


def test_a_contour_along_an_edge(case):
    """Live-wire from clicks 20 degrees apart along the kidney's border runs within a pixel of it."""
    centre = case.contours.bounding_box.mean(axis=0)
    image = kontur.make_phantom_image(kontur.grid_around(case.contours.bounding_box, [1, 1, 1], 20))
    plane = kontur.Plane(centre, [0, 0, 1], u=[1, 0, 0], v=[0, 1, 0])
    n = 160
    edges = kontur.stages.EdgeMap(kontur.reslice(image, plane, n, n, 1.0, outside=-1000))
    assert edges.strengths.shape == (n, n) and 0 <= edges.strengths.min() <= edges.strengths.max() <= 1
    angles = numpy.radians(numpy.arange(0, 360, 20))
    truth = kontur.segment(case.contours, case.grid, mesh=True).mesh
    border = plane.to_uv(max(kontur.outline(truth, plane), key=lambda line: len(line[0]))[0])
    middle = border.mean(axis=0)
    direction = numpy.arctan2(*(border - middle).T[::-1])
    clicks = [border[numpy.abs(numpy.angle(numpy.exp(1j * (direction - a)))).argmin()] + (n - 1) / 2 for a in angles]
    pixels = [edges.snap((round(c), round(r)), radius=2) for c, r in clicks]
    line = numpy.concatenate([kontur.stages.smooth_path(edges, kontur.stages.LiveWire(edges, a).path_to(b))[:-1]
                              for a, b in zip(pixels, pixels[1:] + pixels[:1])])
    drawn = kontur.Contour(plane.from_uv(line - (n - 1) / 2), plane=plane)
    distance = numpy.abs(case.body.values(drawn.points))
    assert numpy.median(distance) < 1 and distance.max() < 4
    for wrong in ((-1, 0), (n, 0)):
        with pytest.raises(kontur.InvalidInputError, match="outside"):
            kontur.stages.LiveWire(edges, wrong)


def test_a_live_editor_answers_the_newest_edit(case):
    updates = []
    with kontur.LiveEditor(updates.append, preview_spacing_mm=2) as editor:
        for count in (3, 4, 5, 6):
            number = editor.edit(kontur.ContourSet(case.contours.contours[:count]))
        editor.wait()
        assert number == 4
    final = [update for update in updates if update.kind == "finished"][-1]
    assert final.edit == 4 and final.surface.finished
    assert numpy.array_equal(final.surface.function.weights, kontur.Editor().finish(case.contours).function.weights)
    with pytest.raises(kontur.InvalidInputError, match="closed"):
        editor.edit(case.contours)


def ball_on_image(radius=40.0):
    """Circles of a ball in five slices, and an image in which it is bright."""
    turns = numpy.linspace(0, 2 * numpy.pi, 60, endpoint=False)
    rings = [(radius**2 - z**2) ** 0.5 * numpy.stack([numpy.cos(turns), numpy.sin(turns), 0 * turns], 1) + [0, 0, z]
             for z in (-34, -18, -2, 14, 30)]
    z, y, x = numpy.meshgrid(4 * (numpy.arange(40) - 19.5), *[2 * (numpy.arange(60) - 29.5)] * 2, indexing="ij")
    noise = numpy.random.default_rng(1).integers(0, 21, x.shape)
    grid = kontur.Grid((60, 60, 40), numpy.array([[2, 0, 0, -59], [0, 2, 0, -59], [0, 0, 4, -78], [0, 0, 0, 1.0]]), frame="LPS")
    image = kontur.Image((100 * (x**2 + y**2 + z**2 < radius**2) + noise).astype(numpy.int16), grid)
    return kontur.ContourSet([kontur.Contour(ring) for ring in rings]), image


def test_editors_ask_the_image_that_they_are_given():
    contours, image = ball_on_image()
    wanted = kontur.segment(contours, image.grid, image=image)
    assert wanted.report.image.verdict == "used"
    finished = kontur.Editor().finish(contours, image=image)
    assert numpy.array_equal(finished.function.weights, wanted.function.weights)
    assert finished.image.error_with_mm == wanted.report.image.error_with_mm
    assert kontur.Editor().finish(contours).image.verdict == "none"
    updates = []
    with kontur.LiveEditor(updates.append) as editor:
        editor.edit(contours, image=image)
        del image  # the editor keeps it
        editor.wait()
    told = [update for update in updates if update.kind != "progress"]
    assert [(update.kind, update.asks_image) for update in told] == [("preview", False), ("finished", True), ("with_image", False)]
    assert numpy.array_equal(told[-1].surface.function.weights, wanted.function.weights)
    assert told[-1].surface.image.verdict == "used"
    with pytest.raises(TypeError):
        kontur.LiveEditor(print).edit(contours, image=7)


def test_a_listener_that_raises_or_waits_does_no_harm(case):
    def listener(update):
        editor.wait()

    problems = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("sys.unraisablehook", problems.append)
        with kontur.LiveEditor(listener) as editor:
            editor.edit(kontur.ContourSet(case.contours.contours[:3]))
            editor.wait()
    assert problems and "must not call wait" in str(problems[0].exc_value)


def test_an_editor_left_open_does_not_keep_python_from_ending(tmp_path):
    import subprocess
    import sys

    program = ("import kontur\ncase = kontur.phantom_case('liver_orthogonal14')\n"
               "editor = kontur.LiveEditor(lambda update: None)\neditor.edit(case.contours)\nprint('end')")
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert (result.returncode, result.stdout) == (0, "end\n"), result


def test_fast_functions_agree_with_direct_sums_and_survive_a_stop():
    case = kontur.stages.dense_liver_case(points=4000)
    grid = kontur.grid_around(case.contours.bounding_box, [10, 10, 10], 0)
    function = kontur.segment(case.contours, grid).function
    points = numpy.random.default_rng(1).uniform(*case.contours.bounding_box, (200_000, 3))
    fast = kontur.stages.FastFunction(function, expected_points=len(points), tolerance_mm=0.005)
    values = fast.values(points)
    some = slice(0, 2000)
    assert numpy.abs(values[some] - function(points[some])).max() < 0.02
    assert numpy.abs(fast.gradients(points[some]) - function.gradients(points[some])).max() < 0.05
    assert fast.kernel_values > 0 and fast.exact.kernel == "screened"

    class Now:
        def is_set(self):
            return True

    with pytest.raises(kontur.CancelledError):
        kontur.stages.FastFunction(function).values(numpy.repeat(points, 20, axis=0), stop=Now())
    assert numpy.abs(fast.values(points[some]) - function(points[some])).max() < 0.02


def test_findings_name_places(case):
    two = kontur.ContourSet([*case.contours.contours, case.contours.contours[0]])
    finding = next(f for f in kontur.check_contour_set(two) if f.kind == "duplicate")
    assert (finding.severity, {finding.contour, finding.other}) == ("warning", {0, 6})
    assert "contour" in finding.text
    assert kontur.check_contour_set(kontur.ContourSet([]))[0].severity == "error"


def test_constraints_solve_to_the_papers_surface(case):
    """What `fit` solves with in-plane normals, put together by hand."""
    prepared = kontur.stages.prepare(case.contours, quality=0.3, bounds=False, conflicts="exact")
    assert prepared.bounds == []
    outside = prepared.positions + prepared.inplane_normals
    values = numpy.repeat([0, -1], len(prepared.positions))
    placed = kontur.stages.ConstraintSet(numpy.concatenate([prepared.positions, outside]), values)
    assert (placed.trust == 1).all()
    direct = kontur.stages.solve(placed, solver="dense", smoothing=0, ball=prepared.ball).function
    fitted = kontur.stages.fit(prepared, normals="in-plane", normal_offset_mm=1, solver="dense").function
    at = case.contours.bounding_box.mean(axis=0)
    assert direct(at) == pytest.approx(float(fitted(at)), rel=1e-6)


def test_a_constraint_with_noise_is_followed_less_closely():
    centres = numpy.array([[0, 0, 0], [10, 0, 0], [0, 10, 0], [0, 0, 10], [3, 3, 3]], float)
    values = numpy.array([0, 0, 0, 0, 2], float)
    missed = []
    for noise in (0, 0.5, 2):
        constraints = kontur.stages.ConstraintSet(centres, values, noise_mm=[0, 0, 0, 0, noise])
        assert constraints.noise_mm.tolist() == [0, 0, 0, 0, noise]
        solution = kontur.stages.solve(constraints, solver="dense", smoothing=0, ball=([2, 2, 2], 20))
        assert solution.function.frame_scale_mm == 20
        assert numpy.abs(solution.function(centres[:4])).max() < 1e-9
        missed.append(2 - float(solution.function(centres[4])))
    assert abs(missed[0]) < 1e-9 < 0.01 < missed[1] < missed[2] < 2
    assert (kontur.stages.ConstraintSet(centres, values).noise_mm == 0).all()
    for wrong, words in (([1, 2], "noise of 2"), (numpy.full(5, -1), "at least 0"), (numpy.full(5, numpy.nan), "finite")):
        with pytest.raises(kontur.InvalidInputError, match=words):
            kontur.stages.ConstraintSet(centres, values, noise_mm=wrong)
    with pytest.raises(TypeError, match="ball"):
        kontur.stages.solve(constraints, ball=20)


def test_bounds_say_what_is_inside_and_what_is_outside(case):
    prepared = kontur.stages.prepare(case.contours)
    assert prepared.notes == [] and len(prepared.bounds) > 100
    positions = numpy.array([bound.position for bound in prepared.bounds])
    truth = case.body.values(positions)
    least, most, noise = (numpy.array([getattr(bound, name) for bound in prepared.bounds]) for name in ("least_mm", "most_mm", "noise_mm"))
    inside, outside = least > 0, most <= 0
    assert (inside != outside).all() and (least[outside] == -numpy.inf).all() and (most[inside] == numpy.inf).all() and (noise > 0).all()
    assert (truth[inside] > 0).all() and (truth[outside] < 0).mean() > 0.95
    two = kontur.stages.prepare(kontur.ContourSet([case.contours[0], kontur.Contour(case.contours[0].points + case.contours[0].plane.normal)]))
    assert any("guess" in note for note in two.notes)


def test_clicks_are_bounds_without_noise(case):
    centre, radius = case.contours.smallest_ball
    far = centre + [0, 0, 1.8 * radius]
    clicked = kontur.stages.prepare(kontur.ContourSet(list(case.contours), exterior=[far], interior=[centre]), click_margin_mm=0.5)
    interior, exterior = clicked.bounds[-2:]
    assert numpy.array_equal(interior.position, centre) and numpy.array_equal(exterior.position, far)
    assert (interior.least_mm, interior.most_mm, interior.noise_mm) == (0.5, numpy.inf, 0)
    assert (exterior.least_mm, exterior.most_mm, exterior.noise_mm) == (-numpy.inf, -0.5, 0)


def test_nesting_and_fill_rule():
    square = numpy.array([[1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0]], float)
    rings = kontur.ContourSet([kontur.Contour(r * square) for r in (10, 6, 3)])
    nesting = kontur.stages.find_nesting(rings, tolerance_mm=0.01)
    assert nesting.depth == [0, 1, 2] and nesting.enclosing == [[], [0], [0, 1]] and nesting.crossings == []
    filled, changes = kontur.stages.apply_fill_rule(rings, "even-odd")
    assert [c.hole for c in filled.contours] == [False, True, False] and changes.holes == 1
    fewer, changes = kontur.stages.apply_fill_rule(rings, "declared")
    assert len(fewer) == 1 and changes.removed == 2


def test_a_line_drawn_again_is_no_hole():
    angle = numpy.linspace(0, 2 * numpy.pi, 40, endpoint=False)

    def circle(radius, z):
        return kontur.Contour(numpy.stack([radius * numpy.cos(angle), radius * numpy.sin(angle), 0 * angle + z], axis=1))

    rings = kontur.ContourSet([circle(20, z) for z in (-8, 0, 8)] + [circle(20.5, 0)])
    filled, changes = kontur.stages.apply_fill_rule(rings)
    assert not any(c.hole for c in filled.contours)
    (pair,) = changes.near_lines
    assert (pair.contour, pair.other, pair.are_nested, pair.is_one) == (1, 3, True, True)
    assert abs(pair.apart_mm - 0.5) < 0.02 and 0 < pair.share < 0.1
    report = kontur.segment(rings, kontur.grid_around([[-25, -25, -12], [25, 25, 12]], [4, 4, 4], 8)).report
    assert [(p.contour, p.other) for p in report.near_lines] == [(1, 3)]
    assert "one line that was drawn twice" in report.warnings[0]


def test_digests_do_not_depend_on_the_file(tmp_path, case):
    kontur.write_contours(tmp_path / "a.json", case.contours, provenance={"made_by": "hand"})
    assert '"provenance": {"made_by": "hand"}' in (tmp_path / "a.json").read_text()
    assert kontur.read_provenance(tmp_path / "a.json") == {"made_by": "hand"}
    again = kontur.read_contours(tmp_path / "a.json")


def test_a_plane_there_and_back():
    plane = kontur.Plane([1, 2, 3], [0.3, -0.2, 0.9])
    uv = numpy.random.default_rng(1).normal(size=(20, 2))
    assert numpy.allclose(plane.to_uv(plane.from_uv(uv)), uv)
    assert numpy.abs(plane.distance_to(plane.from_uv(uv))).max() < 1e-12
    assert plane.from_uv(numpy.empty((0, 2))).shape == (0, 3)
    with pytest.raises(kontur.InvalidInputError):
        plane.from_uv([[1, 2, 3]])
