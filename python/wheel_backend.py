# SPDX-License-Identifier: Apache-2.0
"""Builds the wheel and the sdist (PEP 517) with a C++20 compiler, CMake and what `requires` names; the sdist needs git.

The module links against the libraries of this machine, so the wheel is for machines like it. It lacks what needs a library that is
missing (wheel_parts.cmake). With --config-settings=static=FOLDER, which has static libraries of DCMTK, it stands alone, and has
other libraries in it (needs patchelf): packaging/build_wheel makes both. With --config-settings=build-dir=FOLDER a build that is
there is packed instead of a new one; relative folders count from the repository. `python3 python/wheel_backend.py FOLDER` writes the sdist into a folder.
"""
import base64
import hashlib
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parent
SOURCES = ["CMakeLists.txt", "LICENSE", "README.md", "apps/archive", "packaging", "python", "src"]
# Libraries of headers, of which an sdist has copies: Debian's package, the folder and which of it.
HEADERS = [("libfmt-dev", "fmt", "*.h"), ("nlohmann-json3-dev", "nlohmann", "**/*.hpp"), ("libcurl4-openssl-dev", "curl", "*.h")]
OF_GLIBC = re.compile(r"(libc|libm|libpthread|libdl|librt|ld-linux[-a-z0-9_]*)\.so")
# Debian's, of which a wheel that stands alone has the code.
STATIC_PACKAGES = ["libdcmtk-dev", "libopenjp2-7-dev", "libpng-dev", "zlib1g-dev", "libbz2-dev", "libfmt-dev", "libstdc++-{}-dev"]
PYTHON = f"cp{sys.version_info.major}{sys.version_info.minor}"


def _pybind11():
    """CMake finds Debian's package by itself, and Python's only by its name."""
    try:
        import pybind11
    except ImportError:
        return []
    return [f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"]


def _built_package(build, static):
    """The folder with the importable package, built if need be."""
    if not (build / "CMakeCache.txt").exists():
        kind = f"-DKONTUR_STATIC={ROOT / static}" if static else "-DKONTUR_WHEEL=ON"
        words = ["-DCMAKE_BUILD_TYPE=Release", f"-DPython_EXECUTABLE={sys.executable}", kind, *_pybind11()]
        words += ["-G", "Ninja"] if shutil.which("ninja") else []
        subprocess.run(["cmake", "-S", ROOT, "-B", build, *words], check=True)
    subprocess.run(["cmake", "--build", build, "--target", "kontur_python_stubs", "--parallel", str(os.cpu_count())], check=True)
    return build / "python" / "kontur"


def _version():
    return re.search(r"^project\(kontur VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)[1]


def _metadata(version, licences=("LICENSE", "copyright")):
    return (f"Metadata-Version: 2.1\nName: kontur\nVersion: {version}\nSummary: Smooth 3D organs from a few hand-drawn contours\n"
            "License: Apache-2.0\n" + "".join(f"License-File: {name}\n" for name in licences) +
            "Requires-Python: >=3.9\nRequires-Dist: numpy\n")


def _record_line(name, content):
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n"


def _output(*words):
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


def _bundle(module, folder):
    """The module and the libraries that it loads beside the C library's, copied into a folder to find each other in a wheel. Their names
    get digests: another package may have brought another version of them into the process."""
    copies = {module.name: folder / module.name}
    shutil.copy(module, copies[module.name])
    for name, path in re.findall(r"^\s+(\S+) => (/\S+)", _output("ldd", module), re.MULTILINE):
        if not OF_GLIBC.match(name):
            digest = hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()[:8]
            copies[name] = folder / name.replace(".so", f"-{digest}.so", 1)
            shutil.copy(path, copies[name])
    for name, path in copies.items():
        own = name == module.name
        _output("patchelf", "--set-rpath", "$ORIGIN/../kontur.libs" if own else "$ORIGIN", *([] if own else ["--set-soname", path.name]), path)
        for needed, copy in copies.items():
            _output("patchelf", "--replace-needed", needed, copy.name, path)
    return {("kontur/" if name == module.name else "kontur.libs/") + path.name: path for name, path in copies.items()}


def _platform(files):
    """manylinux_2_N (PEP 600) of files that need each other and the C library alone, of version 2.N."""
    dynamic = "".join(_output("readelf", "--wide", "--dynamic", "--version-info", path) for path in files.values())
    needed = set(re.findall(r"\(NEEDED\).*\[([^]]+)\]", dynamic)) - {path.name for path in files.values()}
    if others := [name for name in needed if not OF_GLIBC.match(name)]:
        sys.exit(f"the wheel would need {', '.join(sorted(others))}")
    return "manylinux_2_" + max(re.findall(r"Name: GLIBC_2\.(\d+)", dynamic), key=int)


def _licences(static):
    """Of kontur, and of what is compiled into the module."""
    paths = [ROOT / "LICENSE", ROOT / "packaging/copyright"]
    files = {path.name: path.read_bytes() for path in paths}
    for package in STATIC_PACKAGES if static else []:
        name = package.format(_output("c++", "-dumpversion").strip())
        files[f"copyright-{name}"] = _copyright(name).read_bytes()
    for path in [] if static else (ROOT / "third_party").glob("*/copyright"):
        files[f"copyright-{path.parent.name}"] = path.read_bytes()
    return files


def _copyright(package):
    return pathlib.Path("/usr/share/doc", package, "copyright")


def _pack(package, version, wheel, licences, bundled):
    """`bundled`: files by their names in the wheel that take the place of the package's, or come beside them."""
    machine = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    if bundled:
        machine = _platform(bundled) + machine.removeprefix("linux")
    tag = f"{PYTHON}-{PYTHON}-{machine}"
    name = f"kontur-{version}-{tag}.whl"
    information = f"kontur-{version}.dist-info"
    files = {f"kontur/{path.name}": path.read_bytes() for path in sorted(package.iterdir()) if path.is_file()}
    files |= {name: path.read_bytes() for name, path in bundled.items()}
    files[f"{information}/METADATA"] = _metadata(version, licences).encode()
    files |= {f"{information}/{name}": text for name, text in licences.items()}
    files[f"{information}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: kontur\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    record = f"{information}/RECORD"
    files[record] = ("".join(_record_line(*item) for item in files.items()) + f"{record},,\n").encode()
    with zipfile.ZipFile(wheel / name, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, content in files.items():
            entry = zipfile.ZipInfo(path)  # dated 1980: the same files give the same wheel
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, content)
    return name


def get_requires_for_build_wheel(config_settings=None):
    needed = [] if shutil.which("cmake") else ["cmake>=3.24"]
    return needed if shutil.which("ninja") or shutil.which("make") else [*needed, "ninja"]


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Called by pip; returns the wheel's file name."""
    given = config_settings or {}
    static = given.get("static")
    with tempfile.TemporaryDirectory() as temporary:
        build = ROOT / given.get("build-dir", temporary)
        package = _built_package(build, static)
        bundled = _bundle(next(package.glob("_core*.so")), pathlib.Path(temporary)) if static else {}
        return _pack(package, _version(), pathlib.Path(wheel_directory), _licences(static), bundled)


def _header_files():
    """Those of HEADERS by their names in the sdist, with their licences."""
    files = {}
    for package, library, pattern in HEADERS:
        places = [folder for folder in pathlib.Path("/usr/include").glob(f"*/{library}")] + [pathlib.Path("/usr/include", library)]
        folder = next((place for place in places if place.is_dir()), None)
        if folder is None:
            sys.exit(f"an sdist has the headers of {package}, which is not installed")
        files |= {f"third_party/{library}/{path.relative_to(folder)}": path for path in folder.glob(pattern)}
        files[f"third_party/{library}/copyright"] = _copyright(package)
    return files


def build_sdist(sdist_directory, config_settings=None):
    """What a wheel is built from, of the files that git knows; returns the file name."""
    version = _version()
    top = f"kontur-{version}"
    listed = subprocess.run(["git", "ls-files", "-z", *SOURCES], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    project = (HERE / "pyproject.toml").read_text().replace('backend-path = ["."]', 'backend-path = ["python"]')
    with tarfile.open(pathlib.Path(sdist_directory) / f"{top}.tar.gz", "w:gz") as archive:
        for path in sorted(filter(None, listed.split("\0"))):
            archive.add(ROOT / path, f"{top}/{path}", recursive=False)
        for path, header in sorted(_header_files().items()):
            archive.add(header.resolve(), f"{top}/{path}", recursive=False)
        for name, text in (("pyproject.toml", project), ("PKG-INFO", _metadata(version))):
            entry = tarfile.TarInfo(f"{top}/{name}")
            entry.size = len(text.encode())
            archive.addfile(entry, io.BytesIO(text.encode()))
    return f"{top}.tar.gz"


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python3 python/wheel_backend.py FOLDER")
    print(build_sdist(sys.argv[1]))
