// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/bounds/bounds.h"
#include "kontur/bounds/drawn_regions.h"
#include "kontur/bounds/tube_ways.h"

namespace kontur {

/// A tube goes on between its rings. Two sections that a way joins are moved onto each other: turned by the way between
/// their planes and scaled. In the middle of the way f is positive, by a share of the lesser of both depths. It is not said
/// where another plane near by shows nothing, and fades out with the way's belief. A bound by its side alone: where f is
/// positive by itself, nothing is said of its value. Where another way leads on, the tube is also no wider than its rings:
/// at a quarter, half and three quarters of the way f is at most a little above 0 beside their outlines.
std::vector<Bound> between_bounds(const std::vector<DrawnRegion>& regions, const std::vector<TubeWay>& ways);

}  // namespace kontur
