# SPDX-License-Identifier: Apache-2.0
"""Structures that touch each other, filled together and each alone.

Slices a few mm apart are kept of some labels of real scans. Printed are, for each case and way, which share of the band around the
borders that two labels share (two voxels to either side) is wrong, which share of it has no label, and Dice, its mean and that of
each label. The labels are smoothed first by 0.7 voxels, as annotators do not draw steps.
"""
import numpy as np
from scipy import ndimage

import structures
from filling.methods import filled

CASES = [
    ("ventricles, caudates, callosum, axial", "06_mr_brain_MRIcrop/MRIcrop-seg.nii.gz", [1, 7, 8], 2, (3, 4, 5, 7)),
    ("the same, coronal", "06_mr_brain_MRIcrop/MRIcrop-seg.nii.gz", [1, 7, 8], 1, (3, 4, 7)),
    ("the same, sagittal", "06_mr_brain_MRIcrop/MRIcrop-seg.nii.gz", [1, 7, 8], 0, (3, 5, 7)),
    ("vertebrae L3 to L5, sagittal", "01_ct_abdomen_totalseg_3mm/vertebrae_on_example_ct.nii.gz", [27, 28, 29], 0, (6, 9)),
    ("liver, kidney, gallbladder, stomach, axial", "02_ct_abdomen_torsoLabel_5mm/torsoLabel.nii.gz", [6, 2, 4, 7], 2, (10, 20)),
]
WAYS = {"alone": ["--alone"], "together": []}


def smoothed(labels, chosen):
    """Each voxel's label is the one with most around it, weighted by a Gaussian of 0.7 voxels; all others count as none."""
    near = [ndimage.gaussian_filter((labels == label).astype(np.float32), 0.7) for label in chosen]
    near.append(ndimage.gaussian_filter((~np.isin(labels, chosen)).astype(np.float32), 0.7))
    return np.array([*chosen, 0], np.int16)[np.argmax(near, axis=0)]


def kept(labels, axis, spacing, step_mm):
    """Indices of the slices that stay."""
    occupied = np.flatnonzero(labels.any(axis=tuple({0, 1, 2} - {axis})))
    at = np.round(np.arange(occupied[0] + 1, occupied[-1], max(1, step_mm / spacing[axis]))).astype(int)
    sparse = np.zeros_like(labels)
    index = [slice(None)] * 3
    index[axis] = at
    sparse[tuple(index)] = labels[tuple(index)]
    return sparse


def border_band(labels):
    band = np.zeros(labels.shape, bool)
    for axis in range(3):
        low, high = ([slice(None)] * 3 for _ in range(2))
        low[axis], high[axis] = slice(None, -1), slice(1, None)
        a, b = labels[tuple(low)], labels[tuple(high)]
        meet = (a != b) & (a > 0) & (b > 0)
        band[tuple(low)] |= meet
        band[tuple(high)] |= meet
    return ndimage.binary_dilation(band) & (labels > 0)


def dice(a, b):
    return 2 * (a & b).sum() / (a.sum() + b.sum())


def add_arguments(parser):
    parser.add_argument("--cases", type=int, default=len(CASES), help="only the first so many")


def run(options):
    print("| structures | slices | way | wrong in the band | without a label | mean Dice | Dice |\n|---|--:|---|--:|--:|--:|---|")
    for name, file, chosen, axis, steps in CASES[:options.cases]:
        labels, affine = structures.read_labels(options.data / file, options.kontur)
        labels = smoothed(labels, chosen)
        spacing = np.linalg.norm(affine[:3, :3], axis=0)
        band = border_band(labels)
        for step in steps:
            sparse = kept(labels, axis, spacing, step)
            for way, words in WAYS.items():
                full = filled(options.kontur, sparse, affine, words)
                each = [dice(full == label, labels == label) for label in chosen]
                print(f"| {name} | {step} mm | {way} | {np.mean(full[band] != labels[band]):.3f} | {np.mean(full[band] == 0):.3f} | "
                      f"{np.mean(each):.4f} | {' '.join(f'{d:.4f}' for d in each)} |", flush=True)
