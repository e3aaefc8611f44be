// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kontur/bounds/bounds.h"
#include "kontur/bounds/drawn_regions.h"

namespace kontur {

/// What a plane in which nothing of the object is seen says of the places in it: f is negative there, a quarter of how far
/// the place is known to lie outside, which is its distance to what other planes show of the object; a parallel plane tells
/// less (plane_lattice.h). Contours that reach through the plane contradict it: it fades out as they do so by 0.5 to 2 % of
/// the ball's diameter, and altogether when one lies in it. Turns, moves and scales with the drawing.
std::vector<Bound> empty_plane_bounds(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions,
                                      const Plane& empty);

/// One sentence for each empty plane that a contour contradicts, counted from 1.
std::vector<std::string> contradicted_empty_planes(const DrawnPlanes& planes);

}  // namespace kontur
