// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/bounds/bounds.h"
#include "kontur/bounds/drawn_regions.h"

namespace kontur {

struct DrawnPlanes;

/// Where a plane close beyond a region, drawn or given, shows nothing of it, the object ends in a face that is nearly flat.
/// A smooth function has no edge, so the wall below would bulge. These bounds keep it: below the region's lines, half, one
/// and two inscribed radii deep, f is at most what lies on a straight way to the next parallel section, and a tenth of the
/// depth. They fade out as the empty plane moves away by 1.5 inscribed radii, as it tilts by 20 degrees, and as it shows
/// half of the region. `sign` says on which side of the region's plane the empty one lies.
std::vector<Bound> wall_bounds(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions, std::size_t region,
                               double sign);

}  // namespace kontur
