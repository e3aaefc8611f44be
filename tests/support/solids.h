// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "kontur/phantom/bodies.h"
#include "kontur/phantom/drawing.h"
#include "kontur/phantom/phantom.h"
#include "kontur/shape/grid.h"
#include "support/coarse_grid.h"

namespace kontur::test {

/// Solids whose signed depth is a formula, for contours drawn on them and masks to compare with.
inline Body ball_solid(const Vec3& center, double radius) {
    const Vec3 r{radius + 1, radius + 1, radius + 1};
    return {"ball", {center - r, center + r}, [=](const Vec3& p) { return radius - distance(p, center); }};
}

inline Body ellipsoid(const Vec3& center, const Vec3& radii) {
    const Vec3 one{1, 1, 1};
    return {"ellipsoid", {center - radii - one, center + radii + one}, [=](const Vec3& p) {
                const Vec3 d = p - center;
                const double q = norm({d.x / radii.x, d.y / radii.y, d.z / radii.z});
                const double slope = norm({d.x / (radii.x * radii.x), d.y / (radii.y * radii.y), d.z / (radii.z * radii.z)});
                return slope > 0 ? (1 - q) * q / slope : std::min({radii.x, radii.y, radii.z});
            }};
}

inline Body torus_solid(const Vec3& center, double major, double minor) {
    const Vec3 r{major + minor + 1, major + minor + 1, minor + 1};
    return {"torus", {center - r, center + r}, [=](const Vec3& p) {
                const Vec3 d = p - center;
                return minor - std::hypot(std::hypot(d.x, d.y) - major, d.z);
            }};
}

/// Between two concentric balls.
inline Body shell(const Vec3& center, double outer, double inner) {
    const Vec3 r{outer + 1, outer + 1, outer + 1};
    return {"shell", {center - r, center + r}, [=](const Vec3& p) {
                const double at = distance(p, center);
                return std::min(outer - at, at - inner);
            }};
}

inline double depth_in_capsule(const Vec3& p, const Vec3& a, const Vec3& b, double radius_a, double radius_b) {
    const Vec3 axis = b - a;
    const double t = std::clamp(dot(p - a, axis) / dot(axis, axis), 0.0, 1.0);
    return radius_a + t * (radius_b - radius_a) - distance(p, a + t * axis);
}

/// A tube along z that divides into two, as vessels and airways do.
inline Body bifurcation() {
    return {"bifurcation", {{-35, -12, -42}, {35, 12, 42}}, [](const Vec3& p) {
                const double trunk = depth_in_capsule(p, {0, 0, -30}, {0, 0, 0}, 9, 9);
                const double left = depth_in_capsule(p, {0, 0, 0}, {-22, 0, 30}, 9, 7);
                const double right = depth_in_capsule(p, {0, 0, 0}, {22, 0, 30}, 9, 7);
                return std::max({trunk, left, right});
            }};
}

/// The intersection of two solids.
inline Body both(const Body& a, const Body& b) {
    return {a.name() + "_" + b.name(), a.bounds(), [=](const Vec3& p) { return std::min(a.value(p), b.value(p)); }};
}

inline Body half_space(const Vec3& at, const Vec3& outward) {
    return {"half", {}, [=](const Vec3& p) { return -dot(p - at, outward); }};
}

/// A cylinder along z, flat at both ends.
inline Body cylinder(double radius, double low, double high) {
    return {"cylinder", {{-radius - 1, -radius - 1, low - 1}, {radius + 1, radius + 1, high + 1}}, [=](const Vec3& p) {
                return std::min({radius - std::hypot(p.x, p.y), p.z - low, high - p.z});
            }};
}

/// Parallel planes along z.
inline std::vector<Plane> axial_planes(const std::vector<double>& heights) {
    std::vector<Plane> planes;
    for (const double z : heights) planes.push_back(make_plane({0, 0, z}, {0, 0, 1}));
    return planes;
}

}  // namespace kontur::test
