# SPDX-License-Identifier: Apache-2.0
"""A CT of a planner's patient: a body with a tumour in the middle of the image, 25 mm below the skin, and a cord beside it.

python3 make_patient.py FOLDER    # FOLDER/dicom gets the slices
"""
import pathlib
import sys

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))
import make_dicom_series as series

SIZE, PIXEL_MM, SLICES, STEP_MM = 128, 3.0, 40, 4.0
TUMOUR_MM, CORD_MM = 18, 8
CORD_AT_MM = (-38, 0)  # x and y; it runs along z
BODY_AT_MM, BODY_MM = (-40, 85), (150, 110)


def values(z):
    """In HU; x and y from the middle of the image."""
    y, x = (numpy.mgrid[:SIZE, :SIZE] - (SIZE - 1) / 2) * PIXEL_MM
    body = ((x - BODY_AT_MM[0]) / BODY_MM[0]) ** 2 + ((y - BODY_AT_MM[1]) / BODY_MM[1]) ** 2 < 1
    hu = numpy.where(body, 20, -1000)
    hu[x**2 + y**2 + z**2 < TUMOUR_MM**2] = 90
    hu[(x - CORD_AT_MM[0]) ** 2 + (y - CORD_AT_MM[1]) ** 2 < CORD_MM**2] = 200
    return hu + numpy.random.default_rng(int(z + 1000)).normal(0, 8, hu.shape).astype(int)


def make(folder):
    target = folder / "dicom"
    target.mkdir()
    for n in range(SLICES):
        z = (n - (SLICES - 1) / 2) * STEP_MM
        d = series.new_slice("patient", f"slice{n}")
        d.Rows = d.Columns = SIZE
        d.PixelSpacing, d.SliceThickness, d.InstanceNumber = [PIXEL_MM, PIXEL_MM], STEP_MM, n + 1
        corner = -(SIZE - 1) / 2 * PIXEL_MM
        series.place(d, [1, 0, 0, 0, 1, 0], [corner, corner, z])
        series.set_pixels(d, values(z) + 1024)
        d.save_as(target / f"slice{n:03}.dcm", write_like_original=False)


if __name__ == "__main__":
    make(pathlib.Path(sys.argv[1]))
