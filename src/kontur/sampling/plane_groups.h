// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kontur/shape/contour.h"

namespace kontur {

/// Numbers of contours of one drawn plane.
using PlaneGroup = std::vector<std::size_t>;

/// The contours of each plane, in the order of the planes' first ones.
std::vector<PlaneGroup> contours_by_plane(const ContourSet& set);

/// Of more than `most` planes so many, evenly.
std::vector<PlaneGroup> at_most(std::size_t most, const std::vector<PlaneGroup>& groups);

/// The drawing with these contours only, and without them.
ContourSet only(const ContourSet& set, const PlaneGroup& group);
ContourSet without(const ContourSet& set, const PlaneGroup& group);

}  // namespace kontur
