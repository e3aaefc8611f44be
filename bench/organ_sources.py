# SPDX-License-Identifier: Apache-2.0
"""Where organs.py finds structures: label maps and real structure sets in a folder of scans laid out as below.

Whatever of it is not there is left out, which is said.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import plain
import slices
import structures

LABEL_MAPS = {
    "abdomen": "01_ct_abdomen_totalseg_3mm/example_seg.nii.gz",
    "vertebrae": "01_ct_abdomen_totalseg_3mm/vertebrae_on_example_ct.nii.gz",
    "bodies/parts": "01_ct_abdomen_totalseg_3mm/vertebral_bodies_on_example_ct.nii.gz",
    "torso": "02_ct_abdomen_torsoLabel_5mm/torsoLabel.nii.gz",
    "brain": "06_mr_brain_MRIcrop/MRIcrop-seg.nii.gz",
    "tumour/parts": "07_mr_brain_tumour_brain1/brain1_label.nrrd",
    "lung": "07_mr_brain_tumour_brain1/lung1_label.nrrd",
    "spine/parts": "08_spine_vertebral_bodies/vb-seg.mha",
    "insert": "12_ct_head_gantry_tilt_shear/shear_insert_threshold_mask.nii.gz",
    "cord": "13_mr_spinal_cord_t2/t2_seg-manual.nii.gz",
    "levels": "13_mr_spinal_cord_t2/t2_seg-manual_labeled.nii.gz",
}
# What kontur was developed on (derived_nonparallel), and vertebrae that another map has whole.
WITHOUT = {"torso_002", "torso_006", "brain_001", "brain_005", "spine_005_1", "abdomen_030", "abdomen_031", "abdomen_032"}
# Structure set, ROI, and its mask where there is one; else its contours are filled on voxels of 1 x 1 mm on the drawn slices.
STRUCTURE_SETS = {
    "sarcoma_STS_002": ("03_sarcoma_STS_002/CT/RTSTRUCT_RS.dcm", "1", "03_sarcoma_STS_002/CT/CT_mask.nii.gz"),
    "sarcoma_STS_040": ("04_sarcoma_STS_040/CT/RTSTRUCT_RS.dcm", "1", "04_sarcoma_STS_040/CT/CT_mask.nii.gz"),
    "sarcoma_STS_008": ("05_sarcoma_STS_008/CT/RTSTRUCT_RS.dcm", "1", "05_sarcoma_STS_008/CT/CT_mask.nii.gz"),
    "breast": ("09_rtstruct_breast_dicompyler/rtss.dcm", "Breast", None),
    "heart": ("09_rtstruct_breast_dicompyler/rtss.dcm", "Heart", None),
    "left_lung": ("09_rtstruct_breast_dicompyler/rtss.dcm", "Lt Lung", None),
    "tumour_bed": ("09_rtstruct_breast_dicompyler/rtss.dcm", "Tumor Bed", None),
}
# Short-axis contours of a left ventricle: (phase, kind) of the contours, and their mask.
CINE = "10_cine_mr_SC-HF-I-1"
CINE_CONTOURS = {"ventricle_ED_endo": (18, "endo"), "ventricle_ES_endo": (7, "endo"), "ventricle_ED_epi": (18, "epi")}
# What structures were drawn on, by the beginning of their names, and its frame, from 1, where it has several.
IMAGES = {
    "abdomen_": ("01_ct_abdomen_totalseg_3mm/example_ct_sm.nii.gz", None),
    "vertebrae_": ("01_ct_abdomen_totalseg_3mm/example_ct.nii.gz", None),
    "bodies_": ("01_ct_abdomen_totalseg_3mm/example_ct.nii.gz", None),
    "brain_": ("06_mr_brain_MRIcrop/MRIcrop-orig.nii.gz", None),
    "tumour_0": ("07_mr_brain_tumour_brain1/brain1_image.nrrd", None),
    "cord": ("13_mr_spinal_cord_t2/t2.nii.gz", None),
    "levels": ("13_mr_spinal_cord_t2/t2.nii.gz", None),
    "sarcoma_STS_002": ("03_sarcoma_STS_002/CT/image", None),
    "sarcoma_STS_040": ("04_sarcoma_STS_040/CT/image", None),
    "sarcoma_STS_008": ("05_sarcoma_STS_008/CT/image", None),
    "ventricle_ED": (CINE + "/cine4d_crop.nii.gz", 19),
    "ventricle_ES": (CINE + "/cine4d_crop.nii.gz", 8),
}


def present(path):
    if not path.exists():
        print(f"organs.py: {path} is not there and left out", file=sys.stderr)
    return path.exists()


def label_maps(data, kontur):
    """{structure: (mask, affine, file)}, sorted by name."""
    maps = [f"{name}={data / file}" for name, file in LABEL_MAPS.items() if present(data / file)]
    found = structures.collect(maps, [], kontur)
    return {name: entry for name, entry in found.items() if name not in WITHOUT}


def image_of(structure, data):
    """(file, frame or None) of what a structure was drawn on; None where there is no such image."""
    for beginning, (file, frame) in IMAGES.items():
        if structure.startswith(beginning) and present(data / file):
            return data / file, frame
    return None


def read_planes(file, roi, kontur):
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder, "contours.json")
        subprocess.run([kontur, "convert", file, copy, "--roi", roi, "--quiet"], check=True)
        return [plane for plane in json.loads(copy.read_text())["planes"] if plane["contours"]]


def own_grid(planes):
    """Voxels of 1 x 1 mm, and in z as far apart as most of the planes are; shape and affine."""
    points = np.array([point for plane in planes for contour in plane["contours"] for point in contour["points"]])
    heights = np.array(sorted(plane["origin"][2] for plane in planes))
    apart = np.median(np.diff(heights))
    low, high = points.min(axis=0) - 2, points.max(axis=0) + 2
    shape = (*np.ceil(high - low)[:2].astype(int), round((heights[-1] - heights[0]) / apart) + 1)
    affine = np.diag([1, 1, apart, 1.0])
    affine[:3, 3] = *low[:2], heights[0]
    return shape, affine


def mask_of(planes, shape, affine):
    """The contours of each plane filled in the nearest slice."""
    mask = np.zeros(shape, bool)
    to_index = np.linalg.inv(affine)
    for plane, number in zip(planes, np.rint(slices.slice_numbers(planes, affine)).astype(int)):
        contours = [(np.array(c["points"]) @ to_index[:3, :3].T + to_index[:3, 3])[:, :2] for c in plane["contours"]]
        mask[:, :, number] ^= slices.filled(contours, shape[:2])
    return mask


def cine_planes(contours, affine):
    """Planes of the slices, in the image's frame; the contours lie in them as far as rounding lets them."""
    planes = slices.slice_planes(sorted({contour["slice"] for contour in contours}), affine)
    for plane, contour in zip(planes, sorted(contours, key=lambda contour: contour["slice"])):
        offset = np.array(contour["points"]) - plane["origin"]
        flat = np.array(contour["points"]) - np.outer(offset @ plane["normal"], plane["normal"])
        plane["contours"] = [{"closed": True, "hole": False, "points": flat.tolist()}]
    return planes


def structure_sets(data, kontur):
    """{structure: (mask, affine, file, planes with the contours drawn)}."""
    found = {}
    for name, (file, roi, mask_file) in STRUCTURE_SETS.items():
        if present(data / file):
            planes = read_planes(data / file, roi, kontur)
            if mask_file:
                mask, affine = plain.read_truth(data / mask_file)
            else:
                shape, affine = own_grid(planes)
                mask = mask_of(planes, shape, affine)
            found[name] = (mask, affine, file, planes)
    cine = data / CINE / "contours_lps.json"
    if present(cine):
        drawn = json.loads(cine.read_text())["contours"]
        for name, (phase, kind) in CINE_CONTOURS.items():
            mask_file = f"{CINE}/mask_{name.removeprefix('ventricle_')}.nii.gz"
            mask, affine = plain.read_truth(data / mask_file)
            own = [contour for contour in drawn if (contour["phase"], contour["kind"]) == (phase, kind)]
            found[name] = (mask, affine, mask_file, cine_planes(own, affine))
    return found
