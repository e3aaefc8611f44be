// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: holes that are stored as one path with a channel.

#include <vector>

#include "kontur/base/geometry.h"

namespace kontur {

/// The simple rings of a closed path, if it retraces some edge in the opposite direction (both ends within `tolerance_mm`):
/// the channel's edges vanish, and so do spurs. Filled even-odd the rings cover what the path covers. A path without a
/// retraced edge is returned as it is, even where it touches itself.
std::vector<std::vector<Vec3>> split_keyhole(const std::vector<Vec3>& path, double tolerance_mm);

}  // namespace kontur
