# SPDX-License-Identifier: Apache-2.0
"""Another compiler with the library of ours."""
import shutil

from core_build import expect_to_compile, required


def test_clang_compiles_it(tmp_path):
    expect_to_compile([required(shutil.which("clang++-14"), "clang++-14"), "-DFMT_SHARED"], tmp_path, warnings_are_errors=True)
