// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/labels/painted_slices.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/grid.h"

namespace kontur {

struct SectionContourOptions {
    /// Standard deviation of the smoothing that takes the steps of the voxels out of an outline, in voxels of the slice.
    double smoothing_voxels = 0.7;
};

/// The outlines of a painted section as closed contours at sub-voxel positions, in the plane through the slice's voxel
/// centres: the 0.5 level of the section smoothed, on the grid lines between voxels inside and outside, so that contours
/// enclose exactly the voxel centres that were painted. `hole` is set on those around an outside region. A section that the
/// grid cuts off ends half a voxel beyond its outermost centres.
std::vector<Contour> section_contours(const Grid& grid, const PaintedSlice& slice,
                                      const SectionContourOptions& options = {});

/// The outlines of a mask on all its slices across k, the grid's k-th in the k-th's plane: where no function says where they
/// run.
ContourSet slice_outlines(const Mask& mask, const SectionContourOptions& options = {});

}  // namespace kontur
