// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/shape/contour.h"

namespace kontur {

/// What a person says of an existing mask. In `drawing`:
/// - closed contours are the whole outline in their plane;
/// - an open contour replaces the piece of the outline between its ends, the shorter way round;
/// - interior and exterior points lie inside and outside;
/// - in empty planes there is nothing.
struct Corrections {
    ContourSet drawing;
    std::vector<Plane> confirmed{};  ///< planes that were looked at, and in which the mask is right
};

}  // namespace kontur
