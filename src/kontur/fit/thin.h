// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kontur/drawing/boundary_point.h"

namespace kontur {

/// The indices of every few of the points, evenly along the contours, about `most` > 0 in all; short contours keep more of
/// theirs, unless there are very many of them.
std::vector<std::size_t> thin(const std::vector<BoundaryPoint>& points, std::size_t most);

}  // namespace kontur
