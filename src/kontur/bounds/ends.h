// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kontur/bounds/bounds.h"
#include "kontur/drawing/boundary_point.h"

namespace kontur {

struct DrawnPlanes;

/// What the contours that end the object (ContourEnd) add to the fit.
struct Ends {
    std::vector<BoundaryPoint> lids;  ///< points of the surface
    std::vector<Bound> guards;        ///< beyond them
    std::vector<std::string> notes;   ///< ends that could not be followed, a sentence each, contours counted from 1
};

/// A flat end closes the object by a lattice of points whose normal is the plane's, 0.005 of the contour's inscribed
/// radius beyond its plane, so that what was drawn there belongs to the object; for the last tenth of that radius the wall
/// goes straight to the next parallel plane's outline (upright without one). A round end is a dome, as high as half
/// the distance to the parallel plane before it and no higher than half the width of the contour (half its inscribed radius
/// where there is no such plane). It ends on the side where neither the next parallel plane nor contours of other directions
/// carry the contour's region on; where neither is so, away from the nearer parallel plane. Holes inside of the contour stay
/// open.
Ends find_ends(const DrawnPlanes& planes);

}  // namespace kontur
