// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kontur/base/geometry.h"

namespace kontur {

/// The stretch from `from` (included) to `to` (left out) of the centripetal Catmull-Rom curve through four points (Yuksel,
/// Schaefer and Keyser 2011: no cusps and no loops within a stretch), in steps of about `step_mm`, at most 1000 of them.
/// Planar when the four points are. Neighbours that coincide with an end count as its mirror image. Empty when `from` and
/// `to` coincide. Throws Error(invalid_input) for a step that is not > 0.
std::vector<Vec3> spline_stretch(const Vec3& before, const Vec3& from, const Vec3& to, const Vec3& after, double step_mm);

/// The curve through all points: closed without repeating its first point, or open with both ends. Fewer than 3 points are
/// returned as they are.
std::vector<Vec3> spline(std::span<const Vec3> points, bool closed, double step_mm);

}  // namespace kontur
