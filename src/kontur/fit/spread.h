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

/// Of the points of a line some that are spread along it: a point is taken unless one that was taken before is one of its
/// `neighbours` next ones or less than its `apart_mm` away along the line. They are asked in the order of how little the
/// line turns there, so that it matters neither where a ring begins nor which way the line runs, and that what is done to
/// the line in one place changes what is taken near it alone. Where the line turns alike, as a circle does, they are asked
/// in their order. Returns a flag for each; one at least is taken. On average they are a third farther apart than
/// `apart_mm`.
std::vector<bool> spread_along(const LinePoints& line, std::span<const double> apart_mm, std::size_t neighbours);

}  // namespace kontur
