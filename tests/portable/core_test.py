# SPDX-License-Identifier: Apache-2.0
"""KONTUR_CORE: the library alone, without what the whole one is linked with."""
import os
import pathlib
import re
import subprocess

import pytest

from core_build import ROOT, configure_core

CORE, WHOLE = os.environ["KONTUR_CORE_PROGRAM"], os.environ["KONTUR_WHOLE_PROGRAM"]
CASES = ["kidney_radial6", "metastasis_parallel7"]
LEFT_OUT = ["DCMTK", "PNG", "ZLIB", "BZip2", "OpenSSL", "PkgConfig", "Boost", "SQLite3", "CLI11", "fmt", "nlohmann_json"]


def test_it_is_linked_with_the_c_and_cpp_libraries_alone():
    listed = subprocess.run(["ldd", CORE], check=True, capture_output=True, text=True).stdout
    loaded = {pathlib.Path(line.split()[0]).name.split(".so")[0] for line in listed.splitlines()}
    assert {"libstdc++", "libc"} <= loaded
    assert {name for name in loaded if not name.startswith("ld-linux")} <= {"linux-vdso", "libstdc++", "libm", "libgcc_s", "libc"}


def test_it_gives_the_bytes_of_the_whole_library(tmp_path):
    for program, name in ((CORE, "core"), (WHOLE, "whole")):
        (tmp_path / name).mkdir()
        subprocess.run([program, tmp_path / name, *CASES], check=True)
    for case in CASES:
        for suffix in ("json", "nii", "stl"):
            core, whole = ((tmp_path / name / f"{case}.{suffix}").read_bytes() for name in ("core", "whole"))
            assert len(core) > 1000 and core == whole, (case, suffix)


def test_it_is_configured_where_no_other_package_is_found(tmp_path):
    configure_core(tmp_path, *(f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in LEFT_OUT))
    sources = (tmp_path / "compile_commands.json").read_text()
    assert "/io/contours/contour_json.cpp" in sources and "/io/dicom/" not in sources
    # Each source that stands in for a dependency is part of it, and what needs the dependency is not.
    for inside, outside in (("io/bytes/no_compression", "io/bytes/deflate"), ("shape/sha256_without_openssl", "shape/sha256"),
                            ("solve/solvers_without_openblas", "solve/blas"), ("view/picture_without_cairo", "view/canvas")):
        assert f"/{inside}.cpp" in sources and f"/{outside}.cpp" not in sources


@pytest.mark.parametrize("folder", ["base", "shape", "drawing", "bounds", "function", "solve", "fit", "extract", "sampling", "correct", "image",
                                    "moving", "sureness", "measure", "labels", "phantom", "derive"])
def test_no_room_but_io_and_view_includes_what_the_core_lacks(folder):
    for path in (ROOT / "src/kontur" / folder).rglob("*.[hc]*"):
        found = set(re.findall(r"#include <(cairo|dcmtk|openssl|zlib|bzlib|png|cblas|openjpeg|boost|sqlite3)", path.read_text()))
        allowed = {"sha256.cpp": {"openssl"}, "blas.h": {"cblas"}}.get(path.name, set())
        assert found <= allowed, path
