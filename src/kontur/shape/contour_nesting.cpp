// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/contour_nesting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kontur {
namespace {

using Point2 = std::array<double, 2>;

struct Polygon {
    std::vector<Point2> points;
    Point2 low{}, high{};
};

Polygon project(const Contour& contour, const Plane& plane) {
    Polygon polygon;
    polygon.low.fill(std::numeric_limits<double>::infinity());
    polygon.high.fill(-std::numeric_limits<double>::infinity());
    for (const Vec3& p : contour.points) {
        polygon.points.push_back(plane.to_uv(p));
        for (std::size_t axis = 0; axis < 2; ++axis) {
            polygon.low[axis] = std::min(polygon.low[axis], polygon.points.back()[axis]);
            polygon.high[axis] = std::max(polygon.high[axis], polygon.points.back()[axis]);
        }
    }
    return polygon;
}

bool boxes_meet(const Polygon& a, const Polygon& b) {
    return a.low[0] <= b.high[0] && b.low[0] <= a.high[0] && a.low[1] <= b.high[1] && b.low[1] <= a.high[1];
}

template <typename Visit>
void for_each_edge(const Polygon& polygon, const Visit& visit) {
    const std::size_t n = polygon.points.size();
    for (std::size_t i = 0, j = n - 1; i < n; j = i++) visit(polygon.points[j], polygon.points[i]);
}

bool is_inside(const Point2& p, const Polygon& polygon) {
    bool inside = false;
    for_each_edge(polygon, [&](const Point2& a, const Point2& b) {
        if ((a[1] <= p[1]) != (b[1] <= p[1]) && p[0] < a[0] + (b[0] - a[0]) * ((p[1] - a[1]) / (b[1] - a[1])))
            inside = !inside;
    });
    return inside;
}

double distance_to_boundary(const Point2& p, const Polygon& polygon) {
    double nearest = std::numeric_limits<double>::infinity();
    for_each_edge(polygon, [&](const Point2& a, const Point2& b) {
        const double du = b[0] - a[0], dv = b[1] - a[1], squared = du * du + dv * dv;
        const double along = squared > 0 ? std::clamp(((p[0] - a[0]) * du + (p[1] - a[1]) * dv) / squared, 0.0, 1.0) : 0;
        nearest = std::min(nearest, std::hypot(p[0] - a[0] - along * du, p[1] - a[1] - along * dv));
    });
    return nearest;
}

enum class Position { outside, inside, crossing };

Position position_of(const Polygon& polygon, const Polygon& other, double tolerance) {
    if (!boxes_meet(polygon, other)) return Position::outside;
    constexpr std::size_t kMostTested = 2000;
    const std::size_t stride = 1 + polygon.points.size() / kMostTested;
    std::size_t inside = 0, outside = 0;
    for (std::size_t i = 0; i < polygon.points.size(); i += stride)
        ++(is_inside(polygon.points[i], other) ? inside : outside);
    if (inside == 0) return Position::outside;
    if (outside == 0) return Position::inside;
    inside = outside = 0;
    for (std::size_t i = 0; i < polygon.points.size(); i += stride)
        if (distance_to_boundary(polygon.points[i], other) > tolerance)
            ++(is_inside(polygon.points[i], other) ? inside : outside);
    return inside == 0 ? Position::outside : outside == 0 ? Position::inside : Position::crossing;
}

/// For each contour the first one in its plane.
std::vector<std::size_t> first_in_plane(const std::vector<Contour>& contours, double tolerance_mm) {
    std::vector<std::size_t> first(contours.size());
    for (std::size_t i = 0; i < contours.size(); ++i) {
        std::size_t j = 0;
        while (j < i && !(first[j] == j && coincide(contours[j].plane, contours[i].plane, tolerance_mm))) ++j;
        first[i] = j;
    }
    return first;
}

}  // namespace

std::string_view name(FillRule rule) noexcept { return rule == FillRule::even_odd ? "even-odd" : "declared"; }

FillChanges apply_fill_rule(ContourSet& set, FillRule rule) {
    std::vector<Contour>& contours = set.contours;
    const Nesting nesting = find_nesting(contours, 1.5e-4 * diameter_mm(set));
    FillChanges changes;
    changes.crossings = nesting.crossings;
    if (rule == FillRule::even_odd) {
        for (std::size_t i = 0; i < contours.size(); ++i)
            if (nesting.depth[i] % 2 == 1 && !contours[i].hole) {
                contours[i].hole = true;
                ++changes.holes;
            }
        return changes;
    }
    std::vector<Contour> kept;
    for (std::size_t i = 0; i < contours.size(); ++i) {
        int layers = 0;
        for (const std::size_t around : nesting.enclosing[i]) layers += contours[around].hole ? -1 : 1;
        if (layers <= 0 || contours[i].hole) kept.push_back(contours[i]);
    }
    changes.removed = contours.size() - kept.size();
    contours = std::move(kept);
    return changes;
}

bool coincide(const Plane& a, const Plane& b, double tolerance_mm) {
    return std::abs(dot(a.normal, b.normal)) > 1 - 1e-9 && std::abs(a.distance_to(b.origin)) < tolerance_mm;
}

Nesting find_nesting(const std::vector<Contour>& contours, double tolerance_mm) {
    const std::vector<std::size_t> plane = first_in_plane(contours, tolerance_mm);
    std::vector<Polygon> polygons;
    for (std::size_t i = 0; i < contours.size(); ++i) polygons.push_back(project(contours[i], contours[plane[i]].plane));
    Nesting nesting;
    nesting.depth.assign(contours.size(), 0);
    nesting.enclosing.resize(contours.size());
    for (std::size_t a = 0; a < contours.size(); ++a)
        for (std::size_t b = 0; b < contours.size(); ++b) {
            if (a == b || plane[a] != plane[b] || !contours[a].closed || !contours[b].closed) continue;
            const Position position = position_of(polygons[a], polygons[b], tolerance_mm);
            if (position == Position::inside) {
                ++nesting.depth[a];
                nesting.enclosing[a].push_back(b);
            }
            if (position == Position::crossing) nesting.crossings.emplace_back(std::min(a, b), std::max(a, b));
        }
    std::sort(nesting.crossings.begin(), nesting.crossings.end());
    nesting.crossings.erase(std::unique(nesting.crossings.begin(), nesting.crossings.end()), nesting.crossings.end());
    return nesting;
}

}  // namespace kontur
