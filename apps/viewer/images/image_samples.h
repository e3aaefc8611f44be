// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "kontur/view/reslice.h"

namespace kontur::viewer {

/// Which samples of an image tell all of it that a raster of the screen shows: where that is finer than the image, fewer
/// than the raster has pixels.
struct ImageSamples {
    Reslice raster;
    // In pixels of the screen's raster, column and row: where the first sample lies, and from one to the next.
    std::array<double, 2> first{}, step{1, 1};

    /// So many times fewer than the screen's pixels they are.
    double pixels_per_sample() const { return step[0] * step[1]; }
};

/// Along a direction of the screen that follows an axis of the grid the samples are the voxels; along others they lie half
/// as far apart as the voxels' planes are crossed. Interpolated linearly along both they give what `reslice` gives for the
/// screen's raster: along axes to rounding, else but for a tenth of what neighbouring voxels differ by. Where the
/// screen is as coarse as the image, or coarser, they are its pixels.
ImageSamples samples_for(const Grid& grid, const Reslice& screen);

}  // namespace kontur::viewer
