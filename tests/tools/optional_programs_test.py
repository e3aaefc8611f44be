# SPDX-License-Identifier: Apache-2.0
"""A test that wants a program or module which is not there says that it is skipped, and what CTest runs stays green: each of them is
hidden in turn from the tests that ask for it. And what tests ask for is in tools/packages.txt, or known to be optional."""
import ast
import json
import os
import pathlib
import re
import shutil
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["KONTUR_BUILD"])

# Large, for tests of what the suite tests by other means, too.
OPTIONAL = {"Orthanc", "curl", "doxygen", "getscu", "lintian", "plastimatch", "storescu"}
# Where a test asks for the program that a variable names.
NAMED_BY_VARIABLES = {
    ("command_documentation_test.py", "shell"): ["zsh", "fish"],
    ("setup_test.py", "name"): [],  # every Debian has them
    ("readers_test.py", "program"): [],  # it asks for each output alone
}
PACKAGES = {"dpkg-shlibdeps": "dpkg-dev", "mypy": "mypy", "clang++-14": "clang-14", "clang++-19": "clang-19",
            "wasm-ld-19": "lld-19", "llvm-ar-19": "llvm-19", "qemu-aarch64": "qemu-user",
            "aarch64-linux-gnu-g++": "g++-aarch64-linux-gnu"}  # others are called like the package, or python3-NAME


def listed_tests():
    answer = subprocess.run(["ctest", "--show-only=json-v1"], cwd=BUILD, capture_output=True, text=True, check=True, timeout=60)
    return [test for test in json.loads(answer.stdout)["tests"] if "command" in test]


def wishes(path):
    """What a file of tests asks for: (kind, name, the test that does or None for the whole file)."""
    tree = ast.parse(path.read_text())
    for top in tree.body:
        owner = top.name if isinstance(top, ast.FunctionDef) and top.name.startswith("test_") else None
        for node in ast.walk(top):
            if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute) or not node.args:
                continue
            kind = {"which": "program", "importorskip": "module"}.get(node.func.attr)
            if kind and isinstance(node.args[0], ast.Constant):
                yield kind, node.args[0].value, owner
            elif kind:
                for name in NAMED_BY_VARIABLES[path.name, ast.unparse(node.args[0])]:
                    yield kind, name, owner


def cases():
    for test in listed_tests():
        files = [pathlib.Path(word) for word in test["command"] if word.endswith("_test.py")]
        for path in files:
            for kind, name, owner in wishes(path):
                yield pytest.param(test, path, kind, name, owner, id=f"{test['name']}-{name}")


def environment_of(test):
    properties = {entry["name"]: entry["value"] for entry in test.get("properties", [])}
    return {**os.environ, **dict(pair.split("=", 1) for pair in properties.get("ENVIRONMENT", []))}


def hide_program(name, environment, folder):
    """A PATH with links to all programs but this one."""
    for place in reversed(os.environ["PATH"].split(os.pathsep)):
        if not os.path.isdir(place):
            continue
        for program in os.scandir(place):
            link = folder / program.name
            link.unlink(missing_ok=True)
            link.symlink_to(program.path)
    (folder / name).unlink(missing_ok=True)
    environment["PATH"] = str(folder)


def hide_module(name, environment, folder):
    """A module of this name that comes first and cannot be imported."""
    (folder / f"{name}.py").write_text("raise ImportError('hidden by a test')\n")
    environment["PYTHONPATH"] = os.pathsep.join([str(folder), *filter(None, [environment.get("PYTHONPATH")])])


@pytest.mark.parametrize("test, path, kind, name, owner", cases())
def test_what_is_missing_is_said_and_fails_nothing(test, path, kind, name, owner, tmp_path):
    environment = environment_of(test)
    (hide_program if kind == "program" else hide_module)(name, environment, tmp_path)
    command = [*test["command"], *(["-k", owner] if owner else [])]
    result = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True, timeout=600)
    assert result.returncode == 0, result.stdout[-3000:] + result.stderr[-3000:]
    assert re.search(rf"^SKIPPED .*\b({re.escape(name)}|{path.name})\b", result.stdout, re.MULTILINE), result.stdout[-3000:]


@pytest.mark.parametrize("name, browser", [("web.page", "KONTUR_CHROMIUM"), ("web.firefox", "KONTUR_FIREFOX")])
def test_without_a_browser_the_pages_tests_are_skipped(name, browser, tmp_path):
    test = next(test for test in listed_tests() if test["name"].startswith(name))
    properties = {entry["name"]: entry["value"] for entry in test["properties"]}
    if "SKIP_RETURN_CODE" not in properties:
        pytest.skip("this build has no page")
    result = subprocess.run(test["command"], cwd=properties["WORKING_DIRECTORY"], capture_output=True, text=True, timeout=120,
                            env={**environment_of(test), browser: str(tmp_path / "none")})
    assert result.returncode == properties["SKIP_RETURN_CODE"] and result.stdout.startswith("skipped: ")


def test_what_is_asked_for_is_installed_by_setup():
    lines = (ROOT / "tools/packages.txt").read_text().splitlines()
    packages = {re.split(r"[=\s#]", line)[0] for line in lines} - {""}
    wanted = {name for folder in ("tests", "python/tests") for path in (ROOT / folder).rglob("*_test.py") for _, name, _ in wishes(path)}
    assert {"zsh", "mypy"} <= wanted, "the search finds what is there"
    for name in wanted - OPTIONAL - {"kontur"}:
        assert PACKAGES.get(name, name) in packages or f"python3-{name}" in packages, name


@pytest.mark.parametrize("skips, status", [(True, 0), (False, 5)])
def test_only_a_file_that_says_it_was_skipped_may_collect_nothing(skips, status, tmp_path):
    for name in ("conftest.py", "pytest.ini"):
        shutil.copy(ROOT / "tests" / name, tmp_path)
    shutil.copytree(ROOT / "tests/support", tmp_path / "support", ignore=lambda _, names: {n for n in names if n != "skips.py"})
    text = "import pytest\npytest.importorskip('no_such_module')\n" if skips else "def no_test():\n    pass\n"
    (tmp_path / "sample_test.py").write_text(text)
    result = subprocess.run(["/usr/bin/python3", "-m", "pytest", "-q", "-p", "no:cacheprovider", tmp_path / "sample_test.py"],
                            cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert result.returncode == status, result.stdout
    assert ("no_such_module" in result.stdout) == skips


def test_a_file_of_which_nothing_ran_is_skipped_for_ctest(tmp_path):
    """By the expression that this build's tests have; a file of which something ran is none."""
    [expression] = {entry["value"][0] for test in listed_tests() if test["name"].startswith("packaging.") or test["name"].startswith("cli.")
                    for entry in test["properties"] if entry["name"] == "SKIP_REGULAR_EXPRESSION"}
    for name, text in (("all", "import pytest\npytest.importorskip('no_such_module')\n"),
                       ("some", "import pytest\ndef test_a():\n    pytest.skip('no')\ndef test_b():\n    pass\n")):
        (tmp_path / f"{name}_test.py").write_text(text)
    output = {name: subprocess.run(["/usr/bin/python3", "-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider", f"{name}_test.py"],
                                   cwd=tmp_path, capture_output=True, text=True, timeout=60).stdout for name in ("all", "some")}
    assert re.search(expression, output["all"]) and not re.search(expression, output["some"]), output
