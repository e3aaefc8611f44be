# SPDX-License-Identifier: Apache-2.0
"""The package as a wheel and an sdist, made by the documentation's lines word by word, without network.

Only the compiler's work is replaced: where a line builds anew, the module of this build is laid where CMake would put it."""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tarfile

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
    [sdist] = run(SDIST).glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        names = {name.split("/", 1)[1] for name in archive.getnames()}
        project = archive.extractfile(sdist.name.removesuffix(".tar.gz") + "/pyproject.toml").read().decode()
    assert {"CMakeLists.txt", "src/kontur/kontur.h", "python/wheel_backend.py", "packaging/copyright", "apps/archive/http.cpp"} <= names
    assert {f"third_party/{name}" for name in ("fmt/format-inl.h", "fmt/copyright", "nlohmann/json.hpp", "curl/curl.h", "curl/copyright")} <= names
    assert 'requires = ["numpy", "pybind11' in project and 'backend-path = ["python"]' in project
    expect_wheel(run(FROM_SDIST), tmp_path / "site")


def test_what_is_missing_is_said_and_left_out(tmp_path):
    missing = [f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in ("PkgConfig", "DCMTK", "ZLIB", "BZip2", "PNG", "OpenSSL")]
    command = ["cmake", "-S", ROOT, "-B", tmp_path, "-G", "Ninja", "-DKONTUR_WHEEL=ON", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", "-DOPENBLAS_LIBRARY=NOTFOUND"]
    said = subprocess.run([*command, *missing], check=True, capture_output=True, text=True).stdout
    for words in ("has no compressed files and no PNG", "has no DICOM", "draws no pictures", "takes its own SHA-256"):
        assert f"-- The wheel {words}: " in said, said
    sources = set(re.findall(r"/(\w+)\.cpp\"", (tmp_path / "compile_commands.json").read_text()))
    assert {"without_dcmtk", "no_compression", "no_png", "picture_without_cairo", "sha256_without_openssl"} <= sources
    assert not {"dicom_series", "deflate", "png", "canvas"} & sources and "contour_json" in sources
