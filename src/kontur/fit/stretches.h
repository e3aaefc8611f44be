// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kontur/drawing/boundary_point.h"

namespace kontur {

/// Whether a point goes on from the one before it along the same line. The contours' numbers need not be in order, and
/// single points belong to none.
inline bool follows(std::span<const BoundaryPoint> points, std::size_t i) {
    return i > 0 && points[i].contour != kNoContour && points[i].contour == points[i - 1].contour &&
           points[i].line == points[i - 1].line;
}

/// Points [begin, end) that follow each other; a single point is one of its own.
struct Stretch {
    std::size_t begin, end;
    bool is_ring;
};

inline std::vector<Stretch> stretches(std::span<const BoundaryPoint> points) {
    std::vector<Stretch> all;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!follows(points, i)) all.push_back({i, i, points[i].on_ring});
        all.back().end = i + 1;
    }
    return all;
}

}  // namespace kontur
