// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/orient.h"

#include <cmath>

#include "kontur/base/checks.h"
#include "kontur/shape/self_intersections.h"

namespace kontur {
namespace {

double length(const Point2& v) { return std::hypot(v[0], v[1]); }

Point2 edge(const Polygon2& polygon, std::size_t i) {
    const Point2 &from = polygon[i], &to = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    return {to[0] - from[0], to[1] - from[1]};
}

bool turns_left(const Polygon2& polygon, std::size_t i) {
    const std::size_t n = polygon.size();
    return is_left_turn(polygon, (i + n - 1) % n, i, (i + 1) % n);
}

/// Eq. 7 up to its sign: the left-hand normal of edge i - 1 plus that of edge i.
Point2 left_normal(const Polygon2& polygon, std::size_t i) {
    const Point2 before = edge(polygon, (i + polygon.size() - 1) % polygon.size()), after = edge(polygon, i);
    const Point2 sum{-(before[1] + after[1]), before[0] + after[0]};
    const double total = length(before) + length(after);
    if (length(sum) > 1e-9 * total) return {sum[0] / length(sum), sum[1] / length(sum)};
    if (!(total > 0)) return {1, 0};
    // The path turns back on itself. What lies left of it lies ahead of the tip after a right turn, behind it after a left
    // one.
    const double ahead = turns_left(polygon, i) ? -1 / total : 1 / total;
    return {ahead * (before[0] - after[0]), ahead * (before[1] - after[1])};
}

}  // namespace

ContourOrientation orient(const Contour& contour) {
    check_at_least("the number of points of the contour", static_cast<std::int64_t>(contour.points.size()), 3);
    const Plane& plane = contour.plane;
    Polygon2 polygon;
    for (const Vec3& p : contour.points) polygon.push_back(plane.to_uv(p));
    const SelfIntersections found = find_self_intersections(polygon);
    const std::size_t n = polygon.size(), start = extreme_point(polygon);

    ContourOrientation result;
    result.normals.resize(n);
    // The left-hand normal leads out of the polygon at a convex corner that turns right.
    int sign = (turns_left(polygon, start) ? -1 : 1) * (contour.hole ? -1 : 1);
    for (std::size_t step = 0; step < n; ++step) {
        const std::size_t i = (start + step) % n;
        const Point2 normal = left_normal(polygon, i);
        result.normals[i] = normalized(sign * (normal[0] * plane.u + normal[1] * plane.v));
        if (found.crossings_of_segment[i] % 2 != 0) sign = -sign;
    }
    for (const SelfIntersection& contact : found.places)
        if (contact.kind == SelfIntersection::Kind::crossing) result.crossings.push_back(plane.from_uv(contact.position));
    for (const Point2& p : found.between_crossings) result.between_crossings.push_back(plane.from_uv(p));
    return result;
}

std::vector<Vec3> left_normals(const Contour& contour) {
    const std::vector<Vec3>& p = contour.points;
    std::vector<Vec3> normals(p.size());
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec3 before = i > 0 ? p[i] - p[i - 1] : Vec3{}, after = i + 1 < p.size() ? p[i + 1] - p[i] : Vec3{};
        const Vec3 sum = before + after;
        if (norm(sum) > 1e-9 * (norm(before) + norm(after))) normals[i] = normalized(cross(contour.plane.normal, sum));
    }
    return normals;
}

}  // namespace kontur
