# SPDX-License-Identifier: Apache-2.0
"""The Debian packages hold what they should, name what they need, and run from where they are unpacked."""
import json
import os
import pathlib
import re
import shutil
import subprocess

import pytest

BUILD = pathlib.Path(os.environ["KONTUR_BUILD"])
ROOT = pathlib.Path(__file__).parents[2]
pytestmark = pytest.mark.skipif(not shutil.which("dpkg-shlibdeps"), reason="dpkg-shlibdeps is not installed")


def run(*words, **options):
    result = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=300, **options)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


@pytest.fixture(scope="module")
def packages(tmp_path_factory):
    folder = tmp_path_factory.mktemp("packages")
    run("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", folder, cwd=folder)
    return {path.name.split("_")[0]: path for path in folder.glob("*.deb")}


@pytest.fixture(scope="module")
def tree(packages, tmp_path_factory):
    tree = tmp_path_factory.mktemp("tree")
    for package in packages.values():
        run("dpkg-deb", "--extract", package, tree)
    return tree


def field(package, name):
    return run("dpkg-deb", "--field", package, name)


def contents(package):
    return re.findall(r" \./(\S+)", run("dpkg-deb", "--contents", package))


def test_each_part_is_a_package(packages):
    assert {"kontur", "libkontur0.1", "libkontur-dev"} <= set(packages)
    assert "usr/bin/kontur" in contents(packages["kontur"])
    assert "usr/share/man/man1/kontur-segment.1.gz" in contents(packages["kontur"])
    assert any(name.endswith("libkontur.so.0.1") for name in contents(packages["libkontur0.1"]))
    assert "usr/include/kontur/kontur.h" in contents(packages["libkontur-dev"])


def test_lintian_finds_no_error(packages):
    if not shutil.which("lintian"):
        pytest.skip("lintian is not installed")
    result = subprocess.run(["lintian", "--allow-root", "--fail-on", "error", *packages.values()], capture_output=True, text=True, timeout=300)
    assert result.returncode == 0, result.stdout + result.stderr


def test_no_binary_has_a_search_path(tree):
    for binary in [tree / "usr/bin/kontur", *tree.rglob("*.so*")]:
        assert "RUNPATH" not in run("readelf", "-d", binary), binary


def test_3d_slicers_modules_lie_where_its_page_says(packages):
    [folder] = re.findall(r"Debian package has it as\s`/(.*?)`", (ROOT / "docs/slicer.md").read_text())
    assert {f"{folder}/KonturSegment", f"{folder}/KonturFill", f"{folder}/KonturCorrect"} <= set(contents(packages["kontur"]))


def test_each_has_its_licence(packages, tree):
    for name, package in packages.items():
        assert {f"usr/share/doc/{name}/copyright", f"usr/share/doc/{name}/LICENSE"} <= set(contents(package)), name
        assert (tree / f"usr/share/doc/{name}/LICENSE").read_bytes() == (ROOT / "LICENSE").read_bytes()
        assert "localhost" not in field(package, "Maintainer")


def test_the_copyright_file_can_be_read_by_programs(tree):
    """Debian's machine-readable format: every licence that a paragraph names is given, and every one given is named."""
    text = (tree / "usr/share/doc/kontur/copyright").read_text()
    header, *paragraphs = text.strip().split("\n\n")
    assert header.startswith("Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n")
    files = [paragraph for paragraph in paragraphs if paragraph.startswith("Files: ")]
    assert all("\nCopyright: " in paragraph for paragraph in files)
    named = {re.search(r"^License: (\S+)$", paragraph, re.MULTILINE)[1] for paragraph in files}
    given = [re.match(r"License: (\S+)\n ", paragraph)[1] for paragraph in paragraphs if paragraph not in files]
    assert sorted(named) == sorted(given)
    assert all(line == "" or line.startswith(" ") or re.match(r"[A-Z][A-Za-z-]+: ", line) for line in text.splitlines())


def test_what_is_compiled_in_is_in_the_copyright_file():
    """Header-only libraries and the page's packages, by the lines that include them."""
    text = (ROOT / "packaging/copyright").read_text()
    included = set()
    for folder in ("src", "apps", "python/src"):
        for path in (ROOT / folder).rglob("*.[hc]*"):
            included |= set(re.findall(r"^#\s*include <(nlohmann|CLI|boost|pybind11)[/.]", path.read_text(errors="replace"), re.MULTILINE))
    assert len(included) == 4
    for library in included:
        assert f"Files: /usr/include/{library}" in text
    for package in json.loads((ROOT / "apps/viewer/web/package.json").read_text())["dependencies"]:
        assert f"node_modules/{package}/*" in text


def test_they_name_what_they_need(packages):
    for name in ("kontur", "libkontur0.1"):
        depends = field(packages[name], "Depends")
        for library in ("libc6", "libcairo2", "libdcmtk17", "libopenblas0", "libpng16-16"):
            assert library in depends, (name, depends)
    assert "libcurl4" in field(packages["kontur"], "Depends")
    assert "libkontur0.1 (= " in field(packages["libkontur-dev"], "Depends")
    if "python3-kontur" in packages:
        assert "python3-numpy" in field(packages["python3-kontur"], "Depends")
        assert "libcurl4" in field(packages["python3-kontur"], "Recommends"), "for archives"


def test_nothing_points_at_where_it_was_built(tree):
    binaries = [tree / "usr/bin/kontur", *tree.rglob("*.so*")]
    for binary in binaries:
        assert str(BUILD) not in run("readelf", "-d", binary)


def test_the_program_runs_from_where_it_is_unpacked(tree, tmp_path):
    assert run(tree / "usr/bin/kontur", "--version").startswith("kontur ")
    assert "no such file" in subprocess.run([tree / "usr/bin/kontur", "inspect", tmp_path / "none.nii"],
                                            capture_output=True, text=True).stderr.lower()


def test_the_python_package_runs_from_where_it_is_unpacked(packages, tree):
    if "python3-kontur" not in packages:
        pytest.skip("this build has no Python package")
    program = "import kontur; print(kontur.__file__, len(kontur.phantom_case_names()))"
    environment = {**os.environ, "PYTHONPATH": str(tree / "usr/lib/python3/dist-packages"), "PYTHONDONTWRITEBYTECODE": "1"}
    assert run("/usr/bin/python3", "-c", program, env=environment).startswith(str(tree))
