# SPDX-License-Identifier: Apache-2.0
"""Every source reaches the compiler, with its options. A file of tests that no CMakeLists.txt names is never run, and options that are
set in another folder than the target's are dropped: nothing would tell."""
import json
import os
import pathlib

import pytest

COMMANDS = pathlib.Path(os.environ["KONTUR_BUILD"], "compile_commands.json")
SOURCE = pathlib.Path(__file__).resolve().parents[2]


def commands():
    if not COMMANDS.exists():
        pytest.skip("the build folder has no compile_commands.json: configure it by a preset")
    return json.loads(COMMANDS.read_text())


@pytest.mark.parametrize("folder", ["src", "tests"])
def test_every_source_is_compiled(folder):
    compiled = {pathlib.Path(entry["file"]).resolve() for entry in commands()}
    sources = {path.resolve() for path in (SOURCE / folder).rglob("*.cpp")}
    for_wasm = {SOURCE / "src/kontur" / name
                for name in ("base/machine_memory_of_wasm.cpp", "base/workers_without_threads.cpp", "io/bytes/no_files.cpp")}
    elsewhere = for_wasm | {SOURCE / "tests/packaging/consumer/main.cpp", SOURCE / "tests/fuzz/libfuzzer_main.cpp"}
    assert sorted(sources - compiled - elsewhere) == []


def options_of(source):
    [command] = [entry["command"].split() for entry in commands()
                 if entry["file"].endswith(f"/src/kontur/{source}") and "/kontur.dir/" in entry["command"]]
    return command


@pytest.mark.parametrize("source", ["predicates", "sign_of_sum"])
def test_exact_predicates_round_each_operation(source):
    options = options_of(f"shape/{source}.cpp")
    assert [option for option in options if option.startswith("-ffp-contract")][-1] == "-ffp-contract=off"
    assert not {"-ffast-math", "-Ofast", "-funsafe-math-optimizations", "-fassociative-math"} & set(options)


@pytest.mark.parametrize("source", ["solve/h2_basis", "solve/h2_interpolation", "solve/pair_sums", "solve/preconditioner",
                                    "solve/small_cholesky", "function/kernel_sums", "function/split_kernel", "function/stencil"])
def test_fast_sums_may_fuse_multiplications_and_additions(source):
    options = options_of(f"{source}.cpp")
    # The last one counts.
    assert [option for option in options if option.startswith("-ffp-contract")][-1] == "-ffp-contract=fast"


@pytest.mark.parametrize("source", ["solve/nearest_points", "fit/fit", "function/implicit_function"])
def test_what_the_same_bytes_come_from_fuses_nothing(source):
    options = options_of(f"{source}.cpp")
    assert [option for option in options if option.startswith("-ffp-contract")][-1] == "-ffp-contract=off"


@pytest.mark.parametrize("name", ["dev", "asan", "tsan", "coverage", "fuzz", "tidy"])
def test_what_developers_build_checks_the_indices_of_vectors(name):
    """An index beyond a vector's end often does no visible harm; libstdc++'s assertions end the program there."""
    presets = {preset["name"]: preset for preset in json.loads((SOURCE / "CMakePresets.json").read_text())["configurePresets"]}

    def variables(preset):
        inherited = variables(presets[preset["inherits"]]) if "inherits" in preset else {}
        return {**inherited, **preset.get("cacheVariables", {})}

    chosen = variables(presets[name])
    assert "-D_GLIBCXX_ASSERTIONS" in chosen[f"CMAKE_CXX_FLAGS_{chosen['CMAKE_BUILD_TYPE'].upper()}"].split()
