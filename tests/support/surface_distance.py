# SPDX-License-Identifier: Apache-2.0
"""Surface distances of two masks by SciPy's distance transform: surface_distance.py A B I J K SPACING_I SPACING_J SPACING_K

A and B hold one byte per voxel, i fastest. Prints the Hausdorff distance, its 95 % form and the mean surface distance.
"""

import sys

import numpy as np
from scipy import ndimage


def surface(name, shape):
    inside = np.fromfile(name, np.uint8).reshape(shape) != 0
    return inside & ~ndimage.binary_erosion(inside, border_value=0)


size = [int(text) for text in sys.argv[3:6]]
spacing = [float(text) for text in sys.argv[6:9]]
a, b = (surface(name, size[::-1]) for name in sys.argv[1:3])
to_a, to_b = (ndimage.distance_transform_edt(~s, sampling=spacing[::-1]) for s in (a, b))
forward, backward = to_b[a], to_a[b]
both = np.concatenate([forward, backward])
print(both.max(), max(np.percentile(forward, 95), np.percentile(backward, 95)), both.mean())
