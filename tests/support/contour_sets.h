// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

#include "kontur/shape/contour.h"

namespace kontur::test {

/// A circle about the plane's origin.
inline Contour circle(const Plane& plane, double radius_mm, int count) {
    Contour contour{plane, {}, true, false};
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count;
        contour.points.push_back(plane.from_uv(radius_mm * std::cos(angle), radius_mm * std::sin(angle)));
    }
    return contour;
}

/// One of 40 points about the place (u, v) of the plane.
inline Contour circle(Plane plane, double radius_mm, double u, double v) {
    plane.origin = plane.from_uv(u, v);
    return circle(plane, radius_mm, 40);
}

/// Three circles of 20 points in parallel oblique planes.
inline ContourSet three_circles() {
    ContourSet set;
    for (int i = 0; i < 3; ++i) set.contours.push_back(circle(make_plane({1, 2, 3.0 * i}, {0.3, -0.2, 1}), 10, 20));
    return set;
}

/// The circles of a ball of radius 10 about 0 in the three planes of the axes.
inline ContourSet three_great_circles() {
    ContourSet set;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 normal{};
        normal[axis] = 1;
        set.contours.push_back(circle(make_plane({}, normal), 10, 60));
    }
    return set;
}

/// Circles of a ball of radius 20 about (20, -30, 100) in two planes of each main direction.
inline ContourSet ball_contours() {
    constexpr double kRadius = 20;
    ContourSet set;
    for (int axis = 0; axis < 3; ++axis)
        for (const double at : {-7.0, 9.0}) {
            Vec3 normal{}, origin{20, -30, 100};
            normal[axis] = 1;
            origin[axis] += at;
            set.contours.push_back(circle(make_plane(origin, normal), std::sqrt(kRadius * kRadius - at * at), 60));
        }
    return set;
}

/// Circles of a ball in planes across z, `step_mm` apart, the first one so far above its lowest point as `first_mm` says.
inline ContourSet ball_slices(const Vec3& center, double radius_mm, double first_mm, double step_mm) {
    ContourSet set;
    for (double z = -radius_mm + first_mm; z < radius_mm; z += step_mm) {
        const Plane plane{center + Vec3{0, 0, z}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
        set.contours.push_back(circle(plane, std::sqrt(radius_mm * radius_mm - z * z), 48));
    }
    return set;
}

}  // namespace kontur::test
