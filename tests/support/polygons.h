// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "kontur/shape/contour.h"

namespace kontur::test {

using Point2 = std::array<double, 2>;

/// A closed contour through points given in the plane's own coordinates.
inline Contour contour_in(const Plane& plane, std::span<const Point2> points, bool hole = false) {
    Contour contour{plane, {}, true, hole};
    for (const Point2& p : points) contour.points.push_back(plane.from_uv(p));
    return contour;
}

/// The even-odd rule by a ray along the first axis.
inline bool is_inside_even_odd(std::span<const Point2> polygon, const Point2& p) {
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        if ((a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) inside = !inside;
    }
    return inside;
}

inline double distance_to_segment(const Point2& a, const Point2& b, const Point2& p) {
    const double dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
    const double t = square > 0 ? std::clamp(((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / square, 0.0, 1.0) : 0.0;
    return std::hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy);
}

/// Two lobes of 10 mm; its signed area is 0.
inline std::vector<Point2> figure_of_eight() {
    std::vector<Point2> points;
    for (int i = 0; i < 240; ++i) {
        const double t = 2 * std::numbers::pi * (i + 0.5) / 240;
        points.push_back({20 * std::sin(t), 10 * std::sin(2 * t)});
    }
    return points;
}

/// A simple polygon: random radii at increasing angles, counter-clockwise.
inline std::vector<Point2> random_star(int count, std::mt19937& random) {
    std::uniform_real_distribution<double> radius(4, 20);
    std::vector<Point2> points;
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count, r = radius(random);
        points.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    return points;
}

/// Points anywhere in a square: a polygon that crosses itself often.
inline std::vector<Point2> random_tangle(int count, std::mt19937& random) {
    std::uniform_real_distribution<double> coordinate(-20, 20);
    std::vector<Point2> points;
    for (int i = 0; i < count; ++i) points.push_back({coordinate(random), coordinate(random)});
    return points;
}

}  // namespace kontur::test
