# SPDX-License-Identifier: Apache-2.0
"""What kontur segment writes says how it was made, and says the same each time."""
import hashlib
import json
import os
import re
import zlib

import nibabel
import numpy
import pytest
from support import ball_array, ball_planes, kontur, read_nifti, write_nifti, write_planes


@pytest.fixture
def folder(tmp_path):
    write_planes(tmp_path / "ball.json", ball_planes())
    write_nifti(tmp_path / "image.nii.gz", (ball_array() * 150 - 100).astype(numpy.int16))
    return tmp_path


def segment(folder, *words, **options):
    result = kontur("segment", "ball.json", "--image", "image.nii.gz", *words, cwd=folder, **options)
    assert result.returncode == 0, result


def sha256(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def comment(path):
    """The lines of a NIfTI file's comment extension as names and values."""
    [extension] = nibabel.load(path).header.extensions
    assert extension.get_code() == 6
    lines = extension.get_content().rstrip(b"\0").decode().splitlines()
    return dict(line.split(": ", 1) for line in lines[1:])


def test_the_digests_are_those_of_the_files(folder):
    segment(folder, "--output", "out.nii.gz", "--report", "out.json")
    made = json.loads((folder / "out.json").read_text())["provenance"]
    assert made["contour_files_sha256"] == sha256(folder / "ball.json")
    assert made["image_sha256"] == sha256(folder / "image.nii.gz")
    assert re.fullmatch("[0-9a-f]{64}", made["contours_sha256"])
    assert "date" not in made
    assert {key: value for key, value in comment(folder / "out.nii.gz").items() if key in made} == made


@pytest.mark.parametrize("epoch", ["99999999999999999", "253402300800", "-1", "yesterday", "", "1 "])
def test_a_date_that_is_none_is_refused_before_the_work(folder, epoch):
    words = ["segment", "absent.json", "--image", "image.nii.gz", "--output", "out.nii.gz", "--date"]
    result = kontur(*words, cwd=folder, env={**os.environ, "SOURCE_DATE_EPOCH": epoch})
    assert result.returncode == 65
    assert result.stderr.startswith(f"kontur: error: SOURCE_DATE_EPOCH is {epoch};")


def test_a_nifti_mask_is_read_by_others_as_before(folder):
    segment(folder, "--output", "out.nii.gz")
    segment(folder, "--output", "out.nii")
    assert numpy.array_equal(read_nifti(folder / "out.nii.gz"), read_nifti(folder / "out.nii"))
    assert set(numpy.unique(read_nifti(folder / "out.nii"))) == {0, 1}
    description = nibabel.load(folder / "out.nii").header["descrip"].item().decode()
    assert description.startswith("kontur contours_sha256=" + comment(folder / "out.nii")["contours_sha256"][:12])
    result = json.loads(kontur("compare", folder / "out.nii", folder / "out.nii.gz", "--json").stdout)
    assert result["dice"] == 1


@pytest.mark.parametrize("mask, pattern", [("out.nrrd", "kontur_{}:={}\n"), ("out.seg.nrrd", "kontur_{}:={}\n")])
def test_other_masks_and_meshes_say_the_same(folder, mask, pattern):
    segment(folder, "--output", mask, "--mesh", "out.ply", "--report", "out.json")
    segment(folder, "--output", "out.mha", "--mesh", "out.obj")
    segment(folder, "--output", "out.nii", "--mesh", "out.stl")
    made = comment(folder / "out.nii")
    for file, form in [(mask, pattern), ("out.ply", "comment kontur {}: {}\n"), ("out.obj", "# kontur {}: {}\n")]:
        header = (folder / file).read_bytes()[:4000].decode(errors="replace")
        for name, value in made.items():
            assert form.format(name, value) in header, file
    digest = made["contours_sha256"][:12].encode()
    assert digest in (folder / "out.stl").read_bytes()[:80] and digest in (folder / "out.mha").read_bytes()[:400]
    for file in (mask, "out.mha"):
        assert json.loads(kontur("compare", folder / file, folder / "out.nii", "--json").stdout)["dice"] == 1
    for file in ("out.ply", "out.obj", "out.stl"):
        assert json.loads(kontur("inspect", folder / file, "--json").stdout)[0]["kind"] == "mesh"


def test_the_report_says_all_that_the_other_files_say(folder):
    segment(folder, "--output", "out.nii", "--report", "out.json", "--fill-rule", "declared")
    report = json.loads((folder / "out.json").read_text())
    assert report["provenance"] == comment(folder / "out.nii")
    options = dict(word.split("=") for word in report["provenance"]["options"].split())
    assert set(options) <= set(report) and report["fill_rule"] == "declared"


def test_equal_contours_have_one_digest_and_others_another(folder):
    segment(folder, "--output", "a.nii")
    kontur("convert", "ball.json", "same.json", cwd=folder)
    kontur("segment", "same.json", "--image", "image.nii.gz", "--output", "b.nii", cwd=folder)
    kontur("segment", write_planes(folder / "fewer.json", ball_planes()[:-1]), "--image", "image.nii.gz", "--output", "c.nii", cwd=folder)
    a, b, c = (comment(folder / f"{name}.nii") for name in "abc")
    assert a["contours_sha256"] == b["contours_sha256"] != c["contours_sha256"]
    assert a["contour_files_sha256"] != b["contour_files_sha256"]
    assert a["grid_sha256"] == c["grid_sha256"]
    segment(folder, "--output", "d.nii", "--quality", "0.5")
    assert "quality=0.5 " in comment(folder / "d.nii")["options"]


def test_a_date_only_when_asked_and_from_the_environment(folder):
    segment(folder, "--output", "a.nii", "--date", env={"SOURCE_DATE_EPOCH": "86400"})
    segment(folder, "--output", "b.nii", "--date")
    assert comment(folder / "a.nii")["date"] == "1970-01-02T00:00:00Z"
    assert re.fullmatch(r"20\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ", comment(folder / "b.nii")["date"])


def test_no_file_name_and_no_time_go_into_the_files(folder):
    segment(folder, "--output", "a.nii", "--mesh", "a.ply")
    (folder / "DOE_JANE.json").write_bytes((folder / "ball.json").read_bytes())
    kontur("segment", "DOE_JANE.json", "--image", "image.nii.gz", "--output", "b.nii", "--mesh", "b.ply", cwd=folder)
    assert (folder / "a.nii").read_bytes() == (folder / "b.nii").read_bytes()
    assert (folder / "a.ply").read_bytes() == (folder / "b.ply").read_bytes()


def png_texts(path):
    """The text chunks of a PNG, whose checksums must be right."""
    data, at, texts = path.read_bytes(), 8, {}
    while at < len(data):
        length, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        body = data[at + 8:at + 8 + length]
        assert zlib.crc32(kind + body) == int.from_bytes(data[at + 8 + length:at + 12 + length], "big")
        if kind == b"iTXt":
            keyword, text = body.split(b"\0", 1)
            texts[keyword.decode()] = text[4:].decode()
        at += 12 + length
    return texts


def test_a_picture_says_how_it_was_made(folder):
    segment(folder, "--output", "out.nii", "--picture", "out.png")
    made = comment(folder / "out.nii")
    assert png_texts(folder / "out.png") == {f"kontur {name}": value for name, value in made.items()}
    assert "tolerance_mm=" in made["options"]


def test_traced_contours_say_of_what(folder):
    segment(folder, "--output", "out.nii")
    for output, key in (("traced.json", "provenance"), ("traced.mrk.json", "kontur")):
        result = kontur("trace", "out.nii", "--planes", "ball.json", "--output", output, "--min-area-mm2", "2", cwd=folder)
        assert result.returncode == 0, result
        made = json.loads((folder / output).read_text())[key]
        assert made["made_by"] == "kontur trace" and "min_area_mm2=2" in made["options"]
        assert made.items() >= {f"mask_{name}": value for name, value in comment(folder / "out.nii").items()}.items()
        assert made["mask_sha256"] == sha256(folder / "out.nii") and made["planes_sha256"] == sha256(folder / "ball.json")
        assert kontur("inspect", output, cwd=folder).returncode == 0
    kontur("trace", "out.nii", "--planes", "ball.json", "--output", "again.json", "--min-area-mm2", "2", cwd=folder)
    assert (folder / "again.json").read_bytes() == (folder / "traced.json").read_bytes()


@pytest.mark.parametrize("source, output", [("out.nii", "b.nrrd"), ("out.nii", "b.seg.nrrd"), ("out.nii", "b.mha"), ("out.nii", "b.nii.gz"),
                                            ("out.ply", "b.obj"), ("out.ply", "b.stl"), ("ball.json", "b.json"), ("ball.json", "b.mrk.json")])
def test_a_converted_file_names_its_source_by_digest(folder, source, output):
    segment(folder, "--output", "out.nii", "--mesh", "out.ply")
    assert kontur("convert", source, output, cwd=folder).returncode == 0
    digest = sha256(folder / source)
    content = (folder / output).read_bytes()
    if output.endswith(".gz"):
        assert comment(folder / output)["source_sha256"] == digest
    elif output.endswith((".stl", ".mha")):
        assert b"source_sha256=" + digest[:12].encode() in content[:400]
    else:
        assert digest.encode() in content
    assert str(folder).encode() not in content


def provenance(path):
    """What `kontur inspect` finds in a file."""
    [facts] = json.loads(kontur("inspect", path, "--json").stdout)
    return facts.get("provenance", {})


@pytest.mark.parametrize("source, steps", [("out.nii", ["b.nrrd", "c.seg.nrrd", "d.nii.gz"]), ("out.ply", ["b.obj", "c.ply"]),
                                           ("traced.json", ["b.mrk.json", "c.json"])])
def test_a_converted_file_carries_on_what_its_source_says(folder, source, steps):
    segment(folder, "--output", "out.nii", "--mesh", "out.ply")
    kontur("trace", "out.nii", "--planes", "ball.json", "--output", "traced.json", cwd=folder)
    before = provenance(folder / source)
    assert before
    for step in steps:
        assert kontur("convert", source, step, cwd=folder).returncode == 0
        after = provenance(folder / step)
        assert after.items() >= {f"source_{name}": value for name, value in before.items()}.items()
        assert (after["made_by"], after["source_sha256"]) == ("kontur convert", sha256(folder / source))
        source, before = step, after


def test_formats_that_shorten_carry_on_the_shortened_text(folder):
    segment(folder, "--output", "out.mha", "--mesh", "out.stl")
    for source, output in (("out.mha", "b.nii"), ("out.stl", "b.ply")):
        kontur("convert", source, output, cwd=folder)
        assert provenance(folder / output)["source_shortened"] == provenance(folder / source)["shortened"]


def test_very_many_conversions_do_not_pile_up(folder):
    source = "ball.json"
    for step in range(40):
        assert kontur("convert", source, f"{step}.json", cwd=folder).returncode == 0
        source = f"{step}.json"
    assert len(provenance(folder / source)) == 100


def test_inspect_shows_people_how_a_file_was_made(folder):
    kontur("convert", "ball.json", "again.json", cwd=folder)
    assert "provenance\n    made_by: kontur convert\n" in kontur("inspect", "again.json", cwd=folder).stdout
    assert "provenance" not in kontur("inspect", "ball.json", cwd=folder).stdout


def test_the_phantom_says_which_noise(folder):
    assert kontur("phantom", "made", "--scan", "metastasis", "--seed", "3", cwd=folder).returncode == 0
    assert comment(folder / "made" / "metastasis_ct.nii.gz")["options"] == "seed=3 noise_hu=14"
    assert json.loads((folder / "made" / "kidney_radial6.json").read_text())["provenance"]["made_by"] == "kontur phantom"
