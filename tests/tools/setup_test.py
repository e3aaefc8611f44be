# SPDX-License-Identifier: Apache-2.0
"""tools/setup installs the lists that it is given and no other, and what the Makefile sets up for a target is enough for it."""
import os
import pathlib
import re
import shutil
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
FAKES = {"dpkg-query": 'for name; do [ "$name" = cmake ] && echo "cmake installed"; done; exit 1', "apt-get": 'echo "$@" >>"$LOG"',
         "id": "echo 0"}


def packages_of(*lists):
    name, packages = None, set()
    for line in (ROOT / "tools/packages.txt").read_text().splitlines():
        word = re.split(r"[=\s#]", line)[0]
        if word.startswith("["):
            name = word.strip("[]")
        elif word and name in lists:
            packages.add(word)
    return packages


@pytest.fixture
def installed(tmp_path):
    """Runs tools/setup on a machine that has cmake alone; returns what it had apt-get install."""
    for name, text in FAKES.items():
        (tmp_path / name).write_text(f"#!/bin/sh\n{text}\n")
        (tmp_path / name).chmod(0o755)
    for name in ("bash", "dirname", "sed", "comm", "sort", "env"):
        (tmp_path / name).symlink_to(shutil.which(name))

    def run(*words):
        log = tmp_path / "log"
        log.write_text("")
        subprocess.run([ROOT / "tools/setup", *words], env={"PATH": str(tmp_path), "LOG": str(log)}, check=True, timeout=60,
                       capture_output=True)
        return {word for line in log.read_text().splitlines() if line.startswith("install") for word in line.split()[1:] if word[0] != "-"}

    return run


@pytest.mark.parametrize("lists", [["build"], ["python"], ["test"], ["build", "python"]])
def test_only_the_lists_named_are_installed(installed, lists):
    assert len(packages_of(*lists)) > 3
    assert installed(*lists) == packages_of(*lists) - {"cmake"}


def test_without_words_all_lists_are_installed(installed):
    assert installed() == packages_of("build", "python", "test") - {"cmake"}


def test_a_package_is_installed_beside_a_list_or_alone(installed):
    assert installed("gcovr") == {"gcovr"}
    assert installed("build", "gcovr") == packages_of("build") - {"cmake"} | {"gcovr"}


@pytest.mark.parametrize("target, lists", [("demo", "build"), ("build", "build python"), ("test", "build python test")])
def test_a_target_sets_up_its_lists_only(target, lists, tmp_path):
    shutil.copy(ROOT / "Makefile", tmp_path)
    lines = subprocess.run(["make", "--dry-run", target], cwd=tmp_path, capture_output=True, text=True, check=True).stdout.splitlines()
    assert [line for line in lines if line.startswith("tools/setup")] == [f"tools/setup {lists}"]


def test_the_program_is_configured_without_the_packages_of_tests_and_of_python(tmp_path):
    """With the words of make demo; CMake is forbidden to find what the list build does not have."""
    shutil.copy(ROOT / "Makefile", tmp_path)
    lines = subprocess.run(["make", "--dry-run", "demo"], cwd=tmp_path, capture_output=True, text=True, check=True).stdout.splitlines()
    [words] = [line.split() for line in lines if line.startswith("cmake --preset")]
    options = [word for word in words if word.startswith("-D")]
    hidden = [f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in ("GTest", "Python", "pybind11")]
    result = subprocess.run(["cmake", "-S", ROOT, "-B", tmp_path / "build", "-G", "Ninja", "-DKONTUR_BUILD_PAGE=OFF", *options, *hidden],
                            capture_output=True, text=True, timeout=250, env={**os.environ, "CCACHE_DISABLE": "1"})
    assert result.returncode == 0, result.stdout + result.stderr
    targets = subprocess.run(["ninja", "-C", tmp_path / "build", "-t", "targets", "all"], capture_output=True, text=True, check=True).stdout
    assert "bin/kontur:" in targets and "_tests" not in targets and "_core" not in targets
