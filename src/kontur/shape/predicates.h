// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace kontur {

/// Coordinates in a plane, in mm.
using Point2 = std::array<double, 2>;
using Polygon2 = std::vector<Point2>;

/// Calls `visit` with the ends of each edge of a closed polygon, first those of the edge that leads to its first point.
template <class Points, class Visit>
void for_each_edge(const Points& polygon, const Visit& visit) {
    for (std::size_t i = 0, before = polygon.size() - 1; i < polygon.size(); before = i++)
        visit(polygon[before], polygon[i]);
}

/// +1 when a, b, c make a left turn, -1 for a right turn, 0 when they lie on one line. Exact for the given finite doubles:
/// evaluated in floating point where its error bound allows, else in integers.
int orientation(const Point2& a, const Point2& b, const Point2& c);

/// Whether p lies on the closed segment from a to b. Exact.
bool is_on_segment(const Point2& a, const Point2& b, const Point2& p);

/// Whether p lies inside of a closed polygon by the even-odd rule. Exact; a point on the outline counts as inside for one of
/// two polygons that share this outline, and as outside for the other.
bool is_inside(std::span<const Point2> polygon, const Point2& p);

/// Whether the edge from a to b crosses the ray from p along the first axis, as `is_inside` counts. Exact.
bool passes_right_of(const Point2& p, const Point2& a, const Point2& b);

/// How two closed segments meet.
enum class Meeting {
    apart,
    crossing,  ///< in one point that is an end of neither
    touching,  ///< in an end of one of them, or along a stretch
};
Meeting meeting(const Point2& a, const Point2& b, const Point2& c, const Point2& d);

}  // namespace kontur
