# SPDX-License-Identifier: Apache-2.0
"""The check of declarations counts what a function takes, takes no call for one, and finds types that share a name."""
import pathlib
import subprocess
import sys

import pytest

CHECK = pathlib.Path(__file__).parents[2] / "tools" / "check_declarations"


def check(root, text, file="src/kontur/base/some.h"):
    path = root / file
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return subprocess.run([sys.executable, CHECK, root], capture_output=True, text=True)


@pytest.mark.parametrize(
    "declaration, name",
    [
        ("void six(int a, int b, int c, int d, int e, int f);", "six"),
        ("Mask six(const Mask& mask, const std::map<Id, Vec3>& places,\n   double* out, Box<3, 2> box, bool is = false, Work&& work = {}) {", "six"),
        ("auto f = [&](std::int64_t a, Vec3 b, const Vec3& c, const std::function<void(int, int)>& d, char e[], auto... f) {};", "a lambda"),
        ("double operator()(int a, int b, int c, int d, int e, const char* f) const;", "operator()"),
        ("Solver(const A& a, const B& b, const C& c, const D& d, const E& e, const Work& work) : a_(a) {}", "Solver"),
    ],
)
def test_six_parameters_are_found_at_their_line(tmp_path, declaration, name):
    result = check(tmp_path, "// a header\n" + declaration)
    assert result.returncode == 1
    assert f"src/kontur/base/some.h:2: {name} takes 6 parameters" in result.stdout


@pytest.mark.parametrize(
    "text",
    [
        "void five(int a, const std::map<int, int>& b, double c, bool d, const Work& work = {});",
        "const auto x = call(a, b, c, d, e, f, g);",
        "x = Vec6{1, 2, 3, 4, 5, 6}; call(1, 2, 3, 4, 5, 6); call(a * b, c, d, e, f, g);",
        "// void six(int a, int b, int c, int d, int e, int f);",
        'throw Error("six(int a, int b, int c, int d, int e, int f)");',
    ],
)
def test_five_parameters_and_calls_of_six_are_not(tmp_path, text):
    assert check(tmp_path, text).returncode == 0, text


def test_bindings_have_the_parameters_of_python(tmp_path):
    six = "void six(int a, int b, int c, int d, int e, int f);"
    assert check(tmp_path, six, "python/src/some.cpp").returncode == 0
    assert check(tmp_path, six, "apps/kontur/some.cpp").returncode == 1


def check_headers(root, first, second):
    check(root, first, "src/kontur/view/first.h")
    return check(root, second, "src/kontur/sureness/second.h")


def test_two_types_of_one_name_are_found(tmp_path):
    result = check_headers(tmp_path, "namespace kontur {\nstruct Slice { int a; };\n}", "namespace kontur {\n\nclass Slice final : public Plane {\n};\n}")
    assert result.returncode == 1
    assert "kontur::Slice is declared at src/kontur/sureness/second.h:3, too" in result.stdout


@pytest.mark.parametrize(
    "second",
    [
        "namespace kontur {\nstruct Slice;\nvoid f(struct Slice& s) {}\n}",
        "namespace kontur::picture {\nstruct Slice {};\n}",
        "namespace kontur {\nclass Other {\n    struct Slice {};\n};\n}",
        "namespace kontur {\nstruct Slices {};\ntemplate <class Slice> void g() {}\n}",
    ],
)
def test_types_elsewhere_may_have_the_name(tmp_path, second):
    assert check_headers(tmp_path, "namespace kontur {\nstruct Slice { int a; };\n}", second).returncode == 0


def test_two_constants_of_one_name_are_found(tmp_path):
    both = "namespace kontur {\ninline constexpr double kFirst = 1, kSlope = 0.3;\n}", "namespace kontur {\ninline constexpr double kSlope = 1e-3;\n}"
    result = check_headers(tmp_path, *both)
    assert result.returncode == 1
    assert "kontur::kSlope is declared at src/kontur/sureness/second.h:2, too" in result.stdout
    assert check_headers(tmp_path, both[0], both[1].replace("kSlope", "kOther")).returncode == 0
