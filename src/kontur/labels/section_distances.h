// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/labels/painted_slices.h"
#include "kontur/shape/grid.h"

namespace kontur {

/// A part of a slice, or all of it: 1 where it was painted; the first axis, u, is fastest.
struct SectionVoxels {
    std::vector<std::uint8_t> set;
    std::int64_t width = 0;
    double step_u_mm = 1, step_v_mm = 1;
};

/// Signed distance in mm of each voxel centre of a section from its outline, which runs half a voxel from the centres
/// beside it; positive inside, -infinity where nothing was painted. Linear in the voxels (Felzenszwalb and Huttenlocher,
/// Distance transforms of sampled functions, 2012).
std::vector<double> section_distances(const SectionVoxels& section);
std::vector<double> section_distances(const Grid& grid, const PaintedSlice& slice);

/// Distances in a rectangle of a slice, in single precision.
struct SectionField {
    std::int64_t left = 0, bottom = 0;  ///< the slice's indices of the first voxel
    std::int64_t width = 0, height = 0;
    double step_u_mm = 1, step_v_mm = 1;
    std::vector<float> mm;

    /// Between voxels, by indices of the slice; beyond the rectangle less than at its rim by the distance from it.
    double at(double u, double v) const;
    /// Half of the thickness where the section is thickest.
    double thickest_mm() const;
};

}  // namespace kontur
