# SPDX-License-Identifier: Apache-2.0
"""The package as a wheel, made and installed without network."""
import os
import pathlib
import subprocess
import sys

import pytest

ROOT = os.path.join(os.path.dirname(__file__), "..")


def run(*words, **options):
    result = subprocess.run(list(map(str, words)), capture_output=True, text=True, timeout=250, **options)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def test_a_wheel_is_made_and_installed(tmp_path):
    pytest.importorskip("pip")
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check"]
    offline = ["--no-index", "--no-deps"]
    run(*pip, "wheel", ROOT, *offline, "--no-build-isolation", "-w", tmp_path,
        f"--config-settings=build-dir={os.environ['KONTUR_BUILD']}")
    [wheel] = tmp_path.glob("*.whl")
    run(*pip, "install", wheel, *offline, "--target", tmp_path / "site")
    program = "import kontur; print(kontur.__file__, kontur.__version__, kontur.phantom_case_names()[0])"
    place, version, case = run(sys.executable, "-c", program, env={"PYTHONPATH": str(tmp_path / "site")}, cwd=tmp_path).split()
    assert place.startswith(str(tmp_path / "site")) and case == "liver_orthogonal14"
    assert wheel.name.startswith(f"kontur-{version}-cp3")
    assert (tmp_path / "site" / "kontur" / "py.typed").exists()
    [information] = (tmp_path / "site").glob("kontur-*.dist-info")
    metadata = (information / "METADATA").read_text()
    for name, source in (("LICENSE", "LICENSE"), ("copyright", "packaging/copyright")):
        assert (information / name).read_bytes() == (pathlib.Path(ROOT, "..", source)).read_bytes()
        assert f"License-File: {name}\n" in metadata
