// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/shape/contour.h"

namespace kontur {

/// A point up to which the object may extend beyond a drawn plane: f must not exceed `most_mm` there.
struct Cap {
    Vec3 position;
    double most_mm;
};

/// Limits to extrapolation. Contours say nothing about the space beyond the last of them, where a smooth interpolant runs
/// on: a stack of equal circles becomes an endless cylinder. For every drawn plane and each of its sides:
///
/// - where contours of other directions lead on beyond the plane, there is no limit: they tell where the object ends;
/// - towards the next parallel plane, what lies well inside here and outside of that plane's contours ends before it;
/// - beyond the last parallel plane the object ends within a rounded cap whose height is the distance to the plane before
///   it, or, for contours in a single plane, the radius of the largest inscribed circle.
///
/// At most a few hundred points per plane; spacings follow the contours' size, so the caps move and scale with them.
std::vector<Cap> find_caps(const ContourSet& set);

}  // namespace kontur
