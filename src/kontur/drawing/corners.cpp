// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/corners.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kontur/base/checks.h"

namespace kontur {
namespace {

/// Distances from a corner, with growing steps, that stay clear of `end`.
std::vector<double> growing_steps(double end, double nearest, double longest) {
    std::vector<double> distances;
    double at = nearest, step = nearest;
    while (at < end - step / 4) {
        distances.push_back(at);
        step = std::min(std::max(at / 2, nearest), longest);  // tiny contours have longest < nearest
        at += step;
    }
    return distances;
}

std::vector<double> even_steps(double length, double longest) {
    const auto pieces = length > 2 * longest ? static_cast<int>(std::round(length / longest)) : 1;
    std::vector<double> distances;
    for (int piece = 1; piece < pieces; ++piece) distances.push_back(length * piece / pieces);
    return distances;
}

/// Where to put points along an edge, from its start on.
std::vector<double> steps_along(double length, bool from_corner, bool to_corner, double nearest, double longest) {
    if (!from_corner && !to_corner) return even_steps(length, longest);
    const double middle = from_corner && to_corner ? length / 2 : from_corner ? length : 0;
    std::vector<double> distances = growing_steps(middle, nearest, longest);
    std::vector<double> back = growing_steps(length - middle, nearest, longest);
    std::reverse(back.begin(), back.end());
    for (const double distance : back) distances.push_back(length - distance);
    return distances;
}

}  // namespace

std::string_view name(Corners corners) noexcept { return corners == Corners::rounded ? "rounded" : "faithful"; }

std::vector<bool> find_corners(const Contour& contour) {
    constexpr double kLeastTurn = 30 * std::numbers::pi / 180;
    const std::size_t n = contour.points.size();
    std::vector<bool> corners(n, false);
    if (!contour.closed) return corners;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 &before = contour.points[(i + n - 1) % n], &at = contour.points[i], &after = contour.points[(i + 1) % n];
        corners[i] = dot(normalized(at - before), normalized(after - at)) < std::cos(kLeastTurn);
    }
    return corners;
}

Contour subdivide_to_corners(const Contour& contour, const std::vector<bool>& corners, double nearest_mm,
                             double longest_mm) {
    check_same_count("flags of corners", corners.size(), "points", contour.points.size());
    check_above_0("the spacing at corners", nearest_mm, " mm");
    check_above_0("the spacing between corners", longest_mm, " mm");
    const std::size_t n = contour.points.size(), edges = contour.closed || n == 0 ? n : n - 1;
    Contour result = contour;
    result.points.clear();
    for (std::size_t i = 0; i < edges; ++i) {
        const Vec3 &from = contour.points[i], &to = contour.points[(i + 1) % n];
        const double length = distance(from, to);
        result.points.push_back(from);
        for (const double at : steps_along(length, corners[i], corners[(i + 1) % n], nearest_mm, longest_mm))
            result.points.push_back(from + (at / length) * (to - from));
    }
    if (!contour.closed && n > 0) result.points.push_back(contour.points.back());
    return result;
}

}  // namespace kontur
