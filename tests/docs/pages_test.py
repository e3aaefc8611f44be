# SPDX-License-Identifier: Apache-2.0
"""Every command and program in the documentation runs, and every link leads somewhere."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest

pytest.importorskip("kontur", reason="this build has no Python package")
pytest.importorskip("pydicom")

from blocks import Block, Runner, blocks_of, lacks
from material import write_material

ROOT = pathlib.Path(__file__).parents[2]
HERE = pathlib.Path(__file__).parent
BUILD = pathlib.Path(os.environ["KONTUR_BUILD"])
NOT_RUN = {"CONTRIBUTING.md": 2, "README.md": 1, "docs/accuracy/drawings.md": 1, "docs/accuracy/image.md": 1, "docs/accuracy/organs.md": 3,
           "docs/accuracy/shapes.md": 1, "docs/accuracy/sureness.md": 1, "docs/correct.md": 1, "docs/pacs.md": 1, "docs/performance.md": 3, "docs/python.md": 1,
           "docs/reliability.md": 1}
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])


def named(page):
    return str(page.relative_to(ROOT))


@pytest.fixture(scope="session")
def material(tmp_path_factory):
    folder = tmp_path_factory.mktemp("material")
    write_material(folder)
    return folder


@pytest.fixture(scope="session")
def prefix(tmp_path_factory):
    """Where the library is installed."""
    prefix = tmp_path_factory.mktemp("prefix")
    for component in ("library", "development"):
        subprocess.run(["cmake", "--install", BUILD, "--prefix", prefix, "--component", component], check=True, capture_output=True)
    return prefix


@pytest.fixture
def runner(material, prefix, tmp_path, monkeypatch):
    folder = tmp_path / "page"
    shutil.copytree(material, folder)
    for name in ("tools", "examples", "python"):
        (folder / name).symlink_to(ROOT / name)
    (folder / "build/release/bin").mkdir(parents=True)
    (folder / "build/release/bin/kontur").symlink_to(HERE / "kontur")
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin/python3").symlink_to(sys.executable)
    libraries = next(prefix.rglob("libkontur.so")).parent
    environment = {
        **os.environ, "PATH": f"{HERE}:{tmp_path}/bin:{os.environ['PATH']}", "HOME": str(folder), "XDG_DATA_HOME": str(folder / "data"),
        "MPLBACKEND": "Agg", "LD_LIBRARY_PATH": str(libraries), "CMAKE_PREFIX_PATH": str(prefix),
        "PKG_CONFIG_PATH": str(libraries / "pkgconfig"),
    }
    monkeypatch.chdir(folder)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    flags = ["-I", str(prefix / "include"), "-L", str(libraries)]
    return Runner(folder, environment, ["g++", "-std=c++20", "-Wall", "-Werror", *flags])


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_each_block_runs(page, runner):
    for block in blocks_of(page):
        if block.reason_not_to_run or lacks(block):
            continue
        try:
            runner.run(block)
        except BaseException as error:
            raise AssertionError(f"{named(page)}:{block.line}: {error!r}\n{block.text}\n{error}") from error


def test_what_is_not_run_says_why_and_is_little():
    """The list is here so that adding to it is a decision."""
    left_out = [(named(page), block) for page in PAGES for block in blocks_of(page) if block.reason_not_to_run is not None]
    assert all(len(block.reason_not_to_run) > 10 for _, block in left_out)
    counts = {}
    for page, _ in left_out:
        counts[page] = counts.get(page, 0) + 1
    assert counts == NOT_RUN


def anchors_of(text):
    """As GitHub makes them of headings."""
    titles = re.findall(r"^#+ (.*)$", re.sub(r"```.*?```", "", text, flags=re.DOTALL), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower().replace("`", "")).replace(" ", "-") for title in titles}


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_links_and_pictures_are_there(page):
    text = re.sub(r"```.*?```", "", page.read_text(), flags=re.DOTALL)
    targets = re.findall(r"\]\(([^)\s]+)\)", text) + re.findall(r"^\[[^\]]+\]: (\S+)", text, re.MULTILINE)
    for target in targets:
        if re.match(r"https?:", target):
            continue
        file, _, anchor = target.partition("#")
        path = (page.parent / file) if file else page
        assert path.exists(), target
        if anchor and path.suffix == ".md":
            assert anchor in anchors_of(path.read_text()), target


def test_pages_that_cannot_be_checked_are_refused(tmp_path):
    page = tmp_path / "page.md"
    for text in ("    kontur inspect ct.nii.gz\n", "```\nkontur inspect\n```\n", "```sh\nkontur inspect\n"):
        page.write_text("Words.\n\n" + text)
        with pytest.raises(ValueError, match="page.md:"):
            blocks_of(page)
    page.write_text("- a list\n\n    with more words\n")
    assert blocks_of(page) == []


def test_a_block_that_fails_is_noticed(runner):
    with pytest.raises(AssertionError, match="exit code 74"):
        runner.run(Block(1, "sh", "", "kontur inspect absent.nii\n"))
    with pytest.raises(AssertionError, match="printed"):
        runner.run(Block(1, "text", "output", "something else\n"))
    with pytest.raises(ZeroDivisionError):
        runner.run(Block(1, "python", "", "1 / 0\n"))
