# SPDX-License-Identifier: Apache-2.0
"""What a result is to those who look at it, hand it on or keep it: pickles, the report's JSON, notebooks."""
import base64
import concurrent.futures
import copy
import hashlib
import html.parser
import json
import multiprocessing
import operator
import os
import pickle
import re
import subprocess

import kontur
import numpy
import pytest

RESULTS = ["kidney", "kidney.report", "kidney.mask", "kidney.mesh", "kidney.function", "image", "case.grid", "case.contours"]
# Of a machine and a moment.
MEASURED = ("seconds", "peak_memory_mb", "estimated_memory_mb")


def sha256(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


@pytest.fixture
def image(kidney):
    return kontur.Image(kidney.mask.values * 1000.0 - 500, kidney.mask.grid)


@pytest.fixture
def result(request, case, kidney, image):
    """The result of that name."""
    name, _, member = request.param.partition(".")
    value = {"case": case, "kidney": kidney, "image": image}[name]
    return getattr(value, member) if member else value


def parts(value):
    """Everything that Python sees of a value, in terms of numbers and texts."""
    if isinstance(value, numpy.ndarray):
        return value.dtype.str, value.shape, value.tobytes()
    if isinstance(value, (list, tuple)):
        return [parts(item) for item in value]
    if isinstance(value, dict):
        return {key: parts(item) for key, item in value.items()}
    if type(value).__module__ != "kontur":
        return value
    names = [name for name, member in vars(type(value)).items() if isinstance(member, property)]
    assert names
    return {name: parts(getattr(value, name)) for name in names}


@pytest.mark.parametrize("result", RESULTS, indirect=True)
@pytest.mark.parametrize("clone", [copy.copy, copy.deepcopy, lambda value: pickle.loads(pickle.dumps(value))])
def test_results_come_back_from_a_pickle_whole(result, clone):
    assert parts(clone(result)) == parts(result)


def test_results_go_to_other_processes_and_come_back(case, kidney, image):
    with concurrent.futures.ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        for value in (kidney, image, case.grid, case.contours, kontur.compare(kidney.mask, kidney.mask)):
            assert parts(pool.submit(copy.copy, value).result()) == parts(value)
        report = pool.submit(operator.attrgetter("report"), kidney).result()
    assert report.to_dict()["crossings"] == kidney.report.to_dict()["crossings"]


def test_what_contradicts_each_other_and_what_is_not_there_comes_back(case):
    """Reports with crossings and warnings; segmentations without a mesh; masks with foreign values."""
    contours = list(case.contours) + [kontur.Contour(case.contours[0].points * [1, 1, 1] + [3, 0, 0])]
    made = kontur.segment(kontur.ContourSet(contours), case.grid)
    assert made.mesh is None and made.report.crossings and made.report.warnings
    again = pickle.loads(pickle.dumps(made))
    assert again.mesh is None and parts(again.report) == parts(made.report)
    made.mask.values[0, 0, :3] = (1, 2, 3)
    assert numpy.array_equal(pickle.loads(pickle.dumps(made.mask)).values, made.mask.values)


@pytest.mark.parametrize("name", ["Mask", "Segmentation", "SegmentReport", "Residual"])
def test_a_pickle_that_is_none_is_refused(name):
    kind = getattr(kontur, name)
    for state in ((1, 2, 3, 4), {"residual": 1, "max_mm": "much"}, None):
        with pytest.raises((TypeError, RuntimeError)):
            kind.__new__(kind).__setstate__(state)


def test_the_report_is_the_command_lines(tmp_path, case):
    kontur.write_contours(tmp_path / "contours.json", case.contours)
    kontur.write_image(tmp_path / "image.nrrd", kontur.make_phantom_image(case.grid))
    subprocess.run([os.environ["KONTUR_CLI"], "segment", "contours.json", "--image", "image.nrrd", "--output", "m.nii.gz",
                    "--report", "report.json", "--quality", "0.7"], cwd=tmp_path, check=True, capture_output=True, timeout=400)
    written = json.loads((tmp_path / "report.json").read_text())
    contours, image = kontur.read_contours(tmp_path / "contours.json"), kontur.read_image(tmp_path / "image.nrrd")
    report = kontur.segment(contours, image.grid, image=image, quality=0.7).report
    made = kontur.provenance(contours, image.grid, report) | {
        "contour_files_sha256": sha256(tmp_path / "contours.json"),
        "image_sha256": sha256(tmp_path / "image.nrrd"),
    }
    mine = report.to_dict(provenance=made)
    assert list(mine) == list(written)
    assert mine["peak_memory_mb"] > 1 and mine["estimated_memory_mb"] == report.estimated_memory_mb > 1
    assert mine["seconds"] == pytest.approx({**report.seconds, "total": sum(report.seconds.values())})
    assert set(mine["seconds"]) == set(written["seconds"]) - {"read", "write"}
    for key in MEASURED:
        del mine[key], written[key]
    assert mine == written

    text = report.to_json(made)
    assert text.endswith("}\n") and list(json.loads(text)) == list(report.to_dict())
    assert report.to_dict()["provenance"] == {}


def test_reprs_are_short_and_tell_the_figures(case, kidney, image):
    volume = f"{kidney.report.mask_volume_ml:.4g} ml"
    assert volume in repr(kidney) and f"{len(kidney.mesh.triangles)} triangles" in repr(kidney)
    assert volume in repr(kidney.report) and "6 contours, 1500 points" in repr(kidney.report)
    assert volume in repr(kidney.mask) and repr(case.grid) in repr(kidney.mask)
    assert "float32" in repr(image)
    crossing = kontur.stages.find_crossings(kontur.phantom_case("liver_orthogonal14").contours)[0]
    agreement = kontur.compare(kidney.mask, kidney.mask)
    for value in (case, kontur.stages.phantom_volumes()[0], kontur.SurfacePoint([1, 2, 3]), kidney, kidney.report, kidney.mask,
                  kidney.function, kidney.mesh, image, case.grid, case.contours,
                  case.contours[0], crossing, kontur.stages.disagreement([crossing]), kidney.report.residual, agreement,
                  agreement.surface, kontur.topology(kidney.mesh)):
        assert len(repr(value)) < 160 and "object at" not in repr(value) and "\n" not in repr(value)


class Page(html.parser.HTMLParser):
    """Counts what is opened and closed; keeps texts and pictures."""

    def __init__(self, text):
        super().__init__()
        self.open, self.text, self.pictures = [], "", []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        if tag == "img":
            self.pictures.append(dict(attributes)["src"])
        else:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


@pytest.mark.parametrize("result", RESULTS, indirect=True)
def test_notebooks_show_figures_and_a_picture(result, tmp_path):
    if isinstance(result, kontur.ImplicitFunction):
        return
    source = result._repr_html_()
    page = Page(source)
    assert page.open == [] and type(result).__name__ in page.text and len(source) < 400_000
    assert re.search(r"\d", page.text)
    assert len(page.pictures) == (0 if isinstance(result, (kontur.Grid, kontur.SegmentReport)) else 1)
    for picture in page.pictures:
        kind, _, data = picture.partition(",")
        assert kind == "data:image/png;base64"
        assert base64.b64decode(data, validate=True).startswith(b"\x89PNG\r\n")


def test_notebooks_show_what_is_empty_or_says_html(oblique):
    empty = kontur.ContourSet([], name="<script>&")
    image = kontur.Image(numpy.full(oblique.shape, numpy.nan), oblique)
    mask = kontur.Mask(numpy.zeros(oblique.shape, bool), oblique)
    mesh = kontur.TriangleMesh(numpy.zeros((0, 3)), numpy.zeros((0, 3), int))
    for value in (empty, image, mask, mesh):
        source = value._repr_html_()
        assert Page(source).open == [] and "<script>" not in source
    assert "&lt;script&gt;&amp;" in empty._repr_html_()


def test_a_picture_of_contours_alone_shows_their_lines_and_no_sentence_on_a_surface(case):
    nothing = kontur.TriangleMesh(numpy.zeros((0, 3)), numpy.zeros((0, 3), int))
    alone, empty = (kontur.make_picture(mesh, case.contours, width_px=640, height_px=400) for mesh in (None, nothing))
    amber = (numpy.abs(alone.astype(int) - [255, 181, 41]) < 40).all(axis=2)
    assert amber[:, :320].sum() > 500, "the lines in 3D"
    white = [(picture[150:250, 60:260].min(axis=2) > 200).sum() for picture in (alone, empty)]
    assert white[0] < white[1], "the words 'there is no surface'"


def test_pictures_as_bytes_are_the_files(tmp_path, kidney, case):
    pixels = numpy.random.default_rng(1).integers(0, 256, (9, 7, 3), dtype="u1")
    kontur.write_png(tmp_path / "a.png", pixels, provenance={"made_by": "hand"})
    assert kontur.encode_png(pixels, {"made_by": "hand"}) == (tmp_path / "a.png").read_bytes()
