# SPDX-License-Identifier: Apache-2.0
"""What Python makes and what the command line makes are the same bytes."""
import hashlib
import os
import subprocess

import kontur
import pytest


def sha256(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def command_line(*words):
    subprocess.run([os.environ["KONTUR_CLI"], *map(str, words)], check=True, capture_output=True, timeout=400)


@pytest.mark.parametrize(
    "name, options, words",
    [
        ("kidney_radial6", {}, []),
        ("metastasis_parallel7_hand", {"quality": 0.5}, ["--quality", "0.5"]),
        ("self_intersecting", {"normals": "in-plane", "solver": "dense", "normal_offset_mm": 1},
         ["--normals", "in-plane", "--solver", "dense", "--normal-offset-mm", "1"]),
    ],
)
def test_the_same_bytes_as_the_command_line(tmp_path, name, options, words):
    case = kontur.phantom_case(name)
    kontur.write_contours(tmp_path / "contours.json", case.contours)
    kontur.write_image(tmp_path / "image.nrrd", kontur.make_phantom_image(case.grid))
    contours, image = kontur.read_contours(tmp_path / "contours.json"), kontur.read_image(tmp_path / "image.nrrd")
    result = kontur.segment(contours, image.grid, image=image, mesh=True, **options)
    made = kontur.provenance(contours, image.grid, result.report) | {
        "contour_files_sha256": sha256(tmp_path / "contours.json"),
        "image_sha256": sha256(tmp_path / "image.nrrd"),
    }
    for mask, mesh in (("m.nii.gz", "m.stl"), ("m.nrrd", "m.ply"), ("m.mha", "m.obj")):
        command_line("segment", tmp_path / "contours.json", "--image", tmp_path / "image.nrrd",
                     "--output", tmp_path / mask, "--mesh", tmp_path / mesh, *words)
        kontur.write_mask(tmp_path / f"python_{mask}", result.mask, provenance=made)
        kontur.write_mesh(tmp_path / f"python_{mesh}", result.mesh, provenance=made)
        for file in (mask, mesh):
            assert (tmp_path / f"python_{file}").read_bytes() == (tmp_path / file).read_bytes(), file


def test_tracing_gives_the_same_bytes(tmp_path, case, kidney):
    kontur.write_mask(tmp_path / "mask.nii.gz", kidney.mask)
    kontur.write_contours(tmp_path / "planes.json", case.contours)
    command_line("trace", tmp_path / "mask.nii.gz", "--planes", tmp_path / "planes.json", "--output", tmp_path / "a.json")
    mask = kontur.read_mask(tmp_path / "mask.nii.gz")
    planes = kontur.read_planes_json(tmp_path / "planes.json")
    made = kontur.StructureAttributes(generation_algorithm="SEMIAUTOMATIC")
    contours = kontur.ContourSet(kontur.trace(mask, planes).contours, attributes=made)
    kontur.write_contours(tmp_path / "b.json", contours, provenance={
        "made_by": "kontur trace",
        "mask_sha256": sha256(tmp_path / "mask.nii.gz"),
        "planes_sha256": sha256(tmp_path / "planes.json"),
        "version": kontur.__version__,
        "options": "step_mm=0 tolerance_mm=1e-06 min_area_mm2=0",
    })
    assert (tmp_path / "a.json").read_bytes() == (tmp_path / "b.json").read_bytes()
