// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kontur/base/geometry.h"

namespace kontur {

struct Ball3 {
    Vec3 center;
    double radius = 0;

    double diameter() const { return 2 * radius; }
};

/// The smallest ball that contains the points, to rounding: unlike their box, it turns with them. Radius 0 for one point
/// and for none. From the farthest point to the next (Gaertner, Fast and robust smallest enclosing balls, 1999); mostly
/// fewer than twenty passes over the points.
Ball3 smallest_ball(std::span<const Vec3> points);

}  // namespace kontur
