# SPDX-License-Identifier: Apache-2.0
"""`kontur fill`, its peers, and the tables in which their results are written."""
import csv
import pathlib
import subprocess
import sys
import tempfile

import nibabel
import numpy as np

import slices
import structures

# The image that a structure was drawn on, by how its name begins.
IMAGES = {
    "sarcoma_STS_002": "03_sarcoma_STS_002/CT/image",
    "sarcoma_STS_040": "04_sarcoma_STS_040/CT/image",
    "sarcoma_STS_008": "05_sarcoma_STS_008/CT/image",
    "abdomen": "01_ct_abdomen_totalseg_3mm/example_ct_sm.nii.gz",
    "vertebrae": "01_ct_abdomen_totalseg_3mm/example_ct.nii.gz",
    "brain": "06_mr_brain_MRIcrop/MRIcrop-orig.nii.gz",
    "tumour_0": "07_mr_brain_tumour_brain1/brain1_image.nrrd",
    "cord": "13_mr_spinal_cord_t2/t2.nii.gz",
}


def filled_by(command, labels, ras):
    """The labels that a program writes: `command(sparse, full)` with the paths of the files."""
    with tempfile.TemporaryDirectory() as folder:
        sparse, full = pathlib.Path(folder, "sparse.nii"), pathlib.Path(folder, "full.nii")
        image = nibabel.Nifti1Image(labels, ras)
        image.set_sform(ras, 1)
        image.set_qform(None, 0)
        nibabel.save(image, sparse)
        subprocess.run(command(sparse, full), check=True)
        return np.asarray(nibabel.load(full).dataobj)


def filled(kontur, labels, affine, words=()):
    """The labels by `kontur fill`; a mask's are 0 and 1."""
    return filled_by(lambda sparse, full: [kontur, "fill", sparse, "--output", full, "--threads", "1", "--quiet", *words],
                     labels, structures.LPS @ affine)


def filled_by_itk(program, mask, affine, words=()):
    """On a grid of the same spacing with the patient's axes: ITK takes no other grid from a file, and its filter asks no more."""
    spacing = np.linalg.norm(affine[:3, :3], axis=0)
    return filled_by(lambda sparse, full: [program, sparse, full, *words], mask, np.diag([*spacing, 1])) > 0


def sparse_map(truth, kept):
    """The mask with the kept slices alone, 0 and 1."""
    sparse = np.zeros(truth.shape, np.uint8)
    sparse[:, :, kept] = truth[:, :, kept]
    return sparse


def image_of(name, data):
    """The image of a structure; None without one."""
    found = [data / file for start, file in IMAGES.items() if name.startswith(start) and (data / file).exists()]
    return found[0] if found else None


def methods(options, name):
    """{method: make(truth, affine, kept)}; a mask each."""
    found = {"shape-based": lambda truth, affine, kept: slices.shape_based(truth, kept, np.linalg.norm(affine[:3, :3], axis=0))}
    for words in ("", "--dilations") if options.itk else ():
        found[f"ITK {words}".strip()] = lambda truth, affine, kept, words=words: filled_by_itk(
            options.itk, sparse_map(truth, kept), affine, words.split())
    choices = {words: words.split() for words in options.words or [""]}
    if options.images:
        choices["--use-image auto"] = ["--image", image_of(name, options.data), "--use-image", "auto"]
    for words, given in choices.items():
        found[f"kontur fill {words}".strip()] = lambda truth, affine, kept, given=given: filled(
            options.kontur, sparse_map(truth, kept), affine, given) > 0
    return found


def written(path, fields, measurements):
    """All rows, each written as it comes. A measurement: what it was of, and its rows."""
    rows = []
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(fields)
        for name, more in measurements:
            rows += more
            table.writerows(more)
            file.flush()
            print(f"measured {name}", file=sys.stderr)
    return rows
