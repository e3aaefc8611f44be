# SPDX-License-Identifier: Apache-2.0
"""kontur's command-line modules of 3D Slicer: the published rules of such modules, and a run as 3D Slicer runs one."""
import json
import os
import pathlib
import re
import subprocess
import xml.etree.ElementTree as ElementTree

import numpy
import pytest
from support import CENTER, KONTUR, RADIUS, ball_array, ball_planes, dice, kontur, write_nifti, write_planes

FOLDER = pathlib.Path(KONTUR).parent.parent / "lib" / "slicer"
MODULE, FILL, CORRECT = FOLDER / "KonturSegment", FOLDER / "KonturFill", FOLDER / "KonturCorrect"
EACH = pytest.mark.parametrize("module", [MODULE, FILL, CORRECT], ids=lambda module: module.name)

# What 3D Slicer's parser knows (ModuleDescriptionParser), as far as it concerns us; anything else is an error there.
HEADER = {"category", "title", "description", "version", "documentation-url", "license", "contributor", "acknowledgements"}
FILES = {"image": {"multiple", "type", "fileExtensions"}, "geometry": {"multiple", "type", "fileExtensions"},
         "pointfile": {"type", "fileExtensions", "coordinateSystem"}}  # one node each: for "multiple" there is no panel
# "closedcurve" is documented, too, but exactly that is what ModuleDescriptionParser.cxx refuses (a comparison lacks its "== 0").
POINTFILE_TYPES = {"any", "point", "line", "angle", "curve"}
SIMPLE = {"integer", "float", "double", "boolean", "string", "string-enumeration"}
FIELDS = {"name", "label", "description", "longflag", "flag", "index", "channel", "default", "constraints", "element"}
IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def description(module):
    """As 3D Slicer asks for it: what is not XML from the first byte, or says a word on stderr, is no module."""
    result = subprocess.run([module, "--xml"], capture_output=True, timeout=5, env={"ITK_AUTOLOAD_PATH": ""})
    assert (result.returncode, result.stderr) == (0, b"")
    assert result.stdout.startswith(b"<?xml")
    return ElementTree.fromstring(result.stdout)


def parameters(module=MODULE):
    return [p for group in description(module).findall("parameters") for p in group if p.tag not in ("label", "description")]


def check_value(parameter):
    kind, default = parameter.tag, parameter.findtext("default")
    assert default is not None, "3D Slicer needs a default for every simple value"
    if kind in ("integer", "double"):
        value = int(default) if kind == "integer" else float(default)
        limits = parameter.find("constraints")
        if limits is not None:
            assert [e.tag for e in limits] == ["minimum", "maximum", "step"]
            assert float(limits.findtext("minimum")) <= value <= float(limits.findtext("maximum"))
    if kind == "string-enumeration":
        assert default in [e.text for e in parameter.findall("element")]


@EACH
def test_the_name_is_one_that_3d_slicer_runs(module):
    assert "." not in module.name
    assert os.access(module, os.X_OK)


@EACH
def test_the_description_follows_every_rule(module):
    root = description(module)
    assert root.tag == "executable"
    assert {e.tag for e in root} <= HEADER | {"parameters"}
    assert {"title", "description", "category", "version"} <= {e.tag for e in root}
    names, flags = [], []
    for group in root.findall("parameters"):
        assert set(group.attrib) <= {"advanced"}
        assert group[0].tag == "label" and group[1].tag == "description"
    for parameter in parameters(module):
        assert parameter.tag in FILES or parameter.tag in SIMPLE, parameter.tag
        assert set(parameter.attrib) <= FILES.get(parameter.tag, set())
        assert {e.tag for e in parameter} <= FIELDS
        for needed in ("name", "label", "description"):
            assert parameter.findtext(needed), (parameter.findtext("name"), needed)
        names.append(parameter.findtext("name"))
        assert IDENTIFIER.fullmatch(names[-1])
        channel = parameter.findtext("channel")
        returned = parameter.tag in SIMPLE and channel == "output"
        flag = parameter.findtext("longflag")
        assert (flag is None) == returned, "all but returned values are passed by a flag"
        if flag:
            assert IDENTIFIER.fullmatch(flag.removeprefix("--")), "3D Slicer's parser refuses hyphens"
            flags.append(flag)
        if parameter.tag == "pointfile":
            assert parameter.get("type") in POINTFILE_TYPES
        if parameter.tag in FILES:
            assert channel in ("input", "output")
            assert all(e.startswith(".") for e in parameter.get("fileExtensions", ".x").split(","))
        else:
            check_value(parameter)
    assert len(set(names)) == len(names)
    assert len(set(flags)) == len(flags)


@pytest.mark.parametrize("module, command", [(MODULE, "segment"), (FILL, "fill")])
def test_the_defaults_are_those_of_the_command(module, command):
    help_text = kontur(command, "--help").stdout
    for parameter in parameters(module):
        flag = (parameter.findtext("longflag") or "").replace("_", "-")
        if flag and parameter.tag in SIMPLE:
            assert re.search(rf"{flag} \S+ \[?{re.escape(parameter.findtext('default'))}\b|{flag} .*{parameter.findtext('default')}", help_text), flag


@pytest.fixture
def scene(tmp_path):
    """Files as 3D Slicer leaves them for a module: an image, and each curve in a file of its own."""
    folder = tmp_path / "Slicer temp"
    folder.mkdir()
    write_nifti(folder / "image.nii.gz", ball_array())
    assert kontur("convert", folder / "image.nii.gz", folder / "reference.nrrd").returncode == 0
    for n, plane in enumerate(ball_planes()):
        curve = {
            "type": "ClosedCurve",
            "coordinateSystem": "LPS",
            "coordinateUnits": "mm",
            "controlPoints": [{"position": p, "positionStatus": "defined"} for p in plane["contours"][0]["points"]],
        }
        schema = "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/markups-schema-v1.0.3.json#"
        (folder / f"curve {n}.mrk.json").write_text(json.dumps({"@schema": schema, "markups": [curve]}))
    return folder


def run_module(scene, **outputs):
    curves = {f"curve{n}": path for n, path in enumerate(sorted(scene.glob("*.mrk.json")), start=1)}
    files = {"referenceVolume": scene / "reference.nrrd", **curves, **outputs}
    return run_as_slicer(MODULE, scene, files)


def run_as_slicer(module, folder, files, **values):
    """With the flags that 3D Slicer makes of the module's description; what has no value in `values` has its default."""
    words = []
    for parameter in parameters(module):
        if value := files.pop(parameter.findtext("name"), None):
            words += [parameter.findtext("longflag"), value]
        if parameter.tag in SIMPLE and parameter.findtext("channel") != "output":
            words += [parameter.findtext("longflag"), values.get(parameter.findtext("name"), parameter.findtext("default"))]
    assert not files, "there is a parameter for each file"
    words += ["--returnparameterfile", folder / "returned.params"]
    return subprocess.run([module, *map(str, words)], capture_output=True, text=True, timeout=60)


def read_ply_points(path):
    head, body = path.read_bytes().split(b"end_header\n")
    assert b"SPACE=LPS" in head
    count = int(re.search(rb"element vertex (\d+)", head)[1])
    properties = re.findall(rb"property (double|float) \w+", head)
    row = numpy.dtype([(str(n), "<f8" if p == b"double" else "<f4") for n, p in enumerate(properties)])
    points = numpy.frombuffer(body, row, count)
    return numpy.stack([points[a] for a in "012"], axis=1)


def check_told(module, result, folder):
    """The tags on stdout, and the values for the panel, which it returns."""
    progress = [float(v) for v in re.findall("<filter-progress>(.*?)</filter-progress>", result.stdout)]
    assert len(progress) > 3
    assert progress == sorted(progress) and progress[0] >= 0 and progress[-1] == 1
    assert all(0 <= float(v) <= 1 for v in re.findall("<filter-stage-progress>(.*?)</filter-stage-progress>", result.stdout))
    for tag in ("filter-start", "filter-end", "filter-name", "filter-comment", "filter-time"):
        assert result.stdout.count(f"<{tag}>") == result.stdout.count(f"</{tag}>") > 0
    returned = dict(line.split(" = ") for line in (folder / "returned.params").read_text().splitlines())
    wanted = {p.findtext("name") for p in parameters(module) if p.tag in SIMPLE and p.findtext("channel") == "output"}
    assert set(returned) == wanted
    return returned


def test_a_run_makes_label_map_and_model_where_the_curves_are(scene):
    result = run_module(scene, outputMask=scene / "mask.nrrd", outputModel=scene / "model.ply")
    assert (result.returncode, result.stderr) == (0, ""), result
    assert kontur("convert", scene / "mask.nrrd", scene / "mask.nii.gz").returncode == 0
    import nibabel

    assert dice(numpy.asarray(nibabel.load(scene / "mask.nii.gz").dataobj), ball_array()) > 0.995
    distance = numpy.linalg.norm(read_ply_points(scene / "model.ply") - CENTER, axis=1)
    assert numpy.abs(distance - RADIUS).max() < 0.5

    returned = check_told(MODULE, result, scene)
    assert float(returned["volumeMl"]) == pytest.approx(4 / 3 * numpy.pi * RADIUS**3 / 1000, rel=0.02)


def test_curves_of_few_points_are_the_splines_that_3d_slicer_shows(scene):
    """Each by 8 points, of which straight lines would lose a tenth of the volume."""
    for path in scene.glob("*.mrk.json"):
        curve = json.loads(path.read_text())
        curve["markups"][0]["controlPoints"] = curve["markups"][0]["controlPoints"][::5]
        path.write_text(json.dumps(curve))
    result = run_module(scene, outputMask=scene / "mask.nrrd")
    assert (result.returncode, result.stderr) == (0, ""), result
    returned = dict(line.split(" = ") for line in (scene / "returned.params").read_text().splitlines())
    assert float(returned["volumeMl"]) == pytest.approx(4 / 3 * numpy.pi * RADIUS**3 / 1000, rel=0.02)
    assert "took 9 curves as the spline that 3D Slicer draws" in result.stdout


@pytest.fixture
def painted(tmp_path):
    """A ball of which every fifth slice is painted, as 3D Slicer leaves a label map for a module, and its image."""
    folder = tmp_path / "Slicer temp"
    folder.mkdir()
    ball = ball_array()
    sparse = numpy.zeros_like(ball)
    sparse[..., 1::5] = ball[..., 1::5]
    for name, array in (("painted", sparse), ("image", 100 * ball.astype(numpy.int16))):
        write_nifti(folder / f"{name}.nii.gz", array)
        assert kontur("convert", folder / f"{name}.nii.gz", folder / f"{name}.nrrd").returncode == 0
    return folder


@pytest.mark.parametrize("with_image", [False, True])
def test_a_run_fills_what_was_painted_as_the_command_does(painted, with_image):
    files = {"paintedLabels": painted / "painted.nrrd", "filledLabels": painted / "filled.nrrd"}
    image = ["--image", painted / "image.nrrd"] if with_image else []
    result = run_as_slicer(FILL, painted, files | ({"image": image[1]} if with_image else {}))
    assert (result.returncode, result.stderr) == (0, ""), result
    assert kontur("fill", painted / "painted.nrrd", *image, "--output", painted / "wanted.nrrd", "--report", painted / "report.json").returncode == 0
    voxels = [(painted / name).read_bytes().split(b"\n\n", 1)[1] for name in ("filled.nrrd", "wanted.nrrd")]
    assert voxels[0] == voxels[1]
    returned = check_told(FILL, result, painted)
    report = json.loads((painted / "report.json").read_text())
    assert returned == {"filledLabelCount": "1", "addedVoxels": str(report["labels"][0]["added_voxels"])}
    assert int(returned["addedVoxels"]) > 1000
    assert ("image" in result.stdout.split("</filter-start>")[1]) == with_image, "what became of the image is said"


@pytest.fixture
def leaking(scene):
    """The ball with a leak as label 2 beside another label, and three of the ball's curves."""
    labels = 2 * ball_array()
    labels[:, -6:, labels.shape[2] // 2 - 2 : labels.shape[2] // 2 + 3] = 2
    labels[:3, :3, :3] = 5
    write_nifti(scene / "labels.nii.gz", labels)
    assert kontur("convert", scene / "labels.nii.gz", scene / "labels.nrrd").returncode == 0
    for n, path in enumerate(sorted(scene.glob("*.mrk.json"))):
        if n > 2:
            path.unlink()
    return scene


def test_a_run_corrects_one_label_as_the_command_does(leaking):
    curves = sorted(leaking.glob("*.mrk.json"))
    files = {"wrongLabels": leaking / "labels.nrrd", "correctedLabels": leaking / "new.nrrd"}
    files |= {f"curve{n}": path for n, path in enumerate(curves, start=1)}
    result = run_as_slicer(CORRECT, leaking, files, label=2)
    assert (result.returncode, result.stderr) == (0, ""), result
    assert kontur("correct", leaking / "labels.nrrd", *curves, "--label", 2, "--output", leaking / "wanted.nrrd", "--report",
                  leaking / "report.json").returncode == 0
    voxels = [(leaking / name).read_bytes().split(b"\n\n", 1)[1] for name in ("new.nrrd", "wanted.nrrd", "labels.nrrd")]
    assert voxels[0] == voxels[1] != voxels[2]
    returned = check_told(CORRECT, result, leaking)
    report = json.loads((leaking / "report.json").read_text())
    assert returned["changedVoxels"] == str(sum(report["voxels"].values())) != "0"
    assert float(returned["volumeMl"]) == pytest.approx(report["volume_ml"], abs=1e-3)
    assert len(report["planes"]) == len(curves)


def test_correcting_needs_curves_and_somewhere_to_write(leaking):
    files = {"wrongLabels": leaking / "labels.nrrd", "curve1": next(leaking.glob("*.mrk.json"))}
    result = run_as_slicer(CORRECT, leaking, dict(files), label=2)
    assert result.returncode == 65 and "no label map was chosen" in result.stderr
    result = run_as_slicer(CORRECT, leaking, {"wrongLabels": files["wrongLabels"], "correctedLabels": leaking / "new.nrrd"})
    assert result.returncode == 65 and "no curves were chosen" in result.stderr


def test_filling_needs_somewhere_to_write_and_spares_its_inputs(painted):
    result = run_as_slicer(FILL, painted, {"paintedLabels": painted / "painted.nrrd"})
    assert result.returncode == 65 and "no label map was chosen" in result.stderr
    before = (painted / "painted.nrrd").read_bytes()
    result = run_as_slicer(FILL, painted, {name: painted / "painted.nrrd" for name in ("paintedLabels", "filledLabels")})
    assert result.returncode != 0 and "painted.nrrd" in result.stderr
    assert (painted / "painted.nrrd").read_bytes() == before


def test_one_output_is_enough_and_none_is_an_error(scene):
    assert run_module(scene, outputModel=scene / "model.ply").returncode == 0
    assert not (scene / "mask.nrrd").exists()
    result = run_module(scene)
    assert result.returncode == 65
    assert "neither a label map nor a model" in result.stderr


def test_any_of_the_curves_may_be_left_out(scene):
    for path in sorted(scene.glob("*.mrk.json"))[:-2]:
        path.unlink()
    last = sorted(scene.glob("*.mrk.json"))
    words = ["--reference", scene / "reference.nrrd", "--contour_5", last[0], "--contour_24", last[1], "--mask", scene / "mask.nrrd"]
    result = subprocess.run([MODULE, *map(str, words)], capture_output=True, text=True, timeout=60)
    assert (result.returncode, result.stderr) == (0, ""), result
    assert (scene / "mask.nrrd").exists()


def test_a_failure_has_an_exit_code_a_reason_and_no_output(scene):
    (scene / "curve 3.mrk.json").write_text("{}")
    result = run_module(scene, outputMask=scene / "mask.nrrd")
    assert result.returncode not in (0, None)
    assert "curve 3.mrk.json" in result.stderr
    assert not (scene / "mask.nrrd").exists()


@EACH
def test_the_module_runs_through_a_link(module, tmp_path):
    (tmp_path / module.name).symlink_to(module)
    result = subprocess.run([tmp_path / module.name, "--xml"], capture_output=True)
    assert result.stdout.startswith(b"<?xml")


# What 3D Slicer's published schema of markups (1.0.3) says of everything that kontur writes; stricter, in that nothing else may occur.
NUMBERS = {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}
POINT = {"type": "object", "required": ["position", "positionStatus"], "additionalProperties": False, "properties": {
    "id": {"type": "string"}, "label": {"type": "string"}, "description": {"type": "string"}, "position": NUMBERS,
    "positionStatus": {"enum": ["undefined", "preview", "defined"]}}}
CURVE = {"type": "object", "required": ["type", "coordinateSystem", "coordinateUnits", "controlPoints"], "additionalProperties": False,
         "properties": {"type": {"const": "ClosedCurve"}, "name": {"type": "string"}, "coordinateSystem": {"enum": ["LPS", "RAS"]},
                        "coordinateUnits": {"enum": ["mm", "um"]}, "controlPoints": {"type": "array", "items": POINT}}}
MARKUPS = {"type": "object", "required": ["@schema", "markups"], "additionalProperties": False, "properties": {
    "@schema": {"type": "string", "pattern": r"^https://raw\.githubusercontent\.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/"
                                             r"Schema/markups-schema-v1\.[0-9]+\.[0-9]+\.json#*$"},
    "kontur": {"type": "object", "additionalProperties": {"type": "string"}}, "markups": {"type": "array", "items": CURVE}}}


def test_written_curves_follow_the_published_rules(tmp_path):
    jsonschema = pytest.importorskip("jsonschema")
    planes = ball_planes()
    planes[0]["contours"][0]["hole"] = True
    write_planes(tmp_path / "ball.json", planes)
    assert kontur("convert", tmp_path / "ball.json", tmp_path / "ball.mrk.json").returncode == 0
    text = (tmp_path / "ball.mrk.json").read_text()
    document = json.loads(text)
    jsonschema.validate(document, MARKUPS)
    assert len(document["markups"]) == 9
    assert all(re.search(r"[.e]", number) for number in re.findall(r'"position": \[(.*?)\]', text)[0].split(","))
    wrong = json.loads(text)
    wrong["markups"][0]["coordinateSystem"] = "lps"
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(wrong, MARKUPS)
