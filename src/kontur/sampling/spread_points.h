// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/drawing/drawing.h"
#include "kontur/drawing/stored_alike.h"
#include "kontur/function/implicit_function.h"
#include "kontur/sampling/moving_point.h"

namespace kontur {

/// The surface of f through the contours as the points at which it crosses a lattice of `spacing_mm` in their frame,
/// interpolated linearly: a few percent of the spacing beside it. None where it is farther from the contours than half of
/// their extent.
std::vector<Vec3> points_of_surface(const ImplicitFunction& function, const ContourSet& contours, double spacing_mm,
                                    const Work& work);

/// About `count` of the points, evenly spread over cells of a frame; all where there are fewer.
std::vector<Vec3> spread(const std::vector<Vec3>& points, std::size_t count, const Affine3& frame);

struct SlideOptions {
    double reach_mm = 0;  ///< no step is longer
    int steps = 1;        ///< of Newton's method; one is enough from a point of points_of_surface
};

/// Moves each point towards where f vanishes. Returns f's gradients where the last steps began.
std::vector<Vec3> slide_to_surface(const ImplicitFunction& function, std::vector<Vec3>& points, const SlideOptions& options,
                                   const Work& work);

/// The points with f's outward normals there; distances and offsets are left as they are.
std::vector<MovingPoint> with_normals(const ImplicitFunction& function, std::span<const Vec3> points, const Work& work);

/// Points along the contours, evenly, `step_mm` apart or somewhat less, at least 8 on each.
std::vector<Vec3> along_contours(const ContourSet& contours, double step_mm);

/// The length of a contour, with its closing edge if it has one, and of all contours together.
double length_mm(const Contour& contour);
double length_mm(const ContourSet& contours);

/// Distance to the nearest of some points.
double nearest_distance(const Vec3& p, std::span<const Vec3> points);

}  // namespace kontur
