# SPDX-License-Identifier: Apache-2.0
"""Parallel slices: some of an object's slices kept, drawings of them, and what a slice-by-slice method makes of them.

A slice is a layer of voxels along a grid's third axis. Its plane passes through the voxels' centres.
"""
import numpy as np
from scipy import ndimage

from structures import plane

STEPS = (2, 4, 8)


def occupied(mask):
    return np.flatnonzero(mask.any(axis=(0, 1)))


def kept(mask, step, start=0):
    """Every `step`-th slice from the first that the object is in, or from `start` after it; nothing if that leaves one alone."""
    slices = occupied(mask)
    some = slices[(slices - slices[0]) % step == start]
    return some if len(some) > 1 else some[:0]


def slice_planes(slices, index_to_mm):
    """Planes through slices; u runs along the first axis of the grid, which may be sheared."""
    normal = np.cross(index_to_mm[:3, 0], index_to_mm[:3, 1])
    return [plane(index_to_mm[:3, :3] @ (0, 0, k) + index_to_mm[:3, 3], normal) for k in map(int, slices)]


def slice_numbers(planes, index_to_mm):
    """In which slice each plane lies, as a real number."""
    origins = np.array([p["origin"] for p in planes])
    normal = np.cross(index_to_mm[:3, 0], index_to_mm[:3, 1])
    return (origins - index_to_mm[:3, 3]) @ normal / (index_to_mm[:3, 2] @ normal)


def filled(contours, shape):
    """Voxels of one slice whose centres lie in contours by the even-odd rule; contours are in voxels of the slice, centres
    being whole numbers."""
    toggles = np.zeros((shape[0], shape[1] + 1), int)
    for contour in contours:
        for (x0, y0), (x1, y1) in zip(contour, np.roll(contour, -1, axis=0)):
            low, high = sorted((x0, x1))
            rows = np.arange(max(np.ceil(low), 0), min(np.ceil(high), shape[0])).astype(int)  # half-open: each end counts once
            across = y0 + (rows - x0) / (x1 - x0) * (y1 - y0) if len(rows) else rows
            toggles[rows, np.clip(np.ceil(across), 0, shape[1]).astype(int)] += 1
    return np.cumsum(toggles, axis=1)[:, :-1] % 2 == 1


def signed_distance(section, spacing):
    """To the outline of a section in its plane, mm, positive inside; voxels beside the outline are half a voxel from it."""
    if not section.any():
        return np.full(section.shape, -np.inf)
    inside = ndimage.distance_transform_edt(np.pad(section, 1), spacing)[1:-1, 1:-1]
    outside = ndimage.distance_transform_edt(~section, spacing)
    return np.where(section, inside - min(spacing) / 2, min(spacing) / 2 - outside)


def shape_based(mask, slices, spacing):
    """The shape-based interpolation of Raya and Udupa (1990): between two kept slices the signed distances in both, averaged by
    the nearness, are positive. Beyond the first and the last it says nothing, and nothing is filled."""
    result = np.zeros_like(mask)
    distances = {k: signed_distance(mask[:, :, k], spacing[:2]) for k in slices}
    for low, high in zip(slices, slices[1:]):
        for k in range(low, high + 1):
            along = (k - low) / (high - low)
            with np.errstate(invalid="ignore"):  # nowhere times 0
                mean = distances[low] if along == 0 else distances[high] if along == 1 else (
                    (1 - along) * distances[low] + along * distances[high])
            result[:, :, k] = mean > 0
    return result


def repeated(mask, slices, spacing):
    """The simplest: every slice is the nearest kept one, the lower of two that are as near."""
    result = np.zeros_like(mask)
    for k in range(slices[0], slices[-1] + 1):
        result[:, :, k] = mask[:, :, slices[np.abs(slices - k).argmin()]]
    return result
