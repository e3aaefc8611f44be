# SPDX-License-Identifier: Apache-2.0
"""The C++ sources are as `make format` leaves them."""
import pathlib
import shutil
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def test_the_sources_are_formatted():
    if not shutil.which("clang-format-14"):
        pytest.skip("needs clang-format-14")
    if not (ROOT / ".git").exists():
        pytest.skip("needs git's list of the sources")
    listed = subprocess.run(["git", "ls-files", "*.h", "*.cpp"], cwd=ROOT, capture_output=True, text=True, check=True, timeout=60)
    sources = listed.stdout.split()
    assert len(sources) > 1000
    answer = subprocess.run(["clang-format-14", "--dry-run", *sources], cwd=ROOT, capture_output=True, text=True, timeout=240)
    assert answer.returncode == 0 and not answer.stderr, "make format\n" + answer.stderr[:3000]
