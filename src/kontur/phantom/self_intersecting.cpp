// SPDX-License-Identifier: Apache-2.0
#include "kontur/phantom/self_intersecting.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <span>

#include "kontur/phantom/drawing.h"

namespace kontur {
namespace {

using Curve = std::function<Vec3(double angle)>;  ///< closed over [0, 2 pi], in the plane z = 0

constexpr std::size_t kDensePoints = 4000;
constexpr std::size_t kPointsPerContour = 160;

Vec3 figure_of_eight(double angle) { return {45 * std::sin(angle), 28 * std::sin(2 * angle), 0}; }

Vec3 loop_in_loop(double angle) {
    const double radius = 12 + 28 * std::cos(angle);
    return {radius * std::cos(angle), radius * std::sin(angle), 0};
}

bool inside_even_odd(const Vec3& p, std::span<const Vec3> polygon) {
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    }
    return inside;
}

void add_curve(SelfIntersectingCurves& curves, const Curve& curve, double scale, const Vec3& center) {
    constexpr double kProbe_mm = 0.02;
    std::vector<Vec3> dense;
    for (std::size_t i = 0; i < kDensePoints; ++i)
        dense.push_back(center + scale * curve(2 * std::numbers::pi * static_cast<double>(i) / kDensePoints));
    Contour contour{.plane = make_plane(center, {0, 0, 1}), .points = resample_closed(dense, kPointsPerContour)};

    auto& normals = curves.normals.emplace_back();
    for (std::size_t i = 0; i < kPointsPerContour; ++i) {
        const Vec3& p = contour.points[i];
        const Vec3 tangent =
            contour.points[(i + 1) % kPointsPerContour] - contour.points[(i + kPointsPerContour - 1) % kPointsPerContour];
        const Vec3 normal = normalized(cross(tangent, {0, 0, 1}));
        normals.push_back(inside_even_odd(p + kProbe_mm * normal, dense) ? -normal : normal);
    }
    curves.contours.contours.push_back(std::move(contour));
}

}  // namespace

SelfIntersectingCurves self_intersecting_curves() {
    SelfIntersectingCurves curves;
    curves.contours.name = "self_intersecting";
    for (const double z : {-20.0, -10.0, 0.0, 10.0, 20.0}) {
        const double scale = std::sqrt(1 - (z / 30) * (z / 30));
        add_curve(curves, figure_of_eight, scale, {-55, 0, z});
        add_curve(curves, loop_in_loop, scale, {35, 0, z});
    }
    return curves;
}

}  // namespace kontur
