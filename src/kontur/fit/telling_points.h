// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kontur/drawing/boundary_point.h"

namespace kontur {

/// Some of the points of lines, by their numbers in ascending order.
struct TellingPoints {
    std::vector<std::size_t> numbers;
    std::vector<double> weights;  ///< for each, how many points of its line it stands for, over the mean
};

/// The points that tell where all lines run: about every fourth of a smooth one, and every point that is more than the
/// tolerance, times its extent, off the cubic through two of those on either side. Corners, the ends of open lines and
/// lines of few points stay. It counts how far a point lies off across its line. What is chosen of a line does not depend on
/// other lines, nor on its direction.
TellingPoints telling_points(const std::vector<BoundaryPoint>& points, double tolerance_mm);

/// Whether a function is as near to 0 at every point that was left out as at the next points of its line that were taken,
/// or within the tolerance, times its extent, of that. `values` are its values at all points.
bool tell_the_rest(const TellingPoints& telling, const std::vector<BoundaryPoint>& points, std::span<const double> values,
                   double tolerance_mm);

}  // namespace kontur
