# SPDX-License-Identifier: Apache-2.0
"""kontur segment end to end: a ball from nine contours."""
import gzip
import hashlib
import json
import os
import re
import signal
import subprocess
import time

import nibabel
import numpy
import pytest
from support import KONTUR, ball_array, ball_planes, circle, dice, kontur, lps_affine, names, read_nifti, real_data, write_nifti, write_planes


@pytest.fixture
def folder(tmp_path):
    write_planes(tmp_path / "ball.json", ball_planes())
    write_nifti(tmp_path / "image.nii.gz", (ball_array() * 150 - 100).astype(numpy.int16))
    return tmp_path


def segment(folder, *words):
    """Runs the command in `folder`; stderr may hold warnings only."""
    result = kontur("segment", *words, cwd=folder)
    assert result.returncode == 0, result
    assert all(line.startswith("kontur: warning: ") for line in result.stderr.splitlines()), result
    return result.stdout


FROM_IMAGE = ["ball.json", "--image", "image.nii.gz", "--output", "out.nii.gz"]


def test_mask_lies_on_the_images_grid_and_is_the_ball(folder):
    segment(folder, *FROM_IMAGE)
    mask = read_nifti(folder / "out.nii.gz")
    assert mask.dtype == numpy.uint8
    assert set(numpy.unique(mask)) == {0, 1}
    assert numpy.allclose(nibabel.load(folder / "out.nii.gz").affine, nibabel.load(folder / "image.nii.gz").affine, atol=1e-5)
    assert dice(mask, ball_array()) > 0.995


def test_only_a_reference_solver_loads_openblas(folder):
    for solver, loads in (("iterative", False), ("cholesky", True)):
        result = subprocess.run([KONTUR, "segment", *FROM_IMAGE, "--solver", solver, "--quiet"], cwd=folder, check=True,
                                env={**os.environ, "LD_DEBUG": "files"}, capture_output=True, text=True)
        assert "libc.so.6" in result.stderr
        assert ("openblas" in result.stderr) == loads, solver


def test_all_outputs_and_the_report(folder):
    text = segment(folder, *FROM_IMAGE, "--mesh", "out.stl", "--picture", "out.png", "--report", "out.json")
    assert names(folder) == ["ball.json", "image.nii.gz", "out.json", "out.nii.gz", "out.png", "out.stl"]
    for name in ["out.nii.gz", "out.stl", "out.png", "out.json", "residual", "ml"]:
        assert name in text
    assert (folder / "out.png").read_bytes().startswith(b"\x89PNG")
    assert b"SPACE=LPS" in (folder / "out.stl").read_bytes()[:80]

    report = json.loads((folder / "out.json").read_text())
    mask = read_nifti(folder / "out.nii.gz")
    assert (report["contours"], report["points"]) == (9, 360)
    assert report["constraints"] >= report["centres"] > 360
    assert report["normals"] == "surface"
    assert report["solver"] in ("iterative", "cholesky", "dense")
    assert report["iterations"] > 0
    assert 0 <= report["residual_mm"]["rms"] <= report["residual_mm"]["max"] < 0.1
    assert report["crossings"]["matched"] >= 24  # each axial circle meets each of the others twice
    assert report["crossings"]["disagreement_mm"]["max"] < 0.2
    assert report["voxelizer"] == "adaptive"
    assert report["surface_voxels"] > 0 and report["evaluations"] > 0
    assert report["seconds"]["total"] == pytest.approx(sum(t for s, t in report["seconds"].items() if s != "total"))
    assert report["peak_memory_mb"] > 1
    assert report["mask"] == {
        "voxels": numpy.count_nonzero(mask),
        "volume_ml": pytest.approx(numpy.count_nonzero(mask) / 1000),
        "components": 1,
    }
    assert isinstance(report["warnings"], list)
    assert re.fullmatch(r"\d+\.\d+\.\d+", report["version"])


def test_spacing_and_margin_give_a_grid_around_the_contours(folder):
    segment(folder, "ball.json", "--spacing-mm", "1,1,2", "--margin-mm", 4, "--output", "out.nii.gz")
    image = nibabel.load(folder / "out.nii.gz")
    assert image.header.get_zooms() == (1, 1, 2)
    affine = numpy.diag([-1.0, -1.0, 1.0, 1.0]) @ image.affine
    low = affine[:3, 3] - 0.5 * numpy.array(image.header.get_zooms())
    assert low == pytest.approx([2 - 4, -17 - 4, -5 - 4], abs=1)
    assert dice(numpy.asarray(image.dataobj), ball_array(image.shape, affine)) > 0.99


def test_one_spacing_serves_all_axes(folder):
    segment(folder, "ball.json", "--spacing-mm", 2, "--output", "out.nii.gz")
    assert nibabel.load(folder / "out.nii.gz").header.get_zooms() == (2, 2, 2)


def test_contour_files_are_merged(folder):
    planes = ball_planes()
    write_planes(folder / "a.json", planes[:4])
    write_planes(folder / "b.json", planes[4:])
    segment(folder, *FROM_IMAGE)
    segment(folder, "a.json", "b.json", "--image", "image.nii.gz", "--output", "merged.nii.gz")
    assert numpy.array_equal(read_nifti(folder / "out.nii.gz"), read_nifti(folder / "merged.nii.gz"))


def test_the_paper_as_printed(folder):
    report = ["--report", "out.json"]
    segment(folder, *FROM_IMAGE, "--kernel", "triharmonic", "--normals", "in-plane", "--normal-offset-mm", 1, "--solver",
            "dense", *report)
    found = json.loads((folder / "out.json").read_text())
    assert (found["solver"], found["normal_offset_mm"], found["iterations"]) == ("dense", 1, 0)
    assert dice(read_nifti(folder / "out.nii.gz"), ball_array()) > 0.95


@pytest.mark.parametrize("words", [["--voxelizer", "exhaustive"], ["--voxelizer", "tracked"], ["--threads", 1], ["--threads", 3]])
def test_ways_to_the_same_mask(folder, words):
    segment(folder, *FROM_IMAGE)
    segment(folder, "ball.json", "--image", "image.nii.gz", "--output", "other.nii.gz", *words)
    assert numpy.array_equal(read_nifti(folder / "out.nii.gz"), read_nifti(folder / "other.nii.gz"))


def test_direct_and_iterative_solvers_agree_up_to_voxels_on_the_surface(folder):
    segment(folder, *FROM_IMAGE)
    for solver in ["cholesky", "dense"]:
        segment(folder, "ball.json", "--image", "image.nii.gz", "--output", f"{solver}.nii.gz", "--solver", solver)
        assert dice(read_nifti(folder / "out.nii.gz"), read_nifti(folder / f"{solver}.nii.gz")) > 0.998


def test_the_same_input_gives_the_same_bytes(folder):
    def digests(prefix, threads):
        files = [f"{prefix}.nii.gz", f"{prefix}.stl", f"{prefix}.png"]
        segment(folder, "ball.json", "--image", "image.nii.gz", "--output", files[0], "--mesh", files[1], "--picture", files[2],
                "--threads", threads)
        return [hashlib.sha256((folder / file).read_bytes()).hexdigest() for file in files]

    assert digests("a", 1) == digests("b", 1) == digests("c", 4)


def test_kernel_quality_smoothing_and_label_value_arrive(folder):
    write_planes(folder / "ball.json", [circle(axis, 0, points=200) for axis in "xyz"])
    segment(folder, *FROM_IMAGE, "--kernel", "biharmonic", "--quality", 0.5, "--smoothing", 0.001, "--label-value", 300,
            "--report", "out.json")
    report = json.loads((folder / "out.json").read_text())
    assert (report["kernel"], report["quality"], report["smoothing"]) == ("biharmonic", 0.5, 0.001)
    # A boundary and a normal constraint at every second of the 600 points, or at the third of these that tells the lines: which
    # of the two is a matter of rounding here.
    assert 150 < report["centres"] <= 600
    assert set(numpy.unique(read_nifti(folder / "out.nii.gz"))) == {0, 300}


def test_contours_partly_outside_the_image_are_a_warning(folder):
    write_nifti(folder / "small.nii.gz", ball_array((40, 40, 20)))  # ends 1 mm above the ball's lower pole
    result = kontur("segment", "ball.json", "--image", "small.nii.gz", "--output", "out.nii.gz", "--report", "out.json", cwd=folder)
    assert result.returncode == 0
    [warning] = [w for w in json.loads((folder / "out.json").read_text())["warnings"] if "360 contour points" in w]
    assert f"kontur: warning: {warning}\n" in result.stderr


def test_repeated_points_are_left_out_with_a_warning(folder):
    planes = ball_planes()
    points = planes[0]["contours"][0]["points"]
    points[3:3] = [points[3]] * 2
    write_planes(folder / "repeated.json", planes)
    result = kontur("segment", "repeated.json", "--image", "image.nii.gz", "--output", "repeated.nii.gz", cwd=folder)
    assert result.returncode == 0
    assert "kontur: warning: 2 repeated points were left out\n" in result.stderr
    segment(folder, *FROM_IMAGE)
    assert numpy.array_equal(read_nifti(folder / "repeated.nii.gz"), read_nifti(folder / "out.nii.gz"))


def test_quiet_prints_nothing_but_warnings(folder):
    assert segment(folder, *FROM_IMAGE, "--quiet") == ""


def test_a_terminal_shows_progress_and_a_pipe_does_not(folder):
    try:
        read_end, write_end = os.openpty()
    except OSError as error:
        pytest.skip(f"no terminal to be had here: {error}")
    process = subprocess.Popen([KONTUR, "segment", *FROM_IMAGE], cwd=folder, stdout=subprocess.DEVNULL, stderr=write_end)
    process.wait(60)
    os.close(write_end)
    drawn = b""
    try:
        while chunk := os.read(read_end, 65536):
            drawn += chunk
    except OSError:
        pass  # the other end is closed
    os.close(read_end)
    assert re.search(rb"\r\[#*\.*\] +\d+ %  \w+", drawn)
    assert b"\r" not in kontur("segment", *FROM_IMAGE, cwd=folder).stderr.encode()


@pytest.mark.parametrize("stop", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_leaves_everything_as_it_was(folder, stop):
    (folder / "out.nii.gz").write_text("old")
    before = names(folder)
    # About 64 million voxels, each evaluated: minutes.
    words = ["segment", "ball.json", "--spacing-mm", "0.1", "--voxelizer", "exhaustive", "--output", "out.nii.gz"]
    process = subprocess.Popen([KONTUR, *words], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    time.sleep(1)
    process.send_signal(stop)
    stdout, stderr = process.communicate(timeout=20)
    assert process.returncode == 130
    assert stdout == ""
    assert stderr.splitlines()[-1] == "kontur: error: interrupted; nothing was written"
    assert names(folder) == before
    assert (folder / "out.nii.gz").read_text() == "old"


@pytest.fixture
def ct(folder):
    noise = numpy.random.default_rng(5).normal(0, 20, ball_array().shape)
    write_nifti(folder / "ct.nii.gz", (ball_array() * 150 - 100 + noise).astype(numpy.int16))
    return ["ball.json", "--image", "ct.nii.gz", "--output", "out.nii.gz", "--report", "report.json"]


def image_of_report(folder):
    return json.loads((folder / "report.json").read_text())["image"]


def test_the_image_is_asked_between_the_contours_unless_told_not_to(folder, ct):
    said = segment(folder, *ct)
    image = image_of_report(folder)
    assert image["verdict"] in ("used", "no_help") and image["planes_left_out"] == 9
    assert image["sentence"] in said
    segment(folder, *ct, "--use-image", "off")
    assert image_of_report(folder) == {"verdict": "none"}
    alone = kontur("segment", "ball.json", "--spacing-mm", "1", "--output", "out.nii.gz", "--use-image", "auto", cwd=folder)
    assert alone.returncode != 0 and "--image" in alone.stderr


def test_a_mask_in_the_images_place_gives_the_grid_alone(folder):
    said = segment(folder, *FROM_IMAGE, "--report", "report.json")
    image = image_of_report(folder)
    assert image["verdict"] == "labels" and "a mask or a label map; not used" in image["sentence"] and image["sentence"] in said
    mask = read_nifti(folder / "out.nii.gz")
    segment(folder, *FROM_IMAGE, "--use-image", "off")
    assert (read_nifti(folder / "out.nii.gz") == mask).all()


def test_a_frame_that_was_asked_for_must_be_there(folder):
    frames = numpy.stack(2 * [ball_array().astype(numpy.int16)], axis=-1)
    nibabel.save(nibabel.Nifti1Image(frames, nibabel.load(folder / "image.nii.gz").affine), folder / "4d.nii.gz")
    words = ("segment", folder / "ball.json", "--image", folder / "4d.nii.gz", "--output", folder / "out.nii.gz")
    refused = kontur(*words, "--frame", "3")
    assert refused.returncode == 65 and "frame 3" in refused.stderr and "frames 1 to 2" in refused.stderr
    assert not (folder / "out.nii.gz").exists()
    unsaid = kontur(*words)
    assert unsaid.returncode == 0 and "has 2 frames" in unsaid.stderr  # all have one grid


def test_of_an_image_that_cannot_be_read_the_grid_will_do(folder, ct):
    whole = gzip.decompress((folder / "ct.nii.gz").read_bytes())
    (folder / "ct.nii.gz").write_bytes(gzip.compress(whole[:5000]))
    segment(folder, *ct)
    report = json.loads((folder / "report.json").read_text())
    assert report["image"] == {"verdict": "none"}
    [warning] = report["warnings"]
    assert warning.startswith("the image was not used between the contours: ") and "ct.nii.gz" in warning
    assert dice(read_nifti(folder / "out.nii.gz"), ball_array()) > 0.995


def test_the_image_brings_ventricles_nearer_to_the_truth(tmp_path):
    contours = real_data("derived_nonparallel/lateral_ventricles/ortho3x3.json")
    brain = real_data("06_mr_brain_MRIcrop")
    truth = read_nifti(brain / "MRIcrop-seg.nii.gz") == 1
    found = {}
    for use in ("off", "auto"):
        segment(tmp_path, contours, "--image", brain / "MRIcrop-orig.nii.gz", "--output", f"{use}.nii.gz", "--use-image", use)
        found[use] = dice(read_nifti(tmp_path / f"{use}.nii.gz") > 0, truth)
    assert found["off"] > 0.84 and found["auto"] > found["off"] + 0.02


@pytest.mark.parametrize("structure", ["vertebral_body_L5label", "kidney_right_5mm"])
def test_a_real_structure_from_radial_planes(tmp_path, structure):
    data = real_data("derived_nonparallel") / structure
    truth = data / "truth.nii.gz"
    segment(tmp_path, data / "radial6.json", "--image", truth, "--output", "out.nii.gz")
    result = json.loads(kontur("compare", tmp_path / "out.nii.gz", truth, "--json").stdout)
    assert result["dice"] > 0.85


def test_a_real_structure_set(tmp_path):
    data = real_data("03_sarcoma_STS_002/CT")
    segment(tmp_path, data / "RTSTRUCT_RS.dcm", "--image", data / "image", "--output", "out.nii.gz")
    result = json.loads(kontur("compare", tmp_path / "out.nii.gz", data / "CT_mask.nii.gz", "--json").stdout)
    assert result["dice"] > 0.9
