# SPDX-License-Identifier: Apache-2.0
"""The newest clang that Debian 12 has, with its own library, libc++: that of macOS, Android and WebAssembly."""
import shutil
import subprocess

import pytest

from core_build import expect_to_compile, required


def test_clang_compiles_it_with_libcxx(tmp_path):
    compiler = [required(shutil.which("clang++-19"), "clang++-19"), "-stdlib=libc++"]
    (tmp_path / "version.cpp").write_text("#include <version>\n#ifndef _LIBCPP_VERSION\n#error\n#endif\n")
    if subprocess.run([*compiler, "-fsyntax-only", tmp_path / "version.cpp"], capture_output=True).returncode != 0:
        pytest.skip("libc++-19-dev is missing (tools/packages.txt)")
    expect_to_compile(compiler, tmp_path, warnings_are_errors=False)
