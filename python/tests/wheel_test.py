# SPDX-License-Identifier: Apache-2.0
"""The package as a wheel and an sdist, made by the documentation's lines word by word, with pip's build isolation and no network.

Only the compiler's work is replaced: where a line builds anew, the module of this build is laid where CMake would put it."""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["KONTUR_BUILD"])
pytest.importorskip("pip")
[BLOCK] = re.findall(r"## As a wheel\n.*?```sh[^\n]*\n(.*?)```", (ROOT / "docs/python.md").read_text(), re.DOTALL)
ANEW, BUILT, SDIST, FROM_SDIST = BLOCK.splitlines()

# CMake configures in earnest, and says what it would build.
CMAKE = """#!/bin/sh
set -e
[ "$1" = --build ] || exec {cmake} "$@"
{cmake} --build "$2" --target help | grep -q kontur_python
mkdir -p "$2/python/kontur"
[ -e "$2/python/kontur/_core"* ] || cp {module} "$2/python/kontur/"
"""


@pytest.fixture
def run(tmp_path):
    """Runs a line in a copy of the repository, in an environment with nothing in it."""
    work, programs = tmp_path / "work", tmp_path / "programs"
    programs.mkdir()
    cmake = subprocess.run(["which", "cmake"], capture_output=True, text=True, check=True).stdout.strip()
    (programs / "cmake").write_text(CMAKE.format(
        cmake=shlex.quote(cmake), module=shlex.quote(str(next((BUILD / "python/kontur").glob("_core*"))))))
    (programs / "cmake").chmod(0o755)
    files = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\0")
    for name in filter(lambda name: (ROOT / name).is_file(), files):
        (work / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, work / name)
    (work / "build").mkdir()
    (work / "build/release").symlink_to(BUILD)
    subprocess.run("git init -q && git add -A", shell=True, cwd=work, check=True)

    def run_line(line):
        result = subprocess.run(["/bin/sh", "-c", line], cwd=work, capture_output=True, text=True, timeout=250,
                                env={"PATH": f"{programs}:/usr/bin:/bin", "HOME": str(tmp_path), "LANG": "C.UTF-8"})
        assert result.returncode == 0, result.stdout + result.stderr
        return work

    return run_line


def expect_wheel(folder, site):
    [wheel] = folder.glob("*.whl")
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check"]
    subprocess.run([*pip, "install", wheel, "--no-index", "--no-deps", "--target", site], check=True, capture_output=True)
    program = "import kontur; print(kontur.__file__, kontur.__version__, kontur.phantom_case_names()[0])"
    place, version, case = subprocess.run([sys.executable, "-c", program], env={"PYTHONPATH": str(site)}, cwd=folder, check=True,
                                          capture_output=True, text=True).stdout.split()
    assert place.startswith(str(site)) and case == "liver_orthogonal14"
    assert wheel.name.startswith(f"kontur-{version}-cp3")
    assert (site / "kontur/py.typed").exists()
    [information] = site.glob("kontur-*.dist-info")
    metadata = (information / "METADATA").read_text()
    for name, source in (("LICENSE", "LICENSE"), ("copyright", "packaging/copyright")):
        assert (information / name).read_bytes() == (ROOT / source).read_bytes()
        assert f"License-File: {name}\n" in metadata


@pytest.mark.parametrize("line", [ANEW, BUILT])
def test_a_wheel_is_made_and_installed(run, line, tmp_path):
    expect_wheel(run(line), tmp_path / "site")


def test_an_sdist_is_made_and_gives_a_wheel(run, tmp_path):
    run(SDIST)
    expect_wheel(run(FROM_SDIST), tmp_path / "site")
