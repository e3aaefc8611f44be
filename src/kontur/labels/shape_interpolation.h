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
/// nearness, in mm and positive inside. The less the sections overlap, the more they are moved over each other first, as a
/// steep vessel's are: by their centroids' way, times `apartness`. Nothing moves where one lies within the other.
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

    /// The share of the smaller section that the other one does not cover, from 0 to 1; less where the room between them is
    /// more than half as wide as the thinner one, and 0 from one and a half of its widths on: these are two bodies. At 1 a
    /// fit knows of no way from one to the other.
    double apartness() const { return apartness_; }

private:
    void move(const PaintedSlice& low, const PaintedSlice& high);
    double sampled(const std::vector<float>& distances_mm, double a, double b) const;

    int axis_;
    std::int64_t low_, high_, width_, height_;
    double gap_mm_, step_u_mm_, step_v_mm_;
    double apartness_ = 0;
    double way_u_ = 0, way_v_ = 0;  ///< of the lower section onto the upper one, in voxels
    std::vector<float> low_mm_, high_mm_;
};

}  // namespace kontur
