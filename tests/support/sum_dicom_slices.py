# SPDX-License-Identifier: Apache-2.0
"""Prints, for each slice of the DICOM series in a folder in the order of position, the sum of its rescaled values."""

import sys
from pathlib import Path

import numpy as np
import pydicom

slices = []
for path in Path(sys.argv[1]).iterdir():
    d = pydicom.dcmread(path)
    orientation = np.array([float(v) for v in d.ImageOrientationPatient])
    position = np.array([float(v) for v in d.ImagePositionPatient])
    values = d.pixel_array.astype(float) * float(d.get("RescaleSlope", 1)) + float(d.get("RescaleIntercept", 0))
    slices.append((float(np.cross(orientation[:3], orientation[3:]) @ position), values.sum()))
for _, total in sorted(slices):
    print(repr(float(total)))
