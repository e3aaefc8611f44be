// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "kontur/derive/levels.h"

// Bodies whose signed distance is known exactly, mm, positive inside, and grids of several spacings and tilts to put them
// on.

namespace kontur::test {

struct Solid {
    std::string name;
    std::function<double(const Vec3&)> level;
    std::function<double(const Vec3&)> support;  ///< how far it reaches along a unit vector, from the origin
};

inline Solid ball(double radius) {
    return {"ball", [=](const Vec3& p) { return radius - norm(p); }, [=](const Vec3&) { return radius; }};
}

inline double box_level(const Vec3& p, const Vec3& half) {
    const Vec3 q{std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z};
    const Vec3 out{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)};
    return -(norm(out) + std::min(std::max({q.x, q.y, q.z}), 0.0));
}

inline double box_support(const Vec3& u, const Vec3& half) {
    return std::abs(u.x) * half.x + std::abs(u.y) * half.y + std::abs(u.z) * half.z;
}

inline Solid box(const std::string& name, const Vec3& half) {
    return {name, [=](const Vec3& p) { return box_level(p, half); }, [=](const Vec3& u) { return box_support(u, half); }};
}

/// Foot point by bisection (Eberly 2013).
inline double ellipsoid_level(const Vec3& point, const Vec3& axes) {
    const Vec3 p{std::abs(point.x), std::abs(point.y), std::abs(point.z)};
    const auto sum = [&](double t) {
        double s = 0;
        for (int n = 0; n < 3; ++n) s += std::pow(axes[n] * p[n] / (t + axes[n] * axes[n]), 2);
        return s - 1;
    };
    double inside = 0;
    for (int n = 0; n < 3; ++n) inside += std::pow(p[n] / axes[n], 2);
    const double least = std::min({axes.x, axes.y, axes.z});
    double low = -least * least + 1e-12, high = norm(p) * std::max({axes.x, axes.y, axes.z}) + 1;
    for (int step = 0; step < 50; ++step) (sum(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
    Vec3 foot;
    for (int n = 0; n < 3; ++n) foot[n] = axes[n] * axes[n] * p[n] / (low + axes[n] * axes[n]);
    return (inside < 1 ? 1 : -1) * distance(foot, p);
}

inline Solid ellipsoid(const Vec3& axes) {
    return {"ellipsoid", [=](const Vec3& p) { return ellipsoid_level(p, axes); },
            [=](const Vec3& u) {
                return norm({axes.x * u.x, axes.y * u.y, axes.z * u.z});
            }};
}

/// An L in the plane x, y, drawn out along z to both sides.
inline Solid l_shape(double half_height) {
    const std::vector<std::array<double, 2>> corners{{-12, -12}, {12, -12}, {12, -3}, {-3, -3}, {-3, 12}, {-12, 12}};
    const auto level = [=](const Vec3& p) {
        double nearest = 1e9;
        bool inside = false;
        for (std::size_t n = 0; n < corners.size(); ++n) {
            const auto &a = corners[n], &b = corners[(n + 1) % corners.size()];
            nearest = std::min(nearest, distance_to_segment({p.x, p.y, 0}, {a[0], a[1], 0}, {b[0], b[1], 0}));
            if ((a[1] > p.y) != (b[1] > p.y) && p.x < a[0] + (p.y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) inside = !inside;
        }
        const double across = inside ? -nearest : nearest, along = std::abs(p.z) - half_height;
        return -(std::min(std::max(across, along), 0.0) + std::hypot(std::max(across, 0.0), std::max(along, 0.0)));
    };
    const auto support = [=](const Vec3& u) {
        double most = -1e9;
        for (const auto& c : corners) most = std::max(most, c[0] * u.x + c[1] * u.y);
        return most + half_height * std::abs(u.z);
    };
    return {"L", level, support};
}

inline std::vector<Solid> solids() {
    return {ball(13), box("box", {9, 12, 8}), ellipsoid({14, 11, 9}), l_shape(9), box("sheet", {13, 12, 2})};
}

/// Of `half_mm` on each side of the origin; turned by `tilt` radians about two axes.
inline Grid grid_of(const Vec3& spacing, double tilt, double half_mm) {
    const double c = std::cos(tilt), s = std::sin(tilt), d = std::cos(0.7 * tilt), e = std::sin(0.7 * tilt);
    // About z by the tilt, then about x by 0.7 of it.
    const std::array<Vec3, 3> axes{Vec3{c, s * d, s * e}, Vec3{-s, c * d, c * e}, Vec3{0, -e, d}};
    Grid grid;
    Vec3 first;
    for (int axis = 0; axis < 3; ++axis) {
        grid.size[axis] = 2 * static_cast<std::int64_t>(std::ceil(half_mm / spacing[axis])) + 1;
        grid.index_to_mm.set_column(axis, spacing[axis] * axes[static_cast<std::size_t>(axis)]);
        first +=
            (-0.5 * static_cast<double>(grid.size[axis] - 1) + 0.3) * spacing[axis] * axes[static_cast<std::size_t>(axis)];
    }
    grid.index_to_mm.translation = first;
    return grid;
}

inline std::vector<Vec3> spacings() { return {{1, 1, 1}, {0.7, 0.7, 5}, {0.98, 0.98, 3}, {2, 2, 2}, {0.6, 0.6, 1.2}}; }
inline std::vector<double> tilts() { return {0, 0.17, 0.5}; }

/// The length of a voxel along the level's slope at a point, mm.
inline double voxel_length(const Solid& solid, const Grid& grid, const Vec3& p) {
    constexpr double kStep = 1e-4;
    Vec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 step;
        step[axis] = kStep;
        slope[axis] = solid.level(p + step) - solid.level(p - step);
    }
    slope = normalized(slope);
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) sum += std::pow(dot(slope, grid.index_to_mm.column(axis)), 2);
    return std::sqrt(sum);
}

/// As exact as a function gives them.
inline Levels levels_of(const Solid& solid, const WorkLattice& lattice) {
    const Index3 steps = steps_per_voxel(lattice), size = lattice.grid.size;
    Levels levels{{{-1, -1, -1}, {(size.i - 1) * steps.i + 1, (size.j - 1) * steps.j + 1, (size.k - 1) * steps.k + 1}}, {}};
    for (std::int64_t k = levels.box.low.k; k <= levels.box.high.k; ++k)
        for (std::int64_t j = levels.box.low.j; j <= levels.box.high.j; ++j)
            for (std::int64_t i = levels.box.low.i; i <= levels.box.high.i; ++i)
                levels.values.push_back(static_cast<float>(solid.level(lattice.grid.center_mm(i, j, k))));
    return trimmed(std::move(levels));
}

inline Mask mask_of(const Solid& solid, const Grid& grid) {
    Mask mask{grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()))};
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i)
                mask.values[grid.offset(i, j, k)] = solid.level(grid.center_mm(i, j, k)) > 0;
    return mask;
}

}  // namespace kontur::test
