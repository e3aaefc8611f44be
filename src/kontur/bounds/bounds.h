// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/base/work.h"

namespace kontur {

struct DrawnPlanes;

/// An interval that f is to keep at a place. It takes part in a fit only where f would leave it, and then as a datum with
/// noise; one of a single value always does.
struct Bound {
    Vec3 position;  ///< mm
    double least_mm = -std::numeric_limits<double>::infinity();
    double most_mm = std::numeric_limits<double>::infinity();
    double noise_mm = 0;   ///< standard deviation
    bool by_side = false;  ///< it takes part only where f has the other sign than it, and then as the others do
    double extent = 1;     ///< in (0, 1], of the part of the drawing that it belongs to, over that of the whole (Extents)
};

struct Bounds {
    std::vector<Bound> bounds;
    std::vector<std::string> notes;  ///< words on what is a guess: a thickness, a gap, outlines that stand alone
};

/// What planes say of the object beside the lines. There are five sources: a drawn plane, which shows where the object is
/// and is not (plane_bounds.h), a plane in which nothing of it is seen (empty_planes.h), the wall below an end that lies
/// close to such a plane (wall_bounds.h), the end of the object beyond a plane after which nothing leads on (end_bounds.h),
/// and the way of a tube between its rings (between_bounds.h). All follow continuously when planes are moved and turned, and
/// move, turn and scale with the contours. What the user declares (ends.h, clicks.h) and what holds of any drawing
/// (far_bounds.h) are added as it is prepared.
Bounds find_bounds(const DrawnPlanes& planes, const Work& work = {});

}  // namespace kontur
