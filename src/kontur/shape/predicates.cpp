// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/predicates.h"

#include <algorithm>
#include <cmath>

#include "kontur/shape/sign_of_sum.h"

#ifdef __FAST_MATH__
#error "predicates.cpp relies on the rounding of each operation, and on NaN: compile it without -ffast-math"
#endif

namespace kontur {

int orientation(const Point2& a, const Point2& b, const Point2& c) {
    const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
    const double area = left - right, sum = std::abs(left) + std::abs(right);
    // Each product is off by at most (3u + 3u^2 + u^3) of itself, u = 2^-53: two differences and the product are rounded
    // (after Shewchuk 1997). A fourth u covers the rounding of the sum and, unless it is tiny, underflow. The
    // comparison is false where something overflowed.
    constexpr double kError = 4 * 0x1p-53, kTiny = 0x1p-900;
    if (sum >= kTiny && std::abs(area) > kError * sum) return area > 0 ? 1 : -1;
    return sign_of_sum({{{a[0], b[1]}, {-a[0], c[1]}, {-c[0], b[1]}, {-a[1], b[0]}, {a[1], c[0]}, {c[1], b[0]}}});
}

bool is_on_segment(const Point2& a, const Point2& b, const Point2& p) {
    for (const std::size_t axis : {0u, 1u}) {
        const auto [low, high] = std::minmax(a[axis], b[axis]);
        if (p[axis] < low || p[axis] > high) return false;
    }
    return orientation(a, b, p) == 0;
}

bool is_inside(std::span<const Point2> polygon, const Point2& p) {
    bool inside = false;
    for_each_edge(polygon, [&](const Point2& a, const Point2& b) { inside ^= passes_right_of(p, a, b); });
    return inside;
}

bool passes_right_of(const Point2& p, const Point2& a, const Point2& b) {
    if ((a[1] > p[1]) == (b[1] > p[1])) return false;
    // The ray meets the edge if p lies left of it as it goes up, right of it as it goes down.
    return orientation(a, b, p) == (b[1] > a[1] ? 1 : -1);
}

Meeting meeting(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
    for (const std::size_t axis : {0u, 1u})
        if (std::max(a[axis], b[axis]) < std::min(c[axis], d[axis]) ||
            std::max(c[axis], d[axis]) < std::min(a[axis], b[axis]))
            return Meeting::apart;
    const int c_side = orientation(a, b, c), d_side = orientation(a, b, d);
    if (c_side * d_side > 0) return Meeting::apart;
    const int a_side = orientation(c, d, a), b_side = orientation(c, d, b);
    if (a_side * b_side > 0) return Meeting::apart;
    if (c_side * d_side < 0 && a_side * b_side < 0) return Meeting::crossing;
    const bool touches =
        is_on_segment(a, b, c) || is_on_segment(a, b, d) || is_on_segment(c, d, a) || is_on_segment(c, d, b);
    return touches ? Meeting::touching : Meeting::apart;
}

}  // namespace kontur
