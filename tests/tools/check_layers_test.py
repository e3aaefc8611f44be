# SPDX-License-Identifier: Apache-2.0
"""The layer check finds what it is there to find: each case plants one include in an otherwise clean tree."""
import pathlib
import subprocess
import sys

import pytest

CHECK = pathlib.Path(__file__).parents[2] / "tools" / "check_layers"


def plant(root, file, include):
    path = root / file
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"// a source\n  #  include {include}\n")


def test_planted_import_against_the_flow_of_the_page_is_found(tmp_path):
    path = tmp_path / "apps/viewer/web/src/model/project.ts"
    path.parent.mkdir(parents=True)
    path.write_text('// a source\nimport { panel } from "../ui/panel";\nimport type { Vec3 } from "../geometry/vec";\n')
    result = check(tmp_path)
    assert result.returncode == 1
    assert result.stdout.count("project.ts:") == 1 and "model/project.ts:2: model may not include ui" in result.stdout


def check(root):
    return subprocess.run([sys.executable, CHECK, root], capture_output=True, text=True)


@pytest.mark.parametrize(
    "file, include",
    [
        ("src/kontur/base/error.h", '"kontur/shape/grid.h"'),
        ("src/kontur/base/error.cpp", "<Eigen/Dense>"),
        ("src/kontur/shape/grid.cpp", '"kontur/io/image.h"'),
        ("src/kontur/solve/solve.cpp", '"kontur/extract/voxelize.h"'),
        ("src/kontur/extract/voxelize.h", '"kontur/solve/solve.h"'),
        ("src/kontur/drawing/reduce.cpp", '"kontur/bounds/bounds.h"'),
        ("src/kontur/bounds/ends.cpp", '"kontur/fit/sides.h"'),
        ("src/kontur/io/bytes/png.cpp", '"kontur/io/images/nifti.h"'),
        ("src/kontur/io/attic/old.cpp", '"kontur/io/bytes/png.h"'),
        ("apps/viewer/model/model.cpp", '"viewer/session/session.h"'),
        ("src/kontur/solve/solve.cpp", '"kontur/bounds/bounds.h"'),
        ("src/kontur/segment_options.h", '"kontur/segment.h"'),
        ("src/kontur/view/picture.cpp", '"kontur/function/implicit_function.h"'),
        ("src/kontur/io/image.cpp", '"kontur/function/implicit_function.h"'),
        ("src/kontur/measure/compare.cpp", '"kontur/extract/trace.h"'),
        ("src/kontur/phantom/liver.cpp", '"kontur/io/image.h"'),
        ("src/kontur/segment.cpp", '"kontur/io/image.h"'),
        ("src/kontur/io/image.cpp", '"image.h"'),
        ("src/kontur/shape/grid.cpp", '"../tests/support/test_data.h"'),
        ("src/kontur/shape/grid.cpp", '"kontur/kontur.h"'),
        ("src/kontur/newroom/new.cpp", '"kontur/base/error.h"'),
        ("tests/io/image_test.cpp", '"../../apps/kontur/console.h"'),
        ("apps/kontur/main.cpp", '"../../src/kontur/base/error.h"'),
    ],
)
def test_planted_violation_is_found_at_its_line(tmp_path, file, include):
    plant(tmp_path, file, include)
    result = check(tmp_path)
    assert result.returncode == 1
    assert f"{file}:2: " in result.stdout


@pytest.mark.parametrize(
    "file, include",
    [
        ("src/kontur/base/error.h", "<string_view>"),
        ("src/kontur/io/bytes/json_file.h", "<nlohmann/json.hpp>"),
        ("src/kontur/extract/voxelize.h", '"kontur/function/implicit_function.h"'),
        ("src/kontur/segment.cpp", '"kontur/pipeline.h"'),
        ("src/kontur/view/picture.cpp", '"kontur/extract/trace.h"'),
        ("src/kontur/kontur.h", '"kontur/io/image.h"'),
        ("apps/kontur/main.cpp", '"kontur/io/image.h"'),
        ("src/kontur/io/images/nifti.cpp", '"kontur/io/bytes/png.h"'),
        ("apps/viewer/session/session.cpp", '"viewer/model/model.h"'),
        ("tests/io/image_test.cpp", '"support/test_data.h"'),
    ],
)
def test_allowed_include_passes(tmp_path, file, include):
    plant(tmp_path, file, include)
    result = check(tmp_path)
    assert result.returncode == 0, result.stdout


@pytest.mark.parametrize(
    "includer, exit_code",
    [
        ("src/kontur/io/contours/markups.cpp", 0),
        ("tests/io/json_file_test.cpp", 0),
        ("src/kontur/segment.cpp", 1),
        ("src/kontur/kontur.h", 1),
        ("apps/kontur/main.cpp", 1),
        ("python/src/module.cpp", 1),
        ("bench/solve.cpp", 1),
    ],
)
def test_header_that_brings_in_a_third_party_one_is_private_to_its_room(tmp_path, includer, exit_code):
    plant(tmp_path, "src/kontur/io/bytes/json_file.h", "<nlohmann/json.hpp>")
    plant(tmp_path, "src/kontur/io/json_numbers.h", '"kontur/io/bytes/json_file.h"')
    plant(tmp_path, includer, '"kontur/io/json_numbers.h"')
    assert check(tmp_path).returncode == exit_code
