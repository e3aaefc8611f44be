# SPDX-License-Identifier: Apache-2.0
"""The core for 64-bit Arm, by a cross compiler and in an emulator, beside this machine's. KONTUR_AARCH64=1 runs it: it compiles for
ten minutes."""
import json
import os
import pathlib
import re
import shutil
import subprocess

import numpy
import pytest

from core_build import configure_core, headers, required

CASES = ["metastasis_parallel7"]
PORTABLE = pathlib.Path(os.environ["KONTUR_PORTABLE"])


def needed_sources(build):
    """Of the core's sources those that the program needs, as the linker of this machine's found: half of them."""
    members = set(re.findall(r"libkontur\.a\(([a-z0-9_]+\.cpp)\.o\)", pathlib.Path(os.environ["KONTUR_CORE_MAP"]).read_text()))
    stand_ins = {"fmt_definitions.cpp", "no_compression.cpp", "sha256_without_openssl.cpp", "solvers_without_openblas.cpp"}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        output = re.search(r" -o (\S+)", entry["command"])[1]
        is_for_a_level = "kontur_level_" in output  # the same sources again, for other instruction sets of this machine
        if pathlib.Path(entry["file"]).name in members | stand_ins and not is_for_a_level:
            yield output


def cross_built():
    """Kept in the build folder, so that a second run builds what changed."""
    compiler, build = "aarch64-linux-gnu-g++", PORTABLE / "aarch64"
    include = headers(PORTABLE / "headers")
    configure_core(build, "-DCMAKE_SYSTEM_NAME=Linux", "-DCMAKE_SYSTEM_PROCESSOR=aarch64", f"-DCMAKE_CXX_COMPILER={compiler}",
                   "-DCMAKE_C_COMPILER=aarch64-linux-gnu-gcc", f"-DFMT_INCLUDE_DIR={include}", f"-DJSON_INCLUDE_DIR={include}",
                   "-DCMAKE_BUILD_TYPE=None", "-DCMAKE_CXX_FLAGS=-O1")
    objects = sorted(set(needed_sources(build)))
    subprocess.run(["ninja", "-C", build, "-j2", *objects], check=True)
    source = pathlib.Path(__file__).with_name("program.cpp")
    subprocess.run([compiler, "-std=c++20", "-O1", f"-I{source.parents[2]}/src", source, *objects, "-static", "-o", "program"], cwd=build, check=True)
    return build / "program"


def run(folder, *command):
    folder.mkdir()
    subprocess.run([*command, folder, *CASES], check=True)
    return folder


def voxels(folder, case):
    return numpy.frombuffer((folder / f"{case}.nii").read_bytes()[352:], numpy.uint8)


def points(folder, case):
    planes = json.loads((folder / f"{case}.json").read_text())["planes"]
    return numpy.concatenate([contour["points"] for plane in planes for contour in plane["contours"]])


def test_masks_are_this_machines_but_for_single_voxels(tmp_path):
    if "KONTUR_AARCH64" not in os.environ:
        pytest.skip("KONTUR_AARCH64 is not set")
    required(shutil.which("aarch64-linux-gnu-g++"), "aarch64-linux-gnu-g++")
    emulator = required(shutil.which("qemu-aarch64"), "qemu-aarch64")
    arm = run(tmp_path / "arm", emulator, cross_built())
    own = run(tmp_path / "own", os.environ["KONTUR_CORE_PROGRAM"])
    for case in CASES:
        assert numpy.abs(points(arm, case) - points(own, case)).max() < 1e-12  # mm: the last digit of a sine
        there, here = voxels(arm, case), voxels(own, case)
        assert there.size == here.size and here.sum() > 1000
        differences = int((there != here).sum())
        print(f"{case}: {differences} of {int(here.sum())} voxels differ")
        # Sums are rounded in another order; a voxel's centre that lies on the surface to 13 digits may fall on either side.
        assert differences <= 1e-4 * here.sum()
