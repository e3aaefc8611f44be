// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/shape/volume.h"

namespace kontur {

/// A raster laid on a plane: the centre of pixel (column, row) lies at `plane.from_uv(column * pixel_mm, row * pixel_mm)`,
/// so `u` runs to the right of the screen and `v` down. Pixels are square unless `row_mm` says otherwise.
struct Reslice {
    Plane plane;
    int width = 0;
    int height = 0;
    double pixel_mm = 1;
    double row_mm = 0;  ///< from row to row; 0: as from column to column
};

/// The raster with its middle at `plane.origin`.
Reslice centered_reslice(const Plane& plane, int width, int height, double pixel_mm);

/// The image on the raster: width * height trilinear samples, row after row; `outside` beyond the outermost voxel centres
/// by more than half a voxel, as `interpolate` has it. Right for oblique, sheared and left-handed grids.
/// Throws Error(invalid_input) for a raster of no pixels, a pixel size that is not > 0, or an image that check_image
/// refuses, and Error(too_large) above 2^28 pixels.
std::vector<float> reslice(const Image& image, const Reslice& raster, float outside);

}  // namespace kontur
