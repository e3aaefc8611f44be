// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "kontur/drawing/boundary_point.h"

namespace kontur {

/// Whether a point goes on from the one before it along the same line. The contours' numbers need not be in order, a contour
/// may have several stretches (its lid is one), and single points belong to none.
inline bool follows(std::span<const BoundaryPoint> points, std::size_t i) {
    return i > 0 && points[i].contour != kNoContour && points[i].contour == points[i - 1].contour;
}

}  // namespace kontur
