// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: the line that 3D Slicer draws through the control points of a curve.

#include <span>
#include <vector>

#include "kontur/base/geometry.h"

namespace kontur {

/// A line through control points, and how far it runs off the straight lines between them.
struct UniformSpline {
    std::vector<Vec3> points;  ///< closed without repeating the first
    double off_mm = 0;         ///< 0: `points` are the control points
};

/// The cubic spline through all points whose parameter grows by 1 from each point to the next, with continuous second
/// derivatives: periodic where the line is closed, else with first derivatives of 0 at both ends. Each stretch gets as many
/// points as keep straight lines between them within `tolerance_mm` of the spline, at most the 10 that 3D Slicer draws.
/// Fewer than 3 points stay as they are.
UniformSpline uniform_spline(std::span<const Vec3> points, bool closed, double tolerance_mm);

}  // namespace kontur
