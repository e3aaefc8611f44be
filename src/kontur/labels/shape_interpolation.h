// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/labels/painted_slices.h"
#include "kontur/labels/section_distances.h"
#include "kontur/labels/strands.h"
#include "kontur/shape/grid.h"

namespace kontur {

/// Shape-based interpolation between two parallel painted slices (Raya and Udupa 1990): the distances in both, averaged by
/// nearness, in mm and positive inside. Parts that lie beside each other, as a steep vessel's do, are moved over each other
/// first (see Strand).
class ShapeInterpolation {
public:
    struct Depth {
        double mm = 0;
        double belief = 0;  ///< 1 in both sections; else the strand's in which the voxel lies: at 1 a fit knows of no way
    };

    /// `low` and `high` lie across the same axis, `low` first. Distances are kept in single precision.
    ShapeInterpolation(const Grid& grid, const PaintedSlice& low, const PaintedSlice& high);

    /// At a voxel of a slice between `low` and `high`; `at` is the index in the grid. The distance from the interpolated
    /// surface in space, not in the slice: where the sections differ it is slanted, and so nearer.
    Depth depth(const Index3& at) const;

    /// How far to trust it beside a fit, up to 1: the less, the farther apart the slices are for the thickness of the
    /// sections, because it knows no curvature across the slices.
    double trust() const;

private:
    int axis_;
    std::int64_t low_, high_;
    double gap_mm_, thickness_mm_;
    std::vector<Strand> strands_;
    bool is_all_strands_;
    SectionField low_mm_, high_mm_;  ///< without the strands, where something else was painted
};

}  // namespace kontur
