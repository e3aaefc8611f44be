# SPDX-License-Identifier: Apache-2.0
"""The public face stays small: headers and types of kontur.h, what it reaches, and who includes it."""
import pathlib
import re

ROOT = pathlib.Path(__file__).parents[2]
SOURCES = ROOT / "src"
INCLUDE = re.compile(r'^ *# *include +"(kontur/[^"]+)"', re.MULTILINE)
TYPE = re.compile(r"^(?:enum class|struct|class) (\w+)[^;{]*\{", re.MULTILINE)


def includes(header):
    return INCLUDE.findall((SOURCES / header).read_text(encoding="utf-8"))


def types(headers):
    return [name for header in headers for name in TYPE.findall((SOURCES / header).read_text(encoding="utf-8"))]


def reach(*umbrellas):
    """All headers that these include, directly or not, without themselves."""
    found, waiting = set(), list(umbrellas)
    while waiting:
        for header in includes(waiting.pop()):
            if header not in found:
                found.add(header)
                waiting.append(header)
    return sorted(found)


def test_the_stable_face_is_about_40_headers_and_70_types():
    headers = includes("kontur/kontur.h")
    assert len(headers) <= 42, headers
    assert len(types(headers)) <= 89, types(headers)


def test_it_needs_few_headers_more():
    assert len(reach("kontur/kontur.h")) <= 80
    assert len(types(reach("kontur/kontur.h"))) <= 149


def test_stages_are_no_part_of_it():
    stages = set(includes("kontur/stages.h"))
    assert "kontur/fit/fit.h" in stages
    # What the report and the options name stands in both: corners and crossings, and the residual.
    assert stages & set(reach("kontur/kontur.h")) == {
        "kontur/drawing/corners.h", "kontur/shape/crossings.h", "kontur/fit/residual.h"}
    assert "UNSTABLE" in (SOURCES / "kontur/stages.h").read_text()


def test_hashes_trees_predicates_counters_and_samplers_are_private():
    private = re.compile(r"sha256|_tree|predicates|counted|components|sample_surface|lattice|moving_point|point_tree")
    assert [header for header in reach("kontur/kontur.h") if private.search(header)] == []


def test_only_users_include_the_face():
    for folder in ("src", "apps", "python", "bench"):
        for path in [*(ROOT / folder).rglob("*.h"), *(ROOT / folder).rglob("*.cpp")]:
            used = {"kontur/kontur.h", "kontur/stages.h"} & set(INCLUDE.findall(path.read_text(encoding="utf-8")))
            assert not used, f"{path.relative_to(ROOT)} includes {used} instead of what it uses"
