// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/labels/painted_slices.h"
#include "kontur/shape/grid.h"

namespace kontur {

/// Signed distance in mm of each voxel centre of a section from its outline, which runs half a voxel from the centres
/// beside it; positive inside, -infinity where nothing was painted. Linear in the voxels (Felzenszwalb and Huttenlocher,
/// Distance transforms of sampled functions, 2012).
std::vector<double> section_distances(const Grid& grid, const PaintedSlice& slice);

/// Shape-based interpolation between two parallel painted slices (Raya and Udupa 1990): the distances in both, averaged by
/// nearness, in mm and positive inside.
class ShapeInterpolation {
public:
    /// `low` and `high` lie across the same axis, `low` first. Distances are kept in single precision.
    ShapeInterpolation(const Grid& grid, const PaintedSlice& low, const PaintedSlice& high);

    /// At a voxel of a slice from `low` to `high`; `at` is the index in the grid. The distance from the interpolated surface
    /// in space, not in the slice: where the sections differ it is slanted, and so nearer.
    double depth_mm(const Index3& at) const;

    /// How far to trust it beside a fit, up to 1: the less, the farther apart the slices are for the thickness of the
    /// sections, because it knows no curvature across the slices.
    double trust() const;

private:
    int axis_;
    std::int64_t low_, high_, width_;
    double gap_mm_;
    std::vector<float> low_mm_, high_mm_;
};

}  // namespace kontur
