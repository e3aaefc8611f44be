// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

#include "kontur/shape/grid.h"
#include "kontur/solve/solve.h"
#include "support/bodies.h"

namespace kontur::test {

/// Exactly a ball: (R^3 - r^3) / (3 R^2), of slope 1 at its surface.
inline ImplicitFunction ball_function(const Vec3& center, double radius) {
    return {Kernel::triharmonic,
            {center, 1},
            PointArrays(std::vector<Vec3>{{}}),
            {-1 / (3 * radius * radius)},
            {radius / 3, 0, 0, 0}};
}

/// Exactly a spheroid: the points whose distances to two foci at `center` -+ `focus` have a mean below `half_axis`.
inline ImplicitFunction spheroid_function(const Vec3& center, const Vec3& focus, double half_axis) {
    return {
        Kernel::biharmonic, {center, 1}, PointArrays(std::vector<Vec3>{focus, -focus}), {-0.5, -0.5}, {half_axis, 0, 0, 0}};
}

/// The interpolant of a body's surface points and their normals.
inline ImplicitFunction function_through(const TriangleMesh& surface, double offset_mm = 0.5) {
    ConstraintSet set;
    for (std::size_t i = 0; i < surface.points.size(); ++i)
        for (const double offset : {0.0, offset_mm}) {
            set.centers.push_back(surface.points[i] + offset * surface.normals[i]);
            set.values.push_back(-offset);
        }
    return solve(set, {.solver = Solver::cholesky, .smoothing = 0}).function;
}

/// A function with many sheets and bubbles in the box [0, extent]^3.
inline ImplicitFunction rough_function(double extent, std::mt19937& random) {
    std::uniform_real_distribution<double> coordinate(0, extent), value(-1, 1);
    ConstraintSet set;
    for (int i = 0; i < 120; ++i) {
        set.centers.push_back({coordinate(random), coordinate(random), coordinate(random)});
        set.values.push_back(value(random));
    }
    return solve(set, {.kernel = Kernel::biharmonic, .solver = Solver::cholesky, .smoothing = 0}).function;
}

/// A grid of cubic voxels about a point.
inline Grid grid_about(const Vec3& center, const Index3& size, double spacing_mm) {
    Grid grid{size, {}};
    for (int axis = 0; axis < 3; ++axis) {
        grid.index_to_mm.linear[axis][axis] = spacing_mm;
        grid.index_to_mm.translation[axis] = center[axis] - 0.5 * spacing_mm * static_cast<double>(size[axis] - 1);
    }
    return grid;
}

/// The same grid with its axes multiplied by `change`, about the same centre.
inline Grid changed(Grid grid, const Affine3& change) {
    const Vec3 middle{0.5 * static_cast<double>(grid.size.i - 1), 0.5 * static_cast<double>(grid.size.j - 1),
                      0.5 * static_cast<double>(grid.size.k - 1)};
    const Vec3 center = grid.index_to_mm.apply(middle);
    grid.index_to_mm = compose({change.linear, {}}, grid.index_to_mm);
    grid.index_to_mm.translation = center - grid.index_to_mm.apply_linear(middle);
    return grid;
}

inline const Affine3 kOblique{{{{0.8, -0.6, 0}, {0.6, 0.8, 0}, {0, 0, 1}}}, {}};
inline const Affine3 kSheared{{{{1, 0.4, -0.3}, {0, 1.1, 0.2}, {0.1, 0, 0.7}}}, {}};
inline const Affine3 kMirrored{{{{1, 0, 0}, {0, -1, 0}, {0, 0, 1.3}}}, {}};

}  // namespace kontur::test
