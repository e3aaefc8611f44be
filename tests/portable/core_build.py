# SPDX-License-Identifier: Apache-2.0
"""What the tests of other compilers and of the core share."""
import pathlib
import re
import subprocess
import time

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
FLAGS = ["-std=c++20", "-Wall", "-Wextra", "-Wconversion", "-Wno-sign-conversion", f"-I{ROOT}/src", "-DKONTUR_VERSION=\"0\""]
# Whole rooms where every program passes, and one file of each other room: all files take some minutes for each compiler.
ROOMS = ["base", "shape", "solve", "extract"]
FILES = ["bounds/bounds", "correct/change", "derive/rule_words", "drawing/tidy", "fit/fit", "function/kernel_sums", "image/follow_image",
         "io/bytes/json_file", "io/bytes/text_header", "io/contours/contour_json", "io/contours/markups", "io/images/nifti", "io/meshes/mesh",
         "labels/partition", "live_editor", "measure/compare", "moving/moments", "phantom/phantom", "sampling/sample_surface", "segment",
         "sureness/surface_uncertainty", "view/livewire"]
FOR_WEBASSEMBLY = {"machine_memory_of_wasm.cpp", "workers_without_threads.cpp"}
NEED_OPENBLAS_OR_OPENSSL = {"blas.cpp", "solve_cholesky.cpp", "solve_dense.cpp", "sha256.cpp"}


def required(path, name):
    """The program's path; skips where it has none."""
    if not path:
        pytest.skip(f"{name} is missing (tools/packages.txt)")
    return path


def configure_core(build, *options):
    subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DKONTUR_CORE=ON", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON",
                    *options], check=True, capture_output=True, text=True)


def headers(folder):
    """fmt's and nlohmann-json's headers and nothing else: those of a cross compiler's system must not be this one's."""
    folder.mkdir(exist_ok=True)
    for name in ("fmt", "nlohmann"):
        link = folder / name
        if not link.is_symlink():
            link.symlink_to(f"/usr/include/{name}")
    return folder


def sources():
    library = ROOT / "src/kontur"
    chosen = {path for room in ROOMS for path in (library / room).glob("*.cpp")} | {library / f"{name}.cpp" for name in FILES}
    return sorted(path for path in chosen if path.name not in NEED_OPENBLAS_OR_OPENSSL | FOR_WEBASSEMBLY)


def precompiled(compiler, folder):
    """The standard headers that most files include, read once: half of the time of all."""
    text = "\n".join(path.read_text() for path in sources())
    names = re.findall(r"^#include (<(?:[a-z_]+|fmt/format\.h)>)", text, re.MULTILINE)
    common = sorted({name for name in names if names.count(name) > 2 and not name.endswith(("unistd.h>", "dlfcn.h>"))})
    (folder / "common.h").write_text("".join(f"#include {name}\n" for name in common))
    subprocess.run([*compiler, *FLAGS, "-x", "c++-header", folder / "common.h", "-o", folder / "common.pch"], check=True)
    return ["-include-pch", folder / "common.pch"]


def expect_to_compile(compiler, folder, warnings_are_errors):
    """Syntax and types of the chosen files, of both public headers by themselves and, in a C++ file, together."""
    umbrella = folder / "headers.cpp"
    umbrella.write_text('#include "kontur/kontur.h"\n#include "kontur/stages.h"\n')
    begun = time.monotonic()
    options = [*FLAGS, *precompiled(compiler, folder), "-fsyntax-only", *(["-Werror"] if warnings_are_errors else [])]
    files = [umbrella, *sources()]
    refused = []
    for path in files:
        result = subprocess.run([*compiler, *options, path], capture_output=True, text=True)
        if result.returncode != 0:
            refused.append(result.stderr)
    print(f"{len(files)} files in {time.monotonic() - begun:.0f} s")
    assert len(files) > 80 and not refused, "\n".join(refused[:3])
