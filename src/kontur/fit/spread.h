// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kontur/base/geometry.h"

namespace kontur {

/// The points of a line in their order.
struct LinePoints {
    std::vector<Vec3> positions;
    bool is_ring;  ///< the first follows the last
};

/// Points that are spread along a line are so much farther apart on average than at least.
inline constexpr double kSpreadApart = 1.3;

/// Chooses points that are spread along a line. A point is taken unless one of its `neighbours` next ones,
/// or one less than its `apart_mm` away along the line, was taken before. Points where the line turns least
/// come first. So neither the direction of the line nor the beginning of a ring matters, and a change in one
/// place has no effect far away. Points at which the line turns alike, as on a circle, come in their order.
/// Returns a flag for each point; at least one is taken. On average they are a third farther apart than
/// `apart_mm`.
std::vector<bool> spread_along(const LinePoints& line, std::span<const double> apart_mm, std::size_t neighbours);

}  // namespace kontur
