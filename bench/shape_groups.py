# SPDX-License-Identifier: Apache-2.0
"""Groups of structures by their shape, measured on the mask alone: compact, elongated, thin or branched.

Two numbers decide. `elongation` is the ratio of the first two principal standard deviations. `fill` is the share of the volume
that the largest inscribed ball has, times the elongation: 1 for every ellipsoid of revolution about its long axis, about 0.8
for a straight tube, 0.5 for a cube, and the less, the more of the object lies in sheets, branches or bends.
"""
import numpy as np
from scipy import ndimage

LEAST_FILL, LEAST_ELONGATION = 0.2, 2.0


def inscribed_radius(mask, index_to_mm):
    """Of the largest ball inside; the distance to the nearest voxel outside, less the half of a voxel that is inside."""
    spacing = np.linalg.norm(index_to_mm[:3, :3], axis=0)
    return ndimage.distance_transform_edt(np.pad(mask, 1), spacing).max() - spacing.min() / 2


def measures(mask, index_to_mm):
    """(elongation, fill)."""
    points = np.argwhere(mask) @ index_to_mm[:3, :3].T
    spread = np.sqrt(np.linalg.eigvalsh(np.cov(points.T)))[::-1]
    elongation = spread[0] / spread[1]
    volume = mask.sum() * abs(np.linalg.det(index_to_mm[:3, :3]))
    return elongation, 4 / 3 * np.pi * inscribed_radius(mask, index_to_mm) ** 3 / volume * elongation


def group(mask, index_to_mm):
    elongation, fill = measures(mask, index_to_mm)
    if fill < LEAST_FILL:
        return "thin or branched"
    return "elongated" if elongation >= LEAST_ELONGATION else "compact"
