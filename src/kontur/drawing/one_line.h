// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kontur/shape/contour.h"
#include "kontur/shape/near_lines.h"

namespace kontur {

/// Of contours that were taken for one line leaves the first, which takes the way halfway between them; of more than two,
/// the mean. A contour of another weight counts by it. The same whatever their order. Returns the index that each contour
/// that is left had before.
std::vector<std::size_t> make_one_line(ContourSet& set, const std::vector<NearLines>& pairs);

}  // namespace kontur
