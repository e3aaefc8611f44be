# SPDX-License-Identifier: Apache-2.0
"""kontur-wasm, built by wasm/build where its packages are (tools/setup wasm), and its own tests in Node."""
import os
import pathlib
import shutil
import subprocess

import pytest

from core_build import ROOT, required

NODE, PAGE = os.environ["KONTUR_NODE"], pathlib.Path(os.environ["KONTUR_WEB_TESTS"])
TSC, PLAYWRIGHT = PAGE / "node_modules/.bin/tsc", PAGE / "node_modules/playwright-core/index.mjs"


def test_it_is_built_and_passes_its_own_tests():
    required(shutil.which("clang++-19"), "clang++-19")
    required(shutil.which("wasm-ld-19"), "wasm-ld-19")
    required(shutil.which("llvm-ar-19"), "llvm-ar-19")
    required(pathlib.Path("/usr/lib/wasm32-wasi/libc++.a").exists(), "libc++-19-dev-wasm32")
    if not TSC.exists():
        pytest.skip("the page's packages are missing, and with them TypeScript")
    package = pathlib.Path(os.environ["KONTUR_PORTABLE"]) / "kontur-wasm"
    subprocess.run([ROOT / "wasm/build", package], check=True, env=os.environ | {"TSC": str(TSC)})
    result = subprocess.run([NODE, "--test", ROOT / "wasm/tests/"], capture_output=True, text=True,
                            env=os.environ | {"KONTUR_WASM": str(package), "KONTUR_NATIVE": os.environ["KONTUR_WHOLE_PROGRAM"],
                                              "KONTUR_PLAYWRIGHT": str(PLAYWRIGHT), "KONTUR_CHROMIUM": "/usr/bin/chromium-headless-shell"})
    print(result.stdout)
    assert result.returncode == 0, result.stdout + result.stderr
