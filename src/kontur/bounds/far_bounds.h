// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/bounds/bounds.h"
#include "kontur/drawing/drawn_planes.h"

namespace kontur {

/// Nothing lies at twice the radius of the ball around all that was drawn and clicked inside, whatever open or contradictory
/// contours lead there. Places on a sphere: where f falls off by itself, as it does for nearly all drawings, none takes
/// part.
std::vector<Bound> far_bounds(const DrawnPlanes& planes);

}  // namespace kontur
