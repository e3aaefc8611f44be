# SPDX-License-Identifier: Apache-2.0
"""Builds the wheel (PEP 517) with nothing but CMake and the standard library.

The module links against the libraries of this machine's Debian, so the wheel is for machines like it. With
--config-settings=build-dir=FOLDER an existing build is packed instead of a new one.
"""
import base64
import hashlib
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

HERE = pathlib.Path(__file__).parent
PYTHON = f"cp{sys.version_info.major}{sys.version_info.minor}"


def _built_package(build):
    """The folder with the importable package, built if need be."""
    if not (build / "CMakeCache.txt").exists():
        options = ["-DCMAKE_BUILD_TYPE=Release", "-DKONTUR_BUILD_TESTS=OFF", "-DKONTUR_BUILD_BENCH=OFF", "-DKONTUR_SHARED=OFF"]
        subprocess.run(["cmake", "-S", HERE.parent, "-B", build, f"-DPython_EXECUTABLE={sys.executable}", *options], check=True)
    subprocess.run(["cmake", "--build", build, "--target", "kontur_python"], check=True)
    return build / "python" / "kontur"


def _version(build):
    return re.search(r"^CMAKE_PROJECT_VERSION:STATIC=(.+)$", (build / "CMakeCache.txt").read_text(), re.MULTILINE)[1]


def _metadata(version):
    return (f"Metadata-Version: 2.1\nName: kontur\nVersion: {version}\nSummary: Smooth 3D organs from a few hand-drawn contours\n"
            "License: Apache-2.0\nLicense-File: LICENSE\nLicense-File: copyright\nRequires-Python: >=3.9\nRequires-Dist: numpy\n")


def _record_line(name, content):
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n"


def _pack(package, version, wheel):
    tag = f"{PYTHON}-{PYTHON}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"
    name = f"kontur-{version}-{tag}.whl"
    information = f"kontur-{version}.dist-info"
    files = {f"kontur/{path.name}": path.read_bytes() for path in sorted(package.iterdir()) if path.is_file()}
    files[f"{information}/METADATA"] = _metadata(version).encode()
    # Of kontur, and of what is compiled into the module.
    for licence in (HERE.parent / "LICENSE", HERE.parent / "packaging/copyright"):
        files[f"{information}/{licence.name}"] = licence.read_bytes()
    files[f"{information}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: kontur\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    record = f"{information}/RECORD"
    files[record] = ("".join(_record_line(*item) for item in files.items()) + f"{record},,\n").encode()
    with zipfile.ZipFile(wheel / name, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, content in files.items():
            entry = zipfile.ZipInfo(path)  # dated 1980: the same files give the same wheel
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, content)
    return name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Called by pip; returns the wheel's file name."""
    given = (config_settings or {}).get("build-dir")
    with tempfile.TemporaryDirectory() as temporary:
        build = pathlib.Path(given or temporary)
        return _pack(_built_package(build), _version(build), pathlib.Path(wheel_directory))
