// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "kontur/shape/contour.h"

namespace kontur {

/// What becomes of the corners of closed contours: points at which the drawn line turns by at least 30 degrees.
enum class Corners {
    rounded,   ///< like any other point: the surface passes them in a narrow bend
    faithful,  ///< the surface follows both edges into them; for contours drawn by their corners, not for traced voxel edges
};
std::string_view name(Corners corners) noexcept;

/// For each point of a closed contour whether it is a corner; none of an open one.
std::vector<bool> find_corners(const Contour& contour);

/// Subdivides edges ever more finely towards the corners, one flag for each point: the first point is `nearest_mm` from its
/// corner, each further one half as far again, up to steps of `longest_mm`. Drawn points stay. An edge of length l gets
/// about 2 l / longest + 5 log(longest / nearest) points. Throws Error(invalid_input) unless both lengths are finite and
/// above 0 and there is one flag for each point.
Contour subdivide_to_corners(const Contour& contour, const std::vector<bool>& corners, double nearest_mm, double longest_mm);

}  // namespace kontur
