#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Images and masks of left ventricles, of the Sunnybrook cases as github.com/kwu93/image-segmentation has them.

Usage: bench/ventricles.py FINAL_DATA OUTPUT

FINAL_DATA has link.csv, dicoms/CASE/N.dcm and contourfiles/PATIENT/*-contours/IM-0001-N-{i,o}contour-manual.txt, N counted through
20 phases of one slice, then of the next. For every phase with contours: OUTPUT/PATIENT_PHASE_image.nii.gz, and the inner (endo) and
outer (epi) contours filled at pixel centres.
"""
import csv
import pathlib
import re
import sys

import nibabel
import numpy as np
import pydicom

import slices

PHASES = 20
LPS = np.diag([-1.0, -1.0, 1.0, 1.0])


def affine_of(first, last, count):
    """From indices (column, row, slice) to LPS mm."""
    affine = np.eye(4)
    down, across = map(float, first.PixelSpacing)
    affine[:3, 0] = np.array(first.ImageOrientationPatient[:3], float) * across
    affine[:3, 1] = np.array(first.ImageOrientationPatient[3:], float) * down
    start, end = (np.array(d.ImagePositionPatient, float) for d in (first, last))
    affine[:3, 2], affine[:3, 3] = (end - start) / (count - 1), start
    return affine


def save(path, values, affine):
    image = nibabel.Nifti1Image(values, LPS @ affine)
    image.set_sform(LPS @ affine, 1)
    image.set_qform(LPS @ affine, 1)
    nibabel.save(image, path)


def contours_of(folder):
    """{(wall, phase): {N: points in pixels}}."""
    found = {}
    for file in sorted(folder.rglob("*contour-manual.txt")):
        number, wall = re.match(r"IM-0001-(\d+)-([io])contour", file.name).groups()
        key = ("endo" if wall == "i" else "epi", (int(number) - 1) % PHASES)
        found.setdefault(key, {})[int(number)] = np.loadtxt(file)
    return found


def write(patient, dicoms, contours, output):
    files = {int(file.stem): pydicom.dcmread(file) for file in dicoms.glob("*.dcm")}
    for (wall, phase), drawn in contours.items():
        stack = sorted(n for n in files if (n - 1) % PHASES == phase)
        affine = affine_of(files[stack[0]], files[stack[-1]], len(stack))
        image = np.stack([files[n].pixel_array.T for n in stack], axis=2).astype(np.int16)
        mask = np.zeros(image.shape, np.uint8)
        for n, points in drawn.items():
            mask[:, :, stack.index(n)] = slices.filled([points], image.shape[:2])
        save(output / f"{patient}_{phase:02d}_image.nii.gz", image, affine)
        save(output / f"{patient}_{phase:02d}_{wall}.nii.gz", mask, affine)


def main():
    data, output = map(pathlib.Path, sys.argv[1:])
    output.mkdir(parents=True, exist_ok=True)
    with open(data / "link.csv", newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            patient = row["original_id"]
            write(patient, data / "dicoms" / row["patient_id"], contours_of(data / "contourfiles" / patient), output)


if __name__ == "__main__":
    main()
