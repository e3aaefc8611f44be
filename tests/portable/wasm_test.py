# SPDX-License-Identifier: Apache-2.0
"""kontur-wasm, built by wasm/build where its packages are (tools/setup wasm), and its own tests in Node and Chromium."""
import os
import pathlib
import shutil
import subprocess

import pytest

from core_build import ROOT, required

NODE, NPM, PAGE = os.environ["KONTUR_NODE"], os.environ["KONTUR_NPM"], pathlib.Path(os.environ["KONTUR_WEB_TESTS"])
PORTABLE = pathlib.Path(os.environ["KONTUR_PORTABLE"])
TSC, PLAYWRIGHT = PAGE / "node_modules/.bin/tsc", PAGE / "node_modules/playwright-core/index.mjs"
TESTS = ROOT / "wasm/tests"


@pytest.fixture(scope="module")
def package():
    required(shutil.which("clang++-19"), "clang++-19")
    required(shutil.which("wasm-ld-19"), "wasm-ld-19")
    required(shutil.which("llvm-ar-19"), "llvm-ar-19")
    required(pathlib.Path("/usr/lib/wasm32-wasi/libc++.a").exists(), "libc++-19-dev-wasm32")
    if not TSC.exists():
        pytest.skip("the page's packages are missing, and with them TypeScript")
    subprocess.run([ROOT / "wasm/build", PORTABLE / "kontur-wasm"], check=True, env=os.environ | {"TSC": str(TSC)})
    return PORTABLE / "kontur-wasm"


@pytest.fixture(scope="module")
def peers():
    """niivue and Cornerstone3D, pinned by the lock beside the tests that want them."""
    folder, lock = PORTABLE / "peers", (TESTS / "package-lock.json").read_bytes()
    installed = folder / "node_modules/.kontur-lock"
    if not installed.exists() or installed.read_bytes() != lock:
        folder.mkdir(parents=True, exist_ok=True)
        for name in ("package.json", "package-lock.json"):
            shutil.copy(TESTS / name, folder)
        result = subprocess.run([NPM, "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error"], cwd=folder, capture_output=True,
                                text=True)
        if result.returncode != 0:
            pytest.skip(f"npm ci failed, and with it niivue and Cornerstone3D are missing: {result.stderr[-300:]}")
        installed.write_bytes(lock)
    return folder


def passes(tests, package, **environment):
    known = {"KONTUR_WASM": str(package), "KONTUR_NATIVE": os.environ["KONTUR_WHOLE_PROGRAM"], "KONTUR_PLAYWRIGHT": str(PLAYWRIGHT),
             "KONTUR_CHROMIUM": "/usr/bin/chromium-headless-shell", "KONTUR_ESBUILD": str(PAGE / "node_modules/.bin/esbuild")}
    result = subprocess.run([NODE, "--test", *(TESTS / f"{name}.test.mjs" for name in tests)], capture_output=True, text=True,
                            env=os.environ | known | environment)
    print(result.stdout)
    assert result.returncode == 0, result.stdout + result.stderr


def test_it_is_built_and_passes_its_own_tests(package):
    passes(["adapters", "kontur", "page"], package)


def test_it_works_in_niivue_and_in_cornerstone3d(package, peers):
    passes(["niivue", "cornerstone"], package, KONTUR_PEERS=str(peers))


def test_its_types_are_those_of_niivue_and_cornerstone3d(package, peers):
    link = peers / "node_modules/kontur-wasm"
    link.unlink(missing_ok=True)
    link.symlink_to(package)
    shutil.copy(TESTS / "types.ts", peers)
    options = ["--noEmit", "--strict", "--skipLibCheck", "--target", "ES2022", "--module", "ES2022", "--moduleResolution", "bundler"]
    result = subprocess.run([TSC, *options, "types.ts"], cwd=peers, capture_output=True, text=True)
    ours = [line for line in result.stdout.splitlines() if not line.startswith(("node_modules/", " "))]
    assert not ours, "\n".join(ours)
