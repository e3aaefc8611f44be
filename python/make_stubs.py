# SPDX-License-Identifier: Apache-2.0
"""Writes the type stubs of kontur, __init__.pyi, stages.pyi and archive.pyi, from the module's own docstrings.

Signatures are those that inspect reads; types are the words of the docstrings' sections "Parameters" and "Returns", and those
before the colon of an attribute. A word that is not known stops the program with the place where it stands.

Usage: make_stubs.py OUTPUT_FOLDER, with the package on PYTHONPATH.
"""
import inspect
import pathlib
import re
import sys

del sys.path[0]  # beside this program the package lies without its module
import kontur

HEAD = """# SPDX-License-Identifier: Apache-2.0
# Made by make_stubs.py from the docstrings of the module.
import os
import pathlib
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Literal, Protocol, Union, overload

import numpy
from numpy.typing import ArrayLike, NDArray
"""

PLAIN = {"int": "int", "float": "float", "str": "str", "bool": "bool", "bytes": "bytes", "dict": "dict[str, Any]", "None": "None",
         "path": "_Path", "paths": "_Path", "pathlib.Path": "pathlib.Path", "callable": "Callable[..., Any]",
         "object with is_set()": "_Stop", "module": "Any", "structure": "int | str",
         "relation": "Literal['exclusive', 'inside', 'overlap']"}
# Parameters that mean the same everywhere, for docstrings of one sentence; others may say more of them.
COMMON = {"a": "Grid", "b": "Grid", "body": "Body", "contour": "Contour", "contours": "ContourSet", "crossings": "sequence of Crossing",
          "folder": "path", "frame": "{'LPS', 'RAS'}", "grid": "Grid", "image": "Image, optional", "label": "float", "max_labels": "int",
          "max_voxels": "int", "mesh": "TriangleMesh", "name": "str", "name_or_number": "str or int, optional", "object": "int",
          "path": "path", "pixel": "(int, int)", "pixels": "array_like", "plane": "Plane", "points": "array_like",
          "provenance": "dict of str to str, optional", "structures": "StructureSet", "threads": "int", "uv": "array_like",
          "contour_count": "int", "least_segments": "int", "progress": "callable of (str, float), optional",
          "stop": "object with is_set(), optional", "on_note": "callable of str, optional"}

# What functions with docstrings of one sentence return.
RESULTS = {
    "Body.outward_normals": "ndarray", "Body.values": "ndarray", "Editor.finish": "EditedSurface", "Editor.preview": "EditedSurface",
    "EdgeMap.subpixel_position": "(float, float)", "Grid.affine": "ndarray", "LiveEditor.close": "None", "LiveEditor.edit": "int",
    "LiveEditor.wait": "None", "Plane.distance_to": "ndarray", "Plane.from_uv": "ndarray", "Plane.to_uv": "ndarray",
    "check_contours": "None", "check_contours_inside": "str or None", "corner_distance_mm": "float", "count_labels": "dict of int to int",
    "crossings": "ndarray", "dense_liver_case": "PhantomCase", "disagreement": "Disagreement",
    "disagreement_by_contour": "list of Disagreement", "encode_png": "bytes", "fill": "Mask", "find_crossings": "list of Crossing",
    "fit_plane": "Plane or None", "is_dicom_seg": "bool", "is_moving": "bool", "is_rtstruct": "bool", "list_dicom_series": "list of DicomSeries",
    "looks_like_dicom": "bool", "make_truth_mask": "Mask", "orient": "ContourOrientation", "phantom_bodies": "list of Body",
    "phantom_case": "PhantomCase", "phantom_case_names": "list of str", "phantom_volumes": "list of PhantomVolume", "points_outside": "int",
    "read_dicom_segmentation": "DicomSegmentation", "read_mesh": "TriangleMesh", "read_rtstruct": "StructureSet", "select_label": "Mask",
    "select_nonzero": "Mask", "select_roi": "Roi", "signed_volume_mm3": "float", "subdivide": "Contour", "suggest_window": "(float, float)",
    "surface_of": "TriangleMesh", "topology": "MeshTopology", "without_duplicate_points": "ContourSet",
}
# What sentences say in other words than types.
ATTRIBUTES = {"Comparison.surface": "SurfaceDistance or None", "ContourSet.smallest_ball": "(ndarray, float)",
              "EditorUpdate.surface": "EditedSurface or None", "Finding.contour": "int or None", "Finding.other": "int or None",
              "Segmentation.mesh": "TriangleMesh or None"}
PARAMETERS = {"fill": {"surface": "SurfaceLattice"}, "surface_of": {"surface": "SharedSurface"}}

FOREIGN = ("nibabel.", "SimpleITK.", "numpy.ndarray of the same type")
NUMBERS = re.compile(r"\b(u?int(?:8|16|32|64)|float(?:32|64))\b")

# Members whose signatures Python's own protocols give.
PROTOCOLS = {
    "__add__": "(self, mm: float, /) -> Mask",
    "__and__": "(self, other: Mask, /) -> Mask",
    "__array__": "(self, dtype: Any = None) -> NDArray[Any]",
    "__contains__": "(self, value: object) -> bool",
    "__enter__": "(self) -> {type}",
    "__eq__": "(self, other: object) -> bool",
    "__exit__": "(self, *args: object) -> None",
    "__hash__": "(self) -> int",
    "__iter__": "(self) -> Iterator[Contour]",
    "__len__": "(self) -> int",
    "__or__": "(self, other: Mask, /) -> Mask",
    "__sub__": "(self, other: Mask | float, /) -> Mask",
}

# What the result is depends on an argument: the parameters that differ, and the result.
OVERLOADS = {
    "segment": [({"mesh": "Literal[True]"}, "_SegmentationWithMesh"), ({}, "Segmentation")],
    "fill_labels": [
        ({"labels": "Image", "spacing": "None = None", "return_report": "Literal[False] = False"}, "Image"),
        ({"labels": "Image", "spacing": "None = None", "return_report": "Literal[True]"}, "tuple[Image, FillReport]"),
        ({"labels": "ArrayLike", "spacing": "Sequence[float]", "return_report": "Literal[False] = False"}, "NDArray[Any]"),
        ({"labels": "ArrayLike", "spacing": "Sequence[float]", "return_report": "Literal[True]"}, "tuple[NDArray[Any], FillReport]"),
    ],
    "__getitem__": [({"index": "int"}, "Contour"), ({"index": "slice"}, "ContourSet")],
}

PRIVATE = """
_Path = Union[str, "os.PathLike[str]"]

class _Stop(Protocol):
    def is_set(self) -> bool: ...

__version__: str

class _SegmentationWithMesh(Segmentation):
    @property
    def mesh(self) -> TriangleMesh: ...
"""


def split(text, separator):
    """At the separators that stand outside of brackets."""
    parts, depth, last = [], 0, 0
    for n, letter in enumerate(text):
        depth += (letter in "({[") - (letter in ")}]")
        if depth == 0 and text.startswith(separator, n) and n >= last:
            parts.append(text[last:n])
            last = n + len(separator)
    return [part.strip().rstrip(",") for part in [*parts, text[last:]]]


def array_type(words):
    """Of results: "ndarray, shape (n, 3), uint32"; what no words name is float64, "of any type" is that."""
    if "any type" in words:
        return "NDArray[Any]"
    number = NUMBERS.search(words)
    return f"NDArray[numpy.{number[1] if number else 'float64'}]"


def python_type(words):
    """Type of a docstring's words: "sequence of Plane", "(int, int), optional" without its last word."""
    words = re.sub(r", shape \([^)]*\)( or \([^)]*\))*", "", words.strip())
    alternatives = split(words, " or ")
    if len(alternatives) > 1:
        return " | ".join(dict.fromkeys(python_type(each) for each in alternatives))
    for start in FOREIGN:
        if words.startswith(start):
            return "Any"
    if words.startswith("array_like"):
        return "ArrayLike"
    if words.startswith("ndarray"):
        return array_type(words)
    if words.startswith("{"):
        return f"Literal[{words[1:-1]}]"
    if words.startswith("(") and words.endswith(")"):
        return f"tuple[{', '.join(python_type(each) for each in split(words[1:-1], ','))}]"
    for start, form in (("sequence of ", "Sequence[{}]"), ("list of ", "list[{}]"), ("tuple of ", "tuple[{}, ...]")):
        if words.startswith(start):
            return form.format(python_type(re.sub(r"^\d+ ", "", words[len(start):])))
    if words.startswith("dict of "):
        return f"dict[{', '.join(python_type(each) for each in words[8:].split(' to '))}]"
    if words.startswith("callable of "):
        taken = words[len("callable of "):].strip("()").split(", ")
        return f"Callable[[{', '.join(python_type(each) for each in taken)}], object]"
    if words in PLAIN:
        return PLAIN[words]
    if any(words in module.__all__ for module in (kontur, kontur.stages, kontur.archive)):
        return words
    raise ValueError(f"'{words}' names no type")


def section(text, name):
    found = re.search(rf"^{name}\n-+\n(.*?)(?=^\S[^\n]*\n---|\Z)", text, re.DOTALL | re.MULTILINE)
    return found[1] if found else ""


def parameter_types(text):
    """Of the lines "name, name : words" of a docstring."""
    types = dict(COMMON)
    for line in section(text, "Parameters").splitlines():
        if line[:1].strip() == "":
            continue
        names, _, words = line.partition(" : ")
        words = re.sub(r", default .*$", "", words)
        for name in (each.strip() for each in names.split(",")):
            if words and name not in ("progress", "stop", "on_note"):
                types[name] = words
    return types


def default_text(value):
    """As a stub writes it: a literal, or three dots."""
    return repr(value) if value is None or isinstance(value, (bool, int, float, str)) or value == () else "..."


def parameter(its, words, changes):
    if its.name in changes:
        return f"{its.name}: {changes[its.name]}"
    text = its.name
    if its.kind is its.VAR_POSITIONAL:
        text = "*" + text
    if words is None:
        return text
    optional = words.endswith(", optional")
    kind = python_type(words.removesuffix(", optional").removesuffix("optional"))
    if optional and its.default is None and not kind.endswith("None"):
        kind += " | None"
    text += f": {kind}"
    return text if its.default is its.empty else f"{text} = {default_text(its.default)}"


def function(name, value, types, result, changes=None):
    """One line of a stub. `types` are words by parameter."""
    texts, star = [], False
    for its in inspect.signature(value).parameters.values():
        if its.kind is its.KEYWORD_ONLY and not star:
            texts.append("*")
            star = True
        if its.name != "self" and its.name not in types and its.name not in (changes or {}):
            raise ValueError(f"{name}: the docstring does not say what '{its.name}' is")
        texts.append(parameter(its, types.get(its.name), changes or {}))
    return f"def {name}({', '.join(texts)}) -> {result}: ..."


def overloads(name, value, types):
    for changes, result in OVERLOADS[name]:
        yield "@overload"
        yield function(name, value, types, result, changes)


def result_type(name, text):
    """Writers return nothing; others say in their section "Returns" or in RESULTS what they return."""
    returned = section(text, "Returns").splitlines()
    if returned:
        return python_type(returned[0])
    if name in RESULTS:
        return python_type(RESULTS[name])
    if name.startswith("write_"):
        return "None"
    raise ValueError(f"{name}: neither the docstring nor RESULTS says what it returns")


def function_lines(name, value, owner="", shared_types=None):
    """`owner` is the class of a method, `shared_types` what its docstring says of parameters."""
    text = inspect.getdoc(value) or ""
    types = {**(shared_types or {}), **parameter_types(text), **PARAMETERS.get(name, {})}
    if name in OVERLOADS:
        yield from overloads(name, value, types)
    else:
        yield function(name, value, types, result_type(f"{owner}.{name}" if owner else name, text))


def attribute_type(owner, name, value):
    words = ATTRIBUTES.get(f"{owner}.{name}") or re.split(r": |\.$|\n", inspect.getdoc(value) or "")[0]
    words = re.sub(r" \((?:red|[a-z ]+:).*?\)", "", words)
    try:
        return python_type(words)
    except ValueError as error:
        raise ValueError(f"{owner}.{name}: {error}") from error


def class_lines(name, kind):
    bases = [base.__name__ for base in kind.__bases__ if base.__name__ not in ("object", "pybind11_object")]
    lines = [f"class {name}({', '.join(bases)}):" if bases else f"class {name}:"]
    types = parameter_types(inspect.getdoc(kind) or "")
    # After an attribute that is called property, the decorator cannot be named.
    for member, value in sorted(vars(kind).items(), key=lambda each: each[0] == "property"):
        if member == "__init__":
            if "args" not in inspect.signature(value).parameters:  # else only the library makes it
                lines += indented([function(member, value, types, "None")])
        elif member in PROTOCOLS:
            if value is not None:
                lines += indented([f"def {member}{PROTOCOLS[member].format(type=name)}: ..."])
        elif member == "__getitem__":
            lines += indented(["@overload", "def __getitem__(self, index: int) -> Contour: ...", "@overload",
                               "def __getitem__(self, index: slice) -> ContourSet: ..."])
        elif member == "__call__":
            time = "time: float, " if "time" in inspect.signature(value).parameters else ""
            lines += indented([f"def __call__(self, points: ArrayLike, {time}threads: int = 0) -> NDArray[numpy.float64]: ..."])
        elif member.startswith("_"):
            continue
        elif isinstance(value, property):
            lines += indented(["@property", f"def {member}(self) -> {attribute_type(name, member, value)}: ..."])
        elif isinstance(value, staticmethod):
            lines += indented(["@staticmethod", *function_lines(member, value.__func__, name, types)])
        elif callable(value):
            lines += indented(function_lines(member, value, name, types))
        else:
            lines += indented([f"{member}: {type(value).__name__}"])
    return lines if len(lines) > 1 else [lines[0] + " ..."]


def indented(lines):
    return ["    " + line for line in lines]


def stub_lines(module):
    for name in sorted(module.__all__, key=lambda each: (not isinstance(getattr(module, each), type), each)):
        value = getattr(module, name)
        yield ""
        try:
            yield from class_lines(name, value) if isinstance(value, type) else function_lines(name, value)
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from error


def write(path, text):
    """In place of a link that an earlier build may have left there."""
    path.unlink(missing_ok=True)
    path.write_text(text)


def main(folder):
    whole = "\n".join([HEAD, "from . import archive as archive, stages as stages", PRIVATE, *stub_lines(kontur)]) + "\n"
    write(folder / "__init__.pyi", whole)
    names = [name for name in sorted(kontur.__all__) if isinstance(getattr(kontur, name), type)]
    imports = "from . import " + ", ".join([*names, "_Path", "_Stop"])
    for name, module in (("stages", kontur.stages), ("archive", kontur.archive)):
        write(folder / f"{name}.pyi", "\n".join([HEAD, imports, *stub_lines(module)]) + "\n")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
