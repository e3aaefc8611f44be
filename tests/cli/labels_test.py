# SPDX-License-Identifier: Apache-2.0
"""What files say of labels: names in NIfTI, segments of one value on layers of a .seg.nrrd."""
import gzip
import json
import pathlib
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import nibabel
import numpy
import pydicom
import pytest
from support import circle, kontur, lps_affine, read_nifti, succeed, write_nifti, write_planes

SUPPORT = pathlib.Path(__file__).parents[1] / "support"
NAMES = {1: "spleen", 2: "kidney_right", 12: "lung <upper> & lobe"}


def label_array():
    labels = numpy.zeros((12, 10, 8), numpy.uint8)
    labels[1:4, 2:8, 2:6], labels[5:8, 2:8, 2:6], labels[9:11, 2:8, 2:6] = NAMES
    return labels


def named_nifti(path, code=0, table=None):
    """With a table of labels as TotalSegmentator writes it."""
    image = nibabel.Nifti1Image(label_array(), numpy.diag([-1.0, -1.0, 1.0, 1.0]) @ lps_affine(2.0))
    rows = "".join(f'<Label Key="{n}" Red="0.2" Green="0.4" Blue="0.8" Alpha="1"><![CDATA[{name}]]></Label>' for n, name in NAMES.items())
    text = table or f'<?xml version="1.0" encoding="UTF-8"?> <CaretExtension> <VolumeInformation Index="0"> <LabelTable>{rows}</LabelTable> </VolumeInformation></CaretExtension>'
    image.header.extensions.append(nibabel.nifti1.Nifti1Extension(code, text.encode()))
    nibabel.save(image, path)
    return path


def names_in(path):
    [facts] = json.loads(kontur("inspect", path, "--json").stdout)
    return {label["label"]: label.get("name") for label in facts["labels"]}


@pytest.mark.parametrize("code", [0, 30])
@pytest.mark.parametrize("through", [None, "seg.nrrd", "nii", "nii.gz"])
def test_names_of_labels_in_nifti_are_read_and_kept(tmp_path, code, through):
    path = named_nifti(tmp_path / "named.nii.gz", code)
    if through:
        succeed("convert", path, tmp_path / f"through.{through}")
        path = tmp_path / f"through.{through}"
    assert names_in(path) == NAMES


def test_the_table_is_where_totalsegmentator_looks_for_it(tmp_path):
    """In the first extension, as XML; how the file was made stays behind it."""
    named_nifti(tmp_path / "named.nii.gz")
    succeed("convert", tmp_path / "named.nii.gz", tmp_path / "out.nii.gz")
    first, *more = nibabel.load(tmp_path / "out.nii.gz").header.extensions
    content = first.get_content()
    root = ElementTree.fromstring((content if isinstance(content, bytes) else content.encode()).rstrip(b"\0"))
    labels = root.find("VolumeInformation").find("LabelTable").findall("Label")
    assert {int(label.get("Key")): label.text for label in labels} == NAMES
    assert (float(labels[0].get("Red")), float(labels[0].get("Blue"))) == (0.2, 0.8)
    assert more and "made_by: kontur convert" in kontur("inspect", tmp_path / "out.nii.gz").stdout
    assert numpy.array_equal(read_nifti(tmp_path / "out.nii.gz"), label_array())
    succeed("convert", tmp_path / "named.nii.gz", tmp_path / "one.nii.gz", "--label", 2)
    assert names_in(tmp_path / "one.nii.gz") == {2: NAMES[2]}


def test_a_traced_label_has_its_name(tmp_path):
    named_nifti(tmp_path / "named.nii.gz")
    succeed("trace", tmp_path / "named.nii.gz", "--label", 2, "-o", tmp_path / "kidney.json")
    assert json.loads((tmp_path / "kidney.json").read_text())["structure"] == "kidney_right"


@pytest.mark.parametrize("table", ["<LabelTable>", "<LabelTable></LabelTable>", '<LabelTable><Label Key="x">a</Label><Label Key="1"></Label><Label </LabelTable>', "plain text"])
def test_a_damaged_table_costs_the_names_alone(tmp_path, table):
    path = named_nifti(tmp_path / "named.nii.gz", table=table)
    assert names_in(path) == dict.fromkeys(NAMES)
    succeed("convert", path, tmp_path / "out.nii.gz")
    assert numpy.array_equal(read_nifti(tmp_path / "out.nii.gz"), label_array())


def test_entities_and_missing_colours_are_read(tmp_path):
    path = named_nifti(tmp_path / "named.nii.gz", table='<LabelTable><Label Key="1">a &lt;b&gt; &amp; c</Label><Label Key="1">again</Label></LabelTable>')
    assert names_in(path) == {1: "a <b> & c", 2: None, 12: None}


@pytest.fixture
def layers(tmp_path):
    """Two segments on two layers, both of value 1, as 3D Slicer writes segments that overlap."""
    one, two = numpy.zeros((2, 8, 10, 12), numpy.uint8)  # k, j, i
    one[2:6, 2:8, 2:8], two[3:5, 2:8, 5:11] = 1, 1
    head = """NRRD0004
type: uint8
dimension: 4
space: left-posterior-superior
sizes: 2 12 10 8
space directions: none (1,0,0) (0,1,0) (0,0,2)
kinds: list domain domain domain
encoding: gzip
space origin: (0,0,0)
"""
    for n, name in enumerate(("one", "two")):
        head += f"Segment{n}_ID:=S{n}\nSegment{n}_Name:={name}\nSegment{n}_LabelValue:=1\nSegment{n}_Layer:={n}\n"
    path = tmp_path / "layers.seg.nrrd"
    path.write_bytes(head.encode() + b"\n" + gzip.compress(numpy.stack([one, two], axis=-1).tobytes()))
    return path, one, two


def test_segments_of_one_value_are_chosen_by_their_place_everywhere(tmp_path, layers):
    path, one, two = layers
    for n, mask in ((1, one), (2, two)):
        succeed("convert", path, tmp_path / "one.nii.gz", "--label", n)
        assert numpy.array_equal(read_nifti(tmp_path / "one.nii.gz").transpose(2, 1, 0), n * mask)
        same = json.loads(succeed("compare", path, tmp_path / "one.nii.gz", "--label", n, "--json"))
        assert same["dice"] == 1 and same["volume_a_ml"] == pytest.approx(mask.sum() * 2 / 1000)
        succeed("trace", path, "--label", n, "-o", tmp_path / "one.json")
        assert json.loads((tmp_path / "one.json").read_text())["structure"] == ("one", "two")[n - 1]
        assert kontur("fill", path, "--label", n, "-o", tmp_path / "filled.nii.gz").returncode == 0
        assert numpy.array_equal(read_nifti(tmp_path / "filled.nii.gz").transpose(2, 1, 0), n * mask)
    [facts] = json.loads(kontur("inspect", path, "--json").stdout)
    assert [(s["number"], s["name"]) for s in facts["segments"]] == [(1, "one"), (2, "two")]


def test_a_choice_among_layers_is_asked_for_by_number_and_name(tmp_path, layers):
    path, _, _ = layers
    for words in (["compare", path, path], ["trace", path, "-o", "out.json"]):
        result = kontur(*words, cwd=tmp_path)
        assert result.returncode == 65 and "has 2 segments on several layers; choose one with --label: 1 'one', 2 'two'\n" in result.stderr, result
    for words in (["compare", path, path], ["trace", path, "-o", "out.json"], ["convert", path, "out.nii"]):
        result = kontur(*words, "--label", 3, cwd=tmp_path)
        assert result.returncode == 65 and "has no segment 3; it has 1 'one', 2 'two'\n" in result.stderr, result
    assert not list(tmp_path.glob("out*"))


@pytest.fixture(scope="module")
def images(tmp_path_factory):
    folder = tmp_path_factory.mktemp("images") / "axial"
    subprocess.run([sys.executable, SUPPORT / "make_dicom_series.py", "axial", folder], check=True)
    return folder / "dicom"


def test_each_dicom_output_has_the_series_number_and_description_of_the_words(tmp_path, images):
    succeed("convert", images, tmp_path / "ct.nii.gz")
    ct = nibabel.load(tmp_path / "ct.nii.gz")
    labels = numpy.zeros(ct.shape, numpy.uint8)
    labels[2:6, 2:7, 2:6] = 1
    nibabel.save(nibabel.Nifti1Image(labels, ct.affine), tmp_path / "mask.nii.gz")
    assert kontur("trace", tmp_path / "mask.nii.gz", "-o", tmp_path / "own.json").returncode == 0
    words = ["--series-number", 4711, "--series-description", "Lösung B"]
    made = {
        "seg.dcm": ["segment", "own.json", "--image", images, "-o", "seg.dcm", "--rtstruct", "rt.dcm"],
        "rt.dcm": None,
        "traced.dcm": ["trace", "mask.nii.gz", "--image", images, "-o", "traced.dcm"],
        "filled.dcm": ["fill", "mask.nii.gz", "--image", images, "-o", "filled.dcm"],
        "mask.dcm": ["convert", "mask.nii.gz", "mask.dcm", "--image", images],
        "own.dcm": ["convert", "own.json", "own.dcm", "--image", images],
    }
    for name, command in made.items():
        if command:
            assert (result := kontur(*command, *words, cwd=tmp_path)).returncode == 0, result
        read = pydicom.dcmread(tmp_path / name)
        assert (read.SeriesNumber, read.SeriesDescription) == (4711, "Lösung B"), name


def test_words_for_a_series_are_refused_where_none_is_written_or_has_room(tmp_path):
    write_planes(tmp_path / "own.json", [circle("z", 0)])
    write_nifti(tmp_path / "mask.nii", label_array())
    for words in (["convert", "own.json", "out.mrk.json"], ["trace", "mask.nii", "--label", 1, "-o", "out.json"], ["fill", "mask.nii", "-o", "out.nii"]):
        for option in (["--series-number", 3], ["--series-description", "x"]):
            result = kontur(*words, *option, cwd=tmp_path)
            assert result.returncode == 65 and "--series-number and --series-description are for DICOM (.dcm)" in result.stderr, result
    result = kontur("convert", "own.json", "out.dcm", "--image", "ct", "--series-description", "x" * 65, cwd=tmp_path)
    assert result.returncode == 65 and "--series-description has 65 bytes; DICOM has room for 64" in result.stderr, result
    assert kontur("convert", "own.json", "out.dcm", "--series-number", 0, cwd=tmp_path).returncode == 64
