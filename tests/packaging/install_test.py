# SPDX-License-Identifier: Apache-2.0
"""Another program builds against what is installed, by CMake and by pkg-config, and runs."""
import gzip
import os
import pathlib
import re
import shutil
import subprocess

import pytest

BUILD = pathlib.Path(os.environ["KONTUR_BUILD"])
CONSUMER = pathlib.Path(__file__).parent / "consumer"
ROOT = pathlib.Path(__file__).parents[2]


def run(*words, **options):
    result = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=300, **options)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    prefix = tmp_path_factory.mktemp("prefix")
    for component in ("library", "development"):
        run("cmake", "--install", BUILD, "--prefix", prefix, "--component", component)
    return prefix


@pytest.fixture(scope="module")
def libraries(prefix):
    return next(prefix.rglob("libkontur.so")).parent


@pytest.fixture(scope="module")
def flags(libraries):
    environment = {**os.environ, "PKG_CONFIG_PATH": str(libraries / "pkgconfig")}
    return run("pkg-config", "--cflags", "--libs", "kontur", env=environment).split()


def expect_output(program, libraries):
    volume, kind = run(program, env={**os.environ, "LD_LIBRARY_PATH": str(libraries)}).split()
    assert 100 < float(volume) < 150  # the kidney has 124 ml
    assert kind == "invalid_input"


def test_installing_writes_nothing_that_another_installs(tmp_path):
    """Tests and cpack install from one build at once. A manual page that one of them was compressing was empty for another."""
    def documentation():
        return {path: (path.stat().st_ino, path.stat().st_mtime_ns) for path in (BUILD / "command_documentation").rglob("*")}

    before = documentation()
    run("cmake", "--install", BUILD, "--prefix", tmp_path, "--component", "command_line")
    assert documentation() == before
    pages = list(tmp_path.rglob("man1/*.1.gz"))
    assert len(pages) > 10
    for page in pages:
        text = gzip.decompress(page.read_bytes())
        assert text == (BUILD / "command_documentation/man1" / page.stem).read_bytes() and text.startswith(b".TH ")


def test_a_cmake_project_finds_it(prefix, libraries, tmp_path):
    run("cmake", "-S", CONSUMER, "-B", tmp_path, f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Debug")
    run("cmake", "--build", tmp_path)
    expect_output(tmp_path / "consumer", libraries)


def test_another_minor_version_is_refused(prefix, tmp_path):
    shutil.copytree(CONSUMER, tmp_path / "source")
    lists = tmp_path / "source" / "CMakeLists.txt"
    lists.write_text(lists.read_text().replace("kontur 0.1", "kontur 0.0"))
    result = subprocess.run(["cmake", "-S", tmp_path / "source", "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={prefix}"],
                            capture_output=True, text=True)
    assert result.returncode != 0 and "compatible" in result.stderr


def test_pkg_config_finds_it(flags, libraries, tmp_path):
    run("g++", "-std=c++20", CONSUMER / "main.cpp", "-o", tmp_path / "consumer", *flags)
    expect_output(tmp_path / "consumer", libraries)


def test_the_readmes_program_compiles(flags, tmp_path):
    [program] = re.findall(r"```cpp\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    (tmp_path / "main.cpp").write_text(program)
    run("g++", "-std=c++20", "-Wall", "-Werror", tmp_path / "main.cpp", "-o", tmp_path / "program", *flags)


def test_the_shared_library_shows_only_our_names_and_says_its_version(libraries):
    assert "libkontur.so.0.1" in run("readelf", "-d", libraries / "libkontur.so")
    names = [line.split(maxsplit=2)[2] for line in run("nm", "-DC", "--defined-only", libraries / "libkontur.so").splitlines()]
    assert len(names) > 100
    assert [name for name in names if not re.match(r"(kontur::|(typeinfo|typeinfo name|vtable) for kontur::)", name)] == []


def test_each_part_brings_its_licence(prefix):
    for package in ("libkontur0.1", "libkontur-dev"):
        folder = prefix / "share/doc" / package
        assert (folder / "LICENSE").read_bytes() == (ROOT / "LICENSE").read_bytes()
        assert (folder / "copyright").read_bytes() == (ROOT / "packaging/copyright").read_bytes()


def test_installed_headers_are_the_public_ones(prefix):
    headers = list((prefix / "include").rglob("*.h"))
    text = "\n".join(header.read_text() for header in headers)
    assert len(headers) > 30
    assert re.findall(r"#include <\S+/\S+>|#include <\S+\.hp*>", text) == []  # no third-party types
