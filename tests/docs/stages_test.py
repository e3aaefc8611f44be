# SPDX-License-Identifier: Apache-2.0
"""The pages of the stages list each option with its default, and their pictures are made by tools/stage_pictures."""
import inspect
import os
import pathlib
import re
import subprocess
import sys

import pytest

kontur = pytest.importorskip("kontur", reason="this build has no Python package")

ROOT = pathlib.Path(__file__).parents[2]
STAGES = ROOT / "docs" / "stages"
SHARED = {"threads", "progress", "stop", "on_note", "listener", "function"}  # described once, in docs/python.md


def tables():
    """Name of each function and what the table below it says: {option: default as text}."""
    for page in sorted(STAGES.glob("*.md")):
        for names, table in re.findall(r"^Options of (.+?):\n\n((?:\|.*\n)+)", page.read_text(), re.MULTILINE):
            head, _, *rows = [[cell.strip() for cell in row.strip("|\n").split("|")] for row in table.splitlines()]
            assert head == ["option", "default", "unit", "meaning"], page
            for name in re.findall(r"`kontur\.(?:stages\.)?(\w+)`", names):
                yield name, {row[0].strip("`"): row[1] for row in rows}


TABLES = list(tables())


def options(name):
    """The options that the function has: {name: default}."""
    value = getattr(kontur.stages, name, None) or getattr(kontur, name)
    parameters = inspect.signature(value.__init__ if inspect.isclass(value) else value).parameters.values()
    return {p.name: p.default for p in parameters if p.default is not p.empty and p.name not in SHARED}


@pytest.mark.parametrize("name, table", TABLES, ids=[name for name, _ in TABLES])
def test_each_option_stands_there_with_its_default(name, table):
    assert table == {option: repr(default) for option, default in options(name).items()}


def test_every_stage_with_options_has_a_table():
    named = {name for name, _ in TABLES}
    assert {"prepare", "reconcile", "fit", "solve", "trace", "Editor", "LiveEditor", "check_contour_set", "FastFunction"} <= named


def test_every_stage_has_a_page_with_a_picture_and_its_source():
    index = (STAGES / "README.md").read_text()
    pages = [page for page in STAGES.glob("*.md") if page.name != "README.md"]
    assert len(pages) == 12
    for page in pages:
        text = page.read_text()
        assert f"]({page.name})" in index
        assert f"](../images/stage_{page.stem}.png)" in text
        assert "**Source.**" in text


def test_the_program_makes_every_picture(tmp_path):
    pytest.importorskip("matplotlib")
    result = subprocess.run([sys.executable, ROOT / "tools" / "stage_pictures", tmp_path], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    made = {path.name for path in tmp_path.iterdir()}
    assert made == {path.name for path in (ROOT / "docs" / "images").glob("stage_*.png")}
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in tmp_path.iterdir())
