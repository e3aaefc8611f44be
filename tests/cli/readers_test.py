# SPDX-License-Identifier: Apache-2.0
"""Every output of every command, made without an option that names anything, in the programs that others open it with: nibabel, ITK and
plastimatch, pydicom, dciodvfy, dcmqi's rules for segments, readers by the formats' definitions, and kontur itself. A reader that is not
installed is skipped."""
import functools
import importlib.util
import json
import pathlib
import shutil
import subprocess
import sys

import nibabel
import numpy
import pydicom
import pytest
from support import circle, kontur, read_nifti, write_planes

SUPPORT = pathlib.Path(__file__).parent.parent / "support"
CONTOURS_SCHEMA = SUPPORT.parent.parent / "docs" / "contours.schema.json"
CENTER, RADIUS = (-15.0, -25.0, 110.0), 3.5  # within the images

# What each command makes, and from what. Outputs come last.
OUTPUTS = {
    "segment-nii": "segment ball.json --image dicom -o mask.nii",
    "segment-nii.gz": "segment ball.json --image dicom -o mask.nii.gz",
    "segment-nrrd": "segment ball.json --image dicom -o mask.nrrd",
    "segment-seg.nrrd": "segment ball.json --image dicom -o mask.seg.nrrd",
    "segment-mha": "segment ball.json --image dicom -o mask.mha",
    "segment-mgz": "segment ball.json --image dicom -o mask.mgz",
    "segment-mgh": "segment ball.json --image dicom -o mask.mgh",
    "segment-seg": "segment ball.json --image dicom -o mask.dcm",
    "segment-no-image": "segment ball.json --spacing-mm 1 -o mask.nii.gz",
    "segment-rtstruct": "segment ball.json --image dicom -o mask.nii.gz --rtstruct contours.dcm",
    "segment-xor": "segment ball.json --image dicom -o mask.nii.gz --holes xor --rtstruct contours.dcm",
    **{f"segment-mesh-{kind}": f"segment ball.json --spacing-mm 1 -o mask.nii.gz --mesh surface.{kind}" for kind in ("stl", "ply", "obj", "vtk", "vtp")},
    "segment-picture": "segment ball.json --spacing-mm 1 -o mask.nii.gz --picture picture.png",
    "segment-uncertainty": "segment ball.json --spacing-mm 1 -o mask.nii.gz --uncertainty width.nii.gz",
    "segment-uncertainty-ply": "segment ball.json --spacing-mm 1 -o mask.nii.gz --uncertainty width.ply",
    "segment-rois": "segment rois.dcm --all-rois --image dicom -o organs.nii.gz",
    "segment-rois-seg": "segment rois.dcm --all-rois --image dicom -o organs.dcm",
    "segment-rois-seg.nrrd": "segment rois.dcm --all-rois --image dicom -o organs.seg.nrrd",
    "segment-rois-rtstruct": "segment rois.dcm --all-rois --image dicom -o organs.nii.gz --rtstruct contours.dcm",
    "segment-together": "segment rois.dcm --all-rois --together --image dicom -o organs.nii.gz --mesh organs.ply",
    "trace-json": "trace mask.nii.gz -o contours.json",
    "trace-mrk.json": "trace mask.nii.gz -o contours.mrk.json",
    "trace-rtstruct": "trace mask.nii.gz --image dicom -o contours.dcm",
    "trace-all": "trace organs.nii.gz --all-labels --image dicom -o contours.dcm",
    "fill-nii.gz": "fill sparse.nii.gz -o filled.nii.gz",
    "fill-seg.nrrd": "fill sparse.nii.gz -o organs.seg.nrrd",
    "fill-seg": "fill sparse.nii.gz --image dicom -o organs.dcm",
    "correct-nii.gz": "correct mask.nii.gz correction.json --provenance-map origin.nii.gz -o corrected.nii.gz",
    "correct-origin": "correct mask.nii.gz correction.json -o corrected.nii.gz --provenance-map origin.nii.gz",
    "correct-seg": "correct mask.nii.gz correction.json --image dicom --use-image off -o corrected.dcm",
    "suggest-planes": "suggest ball.json -o planes.json",
    "suggest-sketch": "suggest ball.json --sketch sketch.json",
    "slicer-nrrd": "slicer --reference mask.nii.gz --contour ball.mrk.json --mask mask.nrrd",
    "slicer-stl": "slicer --reference mask.nii.gz --contour ball.mrk.json --model surface.stl",
    "slicer-fill-nrrd": "slicer-fill --labels sparse.nii.gz --filled organs.nrrd",
    "slicer-correct-nrrd": "slicer-correct --labels mask.nii.gz --contour ball.mrk.json --corrected corrected.nrrd",
    **{f"convert-image-{kind}": f"convert dicom image.{kind}" for kind in ("nii", "nii.gz", "nrrd", "mha", "mgz", "mgh")},
    "derive-nii.gz": "derive P=mask+2mm -i mask.nii.gz -o derived.nii.gz",
    "derive-seg": "derive P=mask+2mm -i mask.nii.gz --image dicom -o derived.dcm",
    "derive-rtstruct": "derive P=mask+2mm -i mask.nii.gz --image dicom -o derived.nii.gz --rtstruct contours.dcm",
    "convert-labels-seg": "convert organs.nii.gz --image dicom organs.dcm",
    "convert-labels-seg.nrrd": "convert organs.nii.gz organs.seg.nrrd",
    "convert-overlap-seg": "convert mask.nii.gz --add organs_one.nii.gz --image dicom masks.dcm",
    "convert-contours-json": "convert ball.mrk.json contours.json",
    "convert-contours-mrk.json": "convert ball.json contours.mrk.json",
    "convert-contours-rtstruct": "convert ball.json --image dicom contours.dcm",
    **{f"convert-mesh-{kind}": f"convert surface.obj surface.{kind}" for kind in ("stl", "ply", "vtk", "vtp")},
    "convert-mesh-mask": "convert surface.obj --image dicom mask.nii.gz",
    "batch": "batch table.csv",
    "phantom": "phantom --scan liver .",
}
# Where the words do not name it.
ELSEWHERE = {"batch": "batched.seg.nrrd", "phantom": "liver.nii.gz"}


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """A folder with a DICOM series of 9 slices, and what the commands read."""
    folder = tmp_path_factory.mktemp("scene")
    subprocess.run([sys.executable, SUPPORT / "make_dicom_series.py", "axial", folder / "made"], check=True)
    (folder / "made" / "dicom").rename(folder / "dicom")
    planes = [circle(a, d, center=CENTER, radius=RADIUS) for a in "xyz" for d in (-1.5, 0, 1.5)]
    (folder / "ball.json").write_text(json.dumps({"frame": "LPS mm", "planes": planes}))
    (folder / "correction.json").write_text(
        json.dumps({"frame": "LPS mm", "planes": [circle("z", 0, center=CENTER, radius=2.5)]}))
    for words in ("segment ball.json --image dicom -o mask.nii.gz --mesh surface.obj", "convert ball.json ball.mrk.json"):
        assert kontur(*words.split(), cwd=folder).returncode == 0
    mask = nibabel.load(folder / "mask.nii.gz")
    inside = numpy.asarray(mask.dataobj) != 0
    left = numpy.arange(inside.shape[0])[:, None, None] < numpy.argwhere(inside)[:, 0].mean()
    organs = (inside * numpy.where(left, 1, 2)).astype(numpy.uint8)
    sparse = organs.copy()
    sparse[:, :, 4] = 0
    for name, array in {"organs": organs, "organs_one": organs == 1, "sparse": sparse}.items():
        nibabel.save(nibabel.Nifti1Image(array.astype(numpy.uint8), mask.affine), folder / f"{name}.nii.gz")
    assert kontur("trace", "organs.nii.gz", "--all-labels", "--image", "dicom", "-o", "rois.dcm", cwd=folder).returncode == 0
    return folder


@pytest.fixture(scope="module")
def made(scene, tmp_path_factory):
    """By name the file that a command made; each command runs once."""

    @functools.cache
    def make(name):
        folder = tmp_path_factory.mktemp(name)
        shutil.copytree(scene, folder, dirs_exist_ok=True)
        before = set(folder.rglob("*"))
        out = ELSEWHERE.get(name, OUTPUTS[name].split()[-1])
        if name == "batch":
            (folder / "table.csv").write_text(f"contours,image,output\nball.json,dicom,{out}\n")
        result = kontur(*OUTPUTS[name].split(), cwd=folder)
        assert result.returncode == 0, result
        if name == "phantom":
            return next(path for path in sorted(folder.rglob("*.nii.gz")) if path not in before)
        return folder / out

    return make


def kind_of(path):
    return ".nii.gz" if path.name.endswith(".nii.gz") else ".seg.nrrd" if path.name.endswith(".seg.nrrd") else \
        ".mrk.json" if path.name.endswith(".mrk.json") else path.suffix


def run(*words):
    return subprocess.run([*map(str, words)], capture_output=True, text=True, timeout=300)


def needs(program):
    if not shutil.which(program):
        pytest.skip(f"{program} is not installed")


def in_kontur(path, scene):
    result = kontur("inspect", path, "--json")
    assert (result.returncode, result.stderr) == (0, ""), result
    [facts] = json.loads(result.stdout)
    assert "damage" not in facts


def in_nibabel(path, scene):
    image = nibabel.load(path)
    assert numpy.asarray(image.dataobj).any()
    assert numpy.linalg.det(image.affine) != 0


def in_itk(path, scene):
    """Which plastimatch reads with: its statistics of the voxels."""
    needs("plastimatch")
    result = run("plastimatch", "stats", path)
    assert result.returncode == 0 and "MAX" in result.stdout, result


def in_pydicom(path, scene):
    """No name that a program shows is missing, nor empty."""
    data = pydicom.dcmread(path)
    assert data.SeriesDescription and data.SeriesNumber and data.SeriesInstanceUID
    names = [roi.ROIName for roi in data.get("StructureSetROISequence", [])] + [s.SegmentLabel for s in data.get("SegmentSequence", [])]
    assert names and all(names) and len(set(names)) == len(names)
    assert data.get("StructureSetLabel") or data.get("ContentLabel")


def in_dciodvfy(path, scene):
    needs("dciodvfy")
    assert "Error" not in run("dciodvfy", path).stderr


def code_of(item, keyword):
    [code] = item[keyword].value
    return all(code.get(word) for word in ("CodeValue", "CodingSchemeDesignator", "CodeMeaning"))


def in_dcmqi(path, scene):
    """What segimage2itkimage and its schema of metadata ask of a segmentation."""
    data = pydicom.dcmread(path)
    assert data.Modality == "SEG" and data.SegmentationType == "BINARY"
    assert data.FrameOfReferenceUID and data.ReferencedSeriesSequence[0].SeriesInstanceUID
    [shared] = data.SharedFunctionalGroupsSequence
    assert len(shared.PlaneOrientationSequence) == 1
    assert shared.PixelMeasuresSequence[0].PixelSpacing and shared.PixelMeasuresSequence[0].SpacingBetweenSlices
    assert data.ContentCreatorName is not None and data.InstanceNumber and data.ContentLabel
    for number, segment in enumerate(data.SegmentSequence, 1):
        assert segment.SegmentNumber == number
        assert code_of(segment, "SegmentedPropertyCategoryCodeSequence") and code_of(segment, "SegmentedPropertyTypeCodeSequence")
        assert segment.SegmentAlgorithmType in ("AUTOMATIC", "SEMIAUTOMATIC", "MANUAL")
        assert segment.SegmentAlgorithmType == "MANUAL" or segment.SegmentAlgorithmName
        assert len(segment.RecommendedDisplayCIELabValue) == 3
    numbers = {f.SegmentIdentificationSequence[0].ReferencedSegmentNumber for f in data.PerFrameFunctionalGroupsSequence}
    assert numbers == set(range(1, len(data.SegmentSequence) + 1))


def in_plastimatch(path, scene):
    """Each ROI becomes a mask by its name, and one that is not empty."""
    needs("plastimatch")
    ct, out = path.parent / "plain_ct.nii.gz", path.parent / "plastimatch"
    assert kontur("convert", scene / "dicom", ct).returncode == 0
    result = run("plastimatch", "convert", "--input", path, "--fixed", ct, "--output-prefix", out, "--prefix-format", "nii.gz")
    assert result.returncode == 0, result
    masks = list(out.glob("*.nii.gz"))
    assert len(masks) == len(pydicom.dcmread(path).StructureSetROISequence)
    assert all(read_nifti(mask).any() for mask in masks)


def by_definition(path, scene):
    result = run(sys.executable, SUPPORT / "mesh_volume.py", path)
    assert result.returncode == 0 and float(result.stdout.split()[1]) > 0, result


def in_vtk(path, scene):
    if not importlib.util.find_spec("vtk"):
        pytest.skip("VTK's Python package is not installed")
    import vtk

    reader = {".stl": vtk.vtkSTLReader, ".ply": vtk.vtkPLYReader, ".obj": vtk.vtkOBJReader, ".vtk": vtk.vtkPolyDataReader,
              ".vtp": vtk.vtkXMLPolyDataReader}[path.suffix]()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetOutput().GetNumberOfCells() > 0


def in_schema(path, scene):
    if importlib.util.find_spec("jsonschema") is None:
        pytest.skip("python3-jsonschema is not installed")
    result = run(sys.executable, SUPPORT / "validate_json.py", CONTOURS_SCHEMA, path)
    assert result.returncode == 0, result


def as_markups(path, scene):
    """3D Slicer asks for these."""
    document = json.loads(path.read_text())
    assert "markups-schema-v1" in document["@schema"] and document["markups"]
    for markup in document["markups"]:
        assert markup["type"] in ("ClosedCurve", "Curve", "Fiducial") and markup["coordinateSystem"] in ("LPS", "RAS")
        assert markup["controlPoints"] and all(len(point["position"]) == 3 for point in markup["controlPoints"])


def by_png_definition(path, scene):
    result = run(sys.executable, SUPPORT / "decode_png.py", path, path.with_suffix(".raw"))
    assert result.returncode == 0, result


VOXELS = [in_kontur, in_itk]
READERS = {
    ".nii": [*VOXELS, in_nibabel], ".nii.gz": [*VOXELS, in_nibabel], ".nrrd": VOXELS, ".seg.nrrd": VOXELS, ".mha": VOXELS,
    ".mgz": [in_kontur, in_nibabel], ".mgh": [in_kontur, in_nibabel],
    **{kind: [in_kontur, by_definition, in_vtk] for kind in (".stl", ".ply", ".obj", ".vtk", ".vtp")},
    ".json": [in_kontur, in_schema], ".mrk.json": [in_kontur, as_markups], ".png": [by_png_definition],
}
SEG, RTSTRUCT = [in_kontur, in_pydicom, in_dciodvfy, in_dcmqi], [in_kontur, in_pydicom, in_dciodvfy, in_plastimatch]


def readers_of(name):
    out = pathlib.Path(ELSEWHERE.get(name, OUTPUTS[name].split()[-1]))
    if out.suffix == ".dcm":
        return RTSTRUCT if out.name == "contours.dcm" else SEG
    return READERS[kind_of(out)]


@pytest.mark.parametrize("name, reader", [pytest.param(n, r, id=f"{n}-{r.__name__}") for n in OUTPUTS for r in readers_of(n)])
def test_an_output_opens(made, scene, name, reader):
    reader(made(name), scene)


def test_no_command_that_writes_is_left_out():
    said = kontur("--help").stdout
    commands = [line.split()[0] for line in said[said.index("Subcommands:"):].splitlines()[1:] if line.startswith("  ") and line[2] != " "]
    write_nothing = {"compare", "fetch", "find", "inspect", "open", "send"}  # of their own
    assert {words.split()[0] for words in OUTPUTS.values()} | write_nothing >= set(commands) - {"Lengths"}
    assert len(commands) > 10
