# SPDX-License-Identifier: Apache-2.0
"""make_seeds.py TARGET FOLDER: writes small sound inputs of a fuzz target, for a fuzzer to start from. TARGET may be "all": then each
target gets a folder of its own."""
import bz2
import gzip
import json
import pathlib
import random
import sys
import tempfile
import zlib

import nibabel
import pydicom

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "malformed"))
import malformed_files as sound  # noqa: E402


def nifti():
    yield from (sound.nifti_bytes(version, (3, 2, 2), dtype) for version in (1, 2) for dtype in ("u1", "i2", "f4"))
    yield gzip.compress(sound.nifti_bytes(1, (3, 2, 2)), mtime=0)
    image = nibabel.Nifti1Image.from_bytes(sound.nifti_bytes(1, (3, 2, 2)))
    image.header.extensions.append(nibabel.nifti1.Nifti1Extension("comment", b"kontur\nmade_by: hand\noptions: a=b c\n"))
    yield image.to_bytes()


def nrrd():
    voxels = sound.VOXELS
    yield sound.nrrd_text()
    yield sound.nrrd_text(gzip.compress(voxels, mtime=0), encoding="gzip")
    yield sound.nrrd_text(bz2.compress(voxels), encoding="bzip2")
    yield sound.nrrd_text(b"1 2 3 4 5 6 7 8", encoding="ascii", sizes="2 2 2")
    yield sound.nrrd_text(dimension="4", sizes="2 2 2 2", space_directions="none (1,0,0) (0,1,0) (0,0,2)", kinds=None)
    yield sound.nrrd_text(type="short", endian="big", sizes="5 4 3", byte_skip="-1", space="RAS")


def metaimage():
    packed = zlib.compress(sound.VOXELS)
    yield sound.metaimage_text()
    yield sound.metaimage_text(packed, CompressedData="True", CompressedDataSize=len(packed))
    yield sound.metaimage_text(b"1 2 3 4 5 6 7 8", BinaryData="False", DimSize="2 2 2")
    yield sound.metaimage_text(ElementNumberOfChannels="2", DimSize="5 4 3", HeaderSize="-1")


def by_support(script, *words):
    """What a script of the tests writes, file by file."""
    with tempfile.TemporaryDirectory() as name:
        sound.support(script, *words, name)
        yield from ((path.name, path.read_bytes()) for path in sorted(pathlib.Path(name).iterdir()) if path.is_file())


def nifti_pair():
    files = dict(by_support("image_oracle.py", "make-pairs"))
    for stem in ("axial_1", "oblique_2"):
        yield files[stem + ".hdr"] + files[stem + ".img"]


def mgh():
    yield from (content for name, content in by_support("image_oracle.py", "make-mgh") if name.endswith((".mgh", ".mgz")))


def gipl():
    yield from (content for name, content in by_support("image_oracle.py", "make-gipl") if name.endswith((".gipl", ".gz")))


def vtk():
    yield from (content for name, content in by_support("make_vtk.py") if name.endswith(".vtk"))


def vtp():
    yield from (content for name, content in by_support("make_vtk.py") if name.endswith(".vtp"))


def dicom():
    with tempfile.TemporaryDirectory() as name:
        for case in ("plain", "rle", "deflated", "implicit", "big_endian", "enhanced", "enhanced_slopes", "enhanced_rle"):
            folder = pathlib.Path(name) / case
            sound.support("make_dicom_series.py", case, folder)
            yield min((folder / "dicom").iterdir()).read_bytes()


def that_says_how_it_was_made(path):
    document = pydicom.dcmread(path)
    equipment = pydicom.Dataset()
    equipment.Manufacturer, equipment.ContributionDescription = "kontur", "made_by: kontur convert; options: a; b; input_sha256: 0123"
    document.ContributingEquipmentSequence = [equipment]
    document.save_as(path)
    return path.read_bytes()


def dicom_seg():
    with tempfile.TemporaryDirectory() as name:
        for case in ("shuffled", "overlapping", "fractional"):
            sound.support("make_dicom_seg.py", case, f"{name}/a.dcm", f"{name}/truth")
            yield pathlib.Path(name, "a.dcm").read_bytes()
        yield that_says_how_it_was_made(pathlib.Path(name, "a.dcm"))


def rtstruct():
    with tempfile.TemporaryDirectory() as name:
        sound.support("make_rtstruct.py", "good", f"{name}/a.dcm")
        yield pathlib.Path(name, "a.dcm").read_bytes()
        yield that_says_how_it_was_made(pathlib.Path(name, "a.dcm"))


def contour_json():
    document = sound.contour_document()
    yield json.dumps(document).encode()
    document["interior"], document["exterior"] = [[0, 0, 0]], [[30, 0, 0]]
    document["surface"] = [[0, 10, 0], {"point": [0, -10, 0], "outward": [0, -1, 0]}]
    document["planes"][0]["contours"][0].update(closed=False, inside="left")
    document["planes"][2]["contours"][0].update(end="round")
    yield json.dumps(document).encode()


def markups():
    yield json.dumps(sound.markups_document()).encode()


def stl():
    yield sound.stl_bytes()


def ply():
    yield sound.PLY
    header = sound.PLY[: sound.PLY.index(b"end_header\n") + 11].replace(b"ascii", b"binary_little_endian")
    yield header + bytes(48) + (b"\3" + bytes(12)) * 4
    yield header.replace(b"little", b"big") + bytes(48) + (b"\3" + bytes(12)) * 4


def obj():
    yield sound.OBJ
    yield sound.OBJ + b"vn 0 0 1\nf 1//1 2//1 3//1 4//1\nf -1 -2 -3\n# SPACE=RAS\n"


def csv():
    yield b'contours,spacing-mm,output\nball.json,2,o.nii\n"a ""b"" c",3,"x\ny"\r\n'


def pipeline():
    for seed in range(40):
        yield random.Random(seed).randbytes(200 + 20 * seed)


def fitting():
    for seed in range(100, 140):
        yield random.Random(seed).randbytes(200 + 20 * seed)


def messages():
    plane = {"origin": [5, 5, 5], "u": [1, 0, 0], "v": [0, 1, 0], "normal": [0, 0, 1], "mm_per_pixel": 0.5}
    square = [[2, 2, 5], [9, 2, 5], [9, 9, 5], [2, 9, 5]]
    lines = [{"call": "structure.add", "name": "liver", "color": "#ff0000"}]
    for kind in ("line", "spline", "wire", "free"):
        control = [{"at": at, "kind": kind, "path": [at]} for at in square]
        lines += [{"call": "path", "plane": plane, "control": control, "closed": True},
                  {"call": "contour.add", "structure": 1, "plane": plane, "control": control}]
    lines += [{"call": "contour.move_point", "id": 2, "index": 0, "to": [1, 1, 5]}, {"call": "contour.insert_point", "id": 2, "at": [5, 2, 5]},
              {"call": "contour.delete_point", "id": 2, "index": 1}, {"call": "contour.pull", "id": 2, "from": [2, 2, 5], "to": [3, 3, 5]},
              {"call": "contour.redraw", "id": 2, "path": [[2, 2, 5], [5, 1, 5], [9, 2, 5]]}, {"call": "undo"}, {"call": "redo"},
              {"call": "value", "at": [5, 5, 5]}, {"call": "page.save", "page": {"x": 1}}, {"call": "contour.translate", "id": 2, "by": [1, 0, 0]},
              {"call": "contour.copy", "id": 2, "offset_mm": 2}, {"call": "contour.set", "id": 2, "hole": True}]
    text = [json.dumps({"seq": n, **line}) for n, line in enumerate(lines)]
    yield "\n".join(text).encode()
    for line in text[1:]:
        yield "\n".join([text[0], text[2], line]).encode()


def project():
    structure = {"id": 1, "name": "liver", "color": "#ff0000", "visible": True}
    square = [[2, 2, 5], [9, 2, 5], [9, 9, 5], [2, 9, 5]]
    plane = {"origin": [5, 5, 5], "u": [1, 0, 0], "v": [0, 1, 0], "normal": [0, 0, 1]}
    contour = {"id": 2, "structure": 1, "plane": plane, "hole": False, "visible": True, "kind": "freehand", "points": square,
               "control": [{"at": square[0], "kind": "free", "index": 0}]}
    step = {"structures": [{"id": 1, "after": structure}], "contours": [{"id": 2, "before": contour, "after": contour}]}
    yield "\n".join([*map(json.dumps, (structure, contour, step)), "1"]).encode()
    yield "\n".join([*map(json.dumps, (structure, contour, step)), "1", "{}", "{}", json.dumps({"structures": [], "contours": []}), "2"]).encode()


TARGETS = [nifti, nrrd, metaimage, nifti_pair, mgh, gipl, dicom, dicom_seg, rtstruct, contour_json, markups, stl, ply, obj, vtk, vtp, csv, pipeline,
           fitting, messages, project]


def main():
    name, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    for target in TARGETS:
        if name in ("all", target.__name__):
            place = folder / target.__name__ if name == "all" else folder
            place.mkdir(parents=True, exist_ok=True)
            for number, content in enumerate(target()):
                (place / f"seed{number:02d}").write_bytes(content)


if __name__ == "__main__":
    main()
