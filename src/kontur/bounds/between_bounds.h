// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/bounds/bounds.h"
#include "kontur/bounds/drawn_regions.h"

namespace kontur {

/// A tube goes on between its rings. Two sections, each the nearest one ahead of the other within 45 degrees of both normals
/// and three radii or more away, are moved onto each other: turned by the way between their planes, scaled, along a cubic
/// curve that leaves both planes at right angles where they are tilted against each other. In the middle of the way f is
/// positive, by a share of the lesser of both depths. It is not said where another plane near by shows nothing, and fades
/// out where the sections are 8 to 10 radii apart or two to three times as far as the ones before them: two bodies one above
/// the other are not joined. A bound by its side alone: where f is positive by itself, nothing is said of its value.
std::vector<Bound> between_bounds(const std::vector<DrawnRegion>& regions);

}  // namespace kontur
