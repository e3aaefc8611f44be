// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: holes stored as one path with a channel.

#include <vector>

#include "kontur/base/geometry.h"

namespace kontur {

/// The simple rings of a closed path, if it retraces some edge in the opposite direction (both ends within `tolerance_mm`):
/// the channel's edges vanish, and so do spurs. Filled even-odd the rings cover what the path covers. A path without a
/// retraced edge is returned as it is, even where it touches itself.
std::vector<std::vector<Vec3>> split_keyhole(const std::vector<Vec3>& path, double tolerance_mm);

/// The other way round: an outer ring and the holes in it as one path that runs to each hole and back through a channel of
/// no width. Holes run against the outer ring, so the path fills alike by the even-odd and the nonzero rule. Rings lie on
/// `plane`, have at least 3 points and do not cross. Channels join existing points and cross no ring.
/// Source: hole elimination of ear clipping (Held 2001; Eberly 2002).
std::vector<Vec3> join_keyhole(const std::vector<Vec3>& outer, const std::vector<std::vector<Vec3>>& holes,
                               const Plane& plane);

}  // namespace kontur
