// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kontur/shape/contour.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// The voxels that contours drawn on the grid's slices (planes of constant k) enclose, slice by slice: a voxel belongs to
/// the mask when its centre lies inside an odd number of the slice's contours (even-odd; `hole` is not looked at). A centre
/// exactly on an edge belongs to one side only, the same for every contour that shares the edge. Nothing is interpolated
/// between slices, and what lies outside of the grid is cut off. Linear in voxels and in rows crossed by edges.
/// Throws Error(invalid_input), naming the contour (counted from 1), when it is open or a point lies more than half
/// a slice from the contour's slice or is not finite.
Mask rasterize(const ContourSet& contours, const Grid& grid);

/// Slices of constant k with voxels inside, and how many there are from the first of them to the last: contours of a slice
/// here and there are a drawing, not a mask. 0 and 0 for an empty mask.
struct FilledSlices {
    std::int64_t filled = 0, extent = 0;
};
FilledSlices filled_slices(const Mask& mask);

}  // namespace kontur
