# SPDX-License-Identifier: Apache-2.0
"""Builds the wheel and the sdist (PEP 517) with nothing but CMake and the standard library; the sdist needs git.

The module links against the libraries of this machine's Debian, so the wheel is for machines like it. With
--config-settings=build-dir=FOLDER a build that is there is packed instead of a new one; a relative FOLDER counts from the
repository. `python3 python/wheel_backend.py FOLDER` writes the sdist into a folder.
"""
import base64
import hashlib
import io
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parent
SOURCES = ["CMakeLists.txt", "LICENSE", "README.md", "apps", "packaging", "python", "src"]
PYTHON = f"cp{sys.version_info.major}{sys.version_info.minor}"


def _cmake(*words):
    """Without pip's build isolation, which hides the packages of Debian's Python, NumPy among them."""
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONNOUSERSITE")}
    subprocess.run(["cmake", *words], check=True, env=environment)


def _built_package(build):
    """The folder with the importable package, built if need be."""
    if not (build / "CMakeCache.txt").exists():
        left_out = [f"-DKONTUR_{name}=OFF" for name in ("BUILD_TESTS", "BUILD_BENCH", "BUILD_PAGE", "SHARED")]
        _cmake("-S", ROOT, "-B", build, "-DCMAKE_BUILD_TYPE=Release", f"-DPython_EXECUTABLE={sys.executable}", *left_out)
    _cmake("--build", build, "--target", "kontur_python_stubs", "--parallel", str(os.cpu_count()))
    return build / "python" / "kontur"


def _version():
    return re.search(r"^project\(kontur VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)[1]


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
    for licence in (ROOT / "LICENSE", ROOT / "packaging/copyright"):
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
        build = ROOT / (given or temporary)
        return _pack(_built_package(build), _version(), pathlib.Path(wheel_directory))


def build_sdist(sdist_directory, config_settings=None):
    """What a wheel is built from, of the files that git knows; returns the file name."""
    version = _version()
    top = f"kontur-{version}"
    listed = subprocess.run(["git", "ls-files", "-z", *SOURCES], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    project = (HERE / "pyproject.toml").read_text().replace('backend-path = ["."]', 'backend-path = ["python"]')
    with tarfile.open(pathlib.Path(sdist_directory) / f"{top}.tar.gz", "w:gz") as archive:
        for path in sorted(filter(None, listed.split("\0"))):
            archive.add(ROOT / path, f"{top}/{path}", recursive=False)
        for name, text in (("pyproject.toml", project), ("PKG-INFO", _metadata(version))):
            entry = tarfile.TarInfo(f"{top}/{name}")
            entry.size = len(text.encode())
            archive.addfile(entry, io.BytesIO(text.encode()))
    return f"{top}.tar.gz"


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python3 python/wheel_backend.py FOLDER")
    print(build_sdist(sys.argv[1]))
