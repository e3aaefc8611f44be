# SPDX-License-Identifier: Apache-2.0
"""The examples in docstrings run, everything has a docstring, and the stubs say what the module is."""
import doctest
import inspect
import os
import pathlib
import re
import subprocess
import sys

import kontur
import numpy
import pytest

ROOT = pathlib.Path(__file__).parents[2]
NAMES = {"kontur": kontur, "np": numpy}


def public():
    """What `kontur` and its modules give, with its name."""
    for module in (kontur, kontur.stages, kontur.archive):
        for name in module.__all__:
            yield name, getattr(module, name)


def documented():
    yield "kontur", kontur
    yield "kontur.stages", kontur.stages
    yield "kontur.archive", kontur.archive
    for name, value in public():
        yield name, value
        if isinstance(value, type):
            for member, inner in vars(value).items():
                if not member.startswith("_") and member != "kind":
                    yield f"{name}.{member}", inner


@pytest.mark.parametrize("name, value", documented())
def test_docstrings_are_there_and_their_examples_run(name, value):
    text = inspect.getdoc(value)
    assert text, f"{name} has no docstring"
    assert not re.search(r"^@\w", text, re.MULTILINE), "a mark that nothing was filled in for"
    test = doctest.DocTestParser().get_doctest(text, dict(NAMES), name, None, None)
    assert doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(test).failed == 0


@pytest.mark.parametrize("name, function", [(name, value) for name, value in public() if not isinstance(value, type)])
def test_signatures_can_be_inspected_and_their_parameters_are_described(name, function):
    parameters = inspect.signature(function).parameters
    text = inspect.getdoc(function)
    if "Parameters\n-----" in text:
        section = text.split("Parameters\n----------\n")[1].split("\n\n")[0]
        described = [word.strip() for line in section.splitlines() if " : " in line and line[0] != " "
                     for word in line.split(" : ")[0].split(",")]
        described += [line.strip() for line in section.splitlines() if line in ("a, b", "path", "planes")]
        assert sorted(parameters) == sorted(described), name


def test_stubs_and_module_agree(tmp_path):
    pytest.importorskip("mypy")
    here = pathlib.Path(__file__).parent
    result = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "kontur", "--concise", "--mypy-config-file", here / "mypy.ini"],
        capture_output=True, text=True, cwd=tmp_path)
    # pybind11's classes have a metaclass, and those that only the library makes an __init__ that refuses.
    about_pybind11 = ("is inconsistent, metaclass differs", '__init__ is inconsistent, stub does not have *args argument "args"')
    lines = [line for line in (result.stdout + result.stderr).splitlines() if not line.endswith(about_pybind11)]
    assert lines == []


def test_the_readmes_program_is_clean_for_strict_type_checkers(tmp_path):
    pytest.importorskip("mypy")
    [program] = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    more = """
flag: bool = len(contours) > 3
for contour in contours:
    reveal_type(contour)
reveal_type(contours[0])
reveal_type(contours[1:])
reveal_type(kontur.segment(contours, image.grid).mesh)
reveal_type(kontur.segment(contours, image.grid, mesh=flag).mesh)
reveal_type(liver.mesh)
"""
    (tmp_path / "program.py").write_text(program + more)
    result = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path / "cache", "program.py"],
                            capture_output=True, text=True, cwd=tmp_path, env={**os.environ, "MYPYPATH": os.environ["PYTHONPATH"]})
    assert result.returncode == 0, result.stdout + result.stderr
    told = re.findall(r'Revealed type is "(.*)"', result.stdout)
    assert told == ["kontur.Contour", "kontur.Contour", "kontur.ContourSet", *["Union[kontur.TriangleMesh, None]"] * 2,
                    "kontur.TriangleMesh"], result.stdout


def test_the_programs_in_the_documentation_run(tmp_path, monkeypatch):
    case = kontur.phantom_case("liver_orthogonal14")
    (tmp_path / "demo").mkdir()
    kontur.write_contours(tmp_path / "demo" / "liver_orthogonal14.json", case.contours)
    grid = kontur.grid_around(case.contours.bounding_box, [4, 4, 4], 20)
    kontur.write_image(tmp_path / "demo" / "liver_ct.nii.gz", kontur.make_phantom_image(grid))
    monkeypatch.chdir(tmp_path)
    for page, blocks in (("README.md", 1), ("docs/python.md", 5)):
        programs = re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(), re.DOTALL)
        assert len(programs) >= blocks
        exec(compile("\n".join(programs), page, "exec"), {})
    assert (tmp_path / "liver.nii.gz").exists() and (tmp_path / "liver.stl").exists()


@pytest.mark.parametrize("page", ["README.md", "docs/guide.md"])
def test_the_first_program_of_a_page_makes_the_mask_of_the_command_line(page, tmp_path, monkeypatch):
    """On contours drawn by hand, where the image changes the mask."""
    program = re.search(r"```python\n(.*?)```", (ROOT / page).read_text(), re.DOTALL)[1].replace("orthogonal14.json", "orthogonal14_hand.json")
    monkeypatch.chdir(tmp_path)
    subprocess.run([os.environ["KONTUR_CLI"], "phantom", "demo", "--scan", "liver", "--quiet"], check=True)
    contours, image = re.findall(r'(demo/\S+?)"', program)[:2]
    names = {}
    exec(compile(program, page, "exec"), names)
    for use, same in (("auto", True), ("off", False)):
        subprocess.run([os.environ["KONTUR_CLI"], "segment", contours, "--image", image, "--use-image", use, "--output", "m.nii.gz"], check=True)
        assert numpy.array_equal(names["liver"].mask.values, kontur.read_mask("m.nii.gz").values) == same, use


def test_the_example_makes_its_figure(tmp_path):
    pytest.importorskip("matplotlib")
    example = pathlib.Path(__file__).parents[1] / "examples" / "kidney_figure.py"
    result = subprocess.run([sys.executable, example, tmp_path / "kidney.png"], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    assert (tmp_path / "kidney.png").read_bytes().startswith(b"\x89PNG") and "Dice 0.9" in result.stdout
