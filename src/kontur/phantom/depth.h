// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "kontur/base/geometry.h"

/// Building blocks of implicit bodies: depths in mm below a surface, positive inside, negative outside, with a gradient of
/// about length 1 near the surface.
namespace kontur::depth {

/// First-order distance to an ellipsoid's surface (Quilez 2008): exact on it, within a few percent nearby.
inline double ellipsoid(const Vec3& p, const Vec3& radii) {
    const Vec3 q{p.x / radii.x, p.y / radii.y, p.z / radii.z};
    const Vec3 slope{q.x / radii.x, q.y / radii.y, q.z / radii.z};
    const double k = std::sqrt(dot(q, q)), k_slope = std::sqrt(dot(slope, slope));
    return k_slope > 0 ? k * (1 - k) / k_slope : std::min({radii.x, radii.y, radii.z});
}

/// The same for an elliptic cylinder along z.
inline double elliptic_cylinder(const Vec3& p, double radius_x, double radius_y) {
    const double qx = p.x / radius_x, qy = p.y / radius_y;
    const double k = std::sqrt(qx * qx + qy * qy);
    const double k_slope = std::sqrt(qx * qx / (radius_x * radius_x) + qy * qy / (radius_y * radius_y));
    return k_slope > 0 ? k * (1 - k) / k_slope : std::min(radius_x, radius_y);
}

/// A segment thickened to a tube of the given radius with round ends.
inline double capsule(const Vec3& p, const Vec3& a, const Vec3& b, double radius) {
    const Vec3 axis = b - a;
    const double t = std::clamp(dot(p - a, axis) / dot(axis, axis), 0.0, 1.0);
    const Vec3 d = p - a - t * axis;
    return radius - std::sqrt(dot(d, d));
}

/// Union whose seam is rounded where the two depths differ by less than `blend_mm`; once continuously differentiable.
inline double join(double a, double b, double blend_mm) {
    const double overlap = std::max(blend_mm - std::abs(a - b), 0.0) / blend_mm;
    return std::max(a, b) + 0.25 * overlap * overlap * blend_mm;
}
inline double intersect(double a, double b, double blend_mm) { return -join(-a, -b, blend_mm); }
inline double subtract(double a, double b, double blend_mm) { return intersect(a, -b, blend_mm); }

}  // namespace kontur::depth
