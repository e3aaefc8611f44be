// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/orient.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace kontur {
namespace {

using Point2 = std::array<double, 2>;

/// A closed polygon in the contour's plane; segment i runs from point i to point i + 1.
struct Polygon2 {
    std::vector<Point2> points;

    std::size_t size() const { return points.size(); }
    const Point2& at(std::size_t i) const { return points[i % points.size()]; }
    Point2 edge(std::size_t i) const { return {at(i + 1)[0] - at(i)[0], at(i + 1)[1] - at(i)[1]}; }
};

Polygon2 to_plane(const Contour& contour) {
    Polygon2 polygon;
    polygon.points.reserve(contour.points.size());
    for (const Vec3& p : contour.points) polygon.points.push_back(contour.plane.to_uv(p));
    return polygon;
}

double side(const Point2& a, const Point2& b, const Point2& p) {
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

/// Where segments i and j cross. A point that lies on the other segment's line counts as being to its left, so that a
/// path that passes exactly through another's vertex crosses it exactly once.
bool crosses(const Polygon2& polygon, std::size_t i, std::size_t j, Point2& where) {
    const Point2 &a = polygon.at(i), &b = polygon.at(i + 1), &c = polygon.at(j), &d = polygon.at(j + 1);
    const double sa = side(c, d, a), sb = side(c, d, b);
    if ((sa >= 0) == (sb >= 0)) return false;
    const double sc = side(a, b, c), sd = side(a, b, d);
    if ((sc >= 0) == (sd >= 0)) return false;
    const double t = sa / (sa - sb);
    where = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
    return true;
}

struct Crossings {
    std::vector<int> count;  ///< per segment: how many other segments cross it
    std::vector<Point2> points;
};

/// All proper crossings of non-adjacent segments, by a sweep over the first coordinate.
Crossings find_crossings(const Polygon2& polygon) {
    const std::size_t n = polygon.size();
    const auto low = [&](std::size_t i) { return std::min(polygon.at(i)[0], polygon.at(i + 1)[0]); };
    const auto high = [&](std::size_t i) { return std::max(polygon.at(i)[0], polygon.at(i + 1)[0]); };
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return low(a) < low(b); });

    Crossings result{std::vector<int>(n, 0), {}};
    std::vector<std::size_t> active;
    for (const std::size_t i : order) {
        std::erase_if(active, [&](std::size_t j) { return high(j) < low(i); });
        for (const std::size_t j : active) {
            const bool adjacent = (i + 1) % n == j || (j + 1) % n == i;
            Point2 where;
            if (adjacent || !crosses(polygon, i, j, where)) continue;
            ++result.count[i];
            ++result.count[j];
            result.points.push_back(where);
        }
        active.push_back(i);
    }
    return result;
}

double length(const Point2& v) { return std::hypot(v[0], v[1]); }

/// Eq. 7 up to its sign: the left-hand normal of edge i - 1 plus that of edge i.
Point2 unsigned_normal(const Polygon2& polygon, std::size_t i) {
    const Point2 before = polygon.edge(i + polygon.size() - 1), after = polygon.edge(i);
    const Point2 sum{-(before[1] + after[1]), before[0] + after[0]};
    const double total = length(before) + length(after);
    if (length(sum) > 1e-9 * total) return {sum[0] / length(sum), sum[1] / length(sum)};
    // The path turns back on itself: the tip's outward direction is the way the path came.
    if (total > 0) return {(before[0] - after[0]) / total, (before[1] - after[1]) / total};
    return {1, 0};
}

/// Twice the signed area of the corner at i; positive for a left turn.
double turn(const Polygon2& polygon, std::size_t i) {
    return side(polygon.at(i + polygon.size() - 1), polygon.at(i), polygon.at(i + 1));
}

/// Index of a surely convex point: smallest first coordinate, then smallest second.
std::size_t extreme_point(const Polygon2& polygon) {
    return static_cast<std::size_t>(std::min_element(polygon.points.begin(), polygon.points.end()) - polygon.points.begin());
}

/// +1 where the left-hand normal at the extreme point leads out of the polygon, else -1. A point whose two edges are
/// collinear there (a straight run along the extreme line) is decided by its neighbours.
int outward_sign(const Polygon2& polygon, std::size_t extreme) {
    for (std::size_t step = 0; step < polygon.size(); ++step) {
        const double corner = turn(polygon, (extreme + step) % polygon.size());
        if (corner != 0) return corner > 0 ? -1 : 1;  // a left turn at a convex corner: the inside is to the left
    }
    return 1;
}

}  // namespace

ContourOrientation orient(const Contour& contour) {
    const Polygon2 polygon = to_plane(contour);
    const Crossings crossings = find_crossings(polygon);
    const std::size_t n = polygon.size(), start = extreme_point(polygon);

    ContourOrientation result;
    result.normals.resize(n);
    int sign = outward_sign(polygon, start) * (contour.hole ? -1 : 1);
    for (std::size_t step = 0; step < n; ++step) {
        const std::size_t i = (start + step) % n;
        const Point2 normal = unsigned_normal(polygon, i);
        result.normals[i] = normalized(sign * (normal[0] * contour.plane.u + normal[1] * contour.plane.v));
        if (crossings.count[i] % 2 != 0) sign = -sign;
    }
    for (const Point2& p : crossings.points) result.crossings.push_back(contour.plane.from_uv(p[0], p[1]));
    return result;
}

}  // namespace kontur
