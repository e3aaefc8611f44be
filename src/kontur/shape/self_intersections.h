// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "kontur/shape/predicates.h"

namespace kontur {

/// Whether the points a, b, c of a polygon make a left turn. There are no ties: points on one line count as displaced by an
/// infinitesimal amount that depends on their indices alone (Edelsbrunner & Muecke 1990). So all answers agree. Contours
/// snapped to pixels do run through their own points and along their own segments.
bool is_left_turn(const Polygon2& polygon, std::size_t a, std::size_t b, std::size_t c);

/// The point of smallest first coordinate, after that displacement; surely a convex corner.
std::size_t extreme_point(const Polygon2& polygon);

/// A place where two parts of a closed polygon meet.
struct SelfIntersection {
    enum class Kind {
        crossing,  ///< one part passes through the other, be it in a common point or along a common stretch
        touch,     ///< they meet and part on the same side
        fold,      ///< the path turns and runs back on itself
    };
    Kind kind;
    Point2 position;            ///< for a stretch, a point of it
    std::size_t first, second;  ///< segments, from point i to point i + 1; first < second
};

struct SelfIntersections {
    std::vector<SelfIntersection> places;
    /// Of each segment how many others cross it, after the infinitesimal displacement: the side on which the inside lies
    /// (even-odd) changes along the segment if that is odd.
    std::vector<int> crossings_of_segment;
    /// A point on every stretch between two proper crossings that lie one after the other on the same segment. Together with
    /// the points of the polygon and its crossings they are on every edge of every lobe.
    std::vector<Point2> between_crossings;
};

/// All places where a closed polygon meets itself (paper section 5.1), decided exactly on the given coordinates, by a sweep
/// over the first coordinate: O(n log n) for n points of which few lie side by side. No point may repeat the one before it.
SelfIntersections find_self_intersections(const Polygon2& polygon);

}  // namespace kontur
