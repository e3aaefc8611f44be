// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/field/constraints.h"

namespace kontur {

struct PrepareOptions {
    double quality = 1.0;  ///< fraction of each contour's points to keep (reduce), in (0, 1]
    bool refine = true;    ///< subdivide segments longer than twice their contour's average
};

/// The contours as the fit sees them.
struct PreparedContours {
    std::vector<BoundaryPoint> points;
    std::vector<Vec3> crossings;   ///< mm, where contours cross themselves
    std::size_t added_copies = 0;  ///< 1 when coplanar input got a shifted copy of its first contour
};

/// Reduces, refines and orients every contour. When all contours lie in one plane (within 1e-6 of the set's size) the fit
/// would degenerate to that plane, so a copy of the first contour is added, shifted along the plane's normal by
/// `copy_shift_mm` (paper section 3.1).
PreparedContours prepare(const ContourSet& set, const PrepareOptions& options, double copy_shift_mm);

/// Half the median distance between neighbouring points over all contours, in mm: the scale below which the contours say
/// nothing about the surface. 0 for an empty set.
double half_point_spacing_mm(const ContourSet& set);

}  // namespace kontur
