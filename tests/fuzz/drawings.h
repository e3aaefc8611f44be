// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fuzz/choices.h"
#include "kontur/shape/contour.h"

namespace kontur::fuzz {

/// Anything: round, angular, wild or degenerate contours in any planes, clicks and surface points, from micrometres to
/// kilometres.
ContourSet wild_drawing(Choices& choose);

/// What people draw of one body of 10 to 40 mm, mixed: closed contours of parallel and crossing planes in any order,
/// stretches of them, holes, flat and round ends, weights, contours drawn twice, clicks and single points of the surface.
ContourSet mixed_drawing(Choices& choose);

}  // namespace kontur::fuzz
