// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kontur/bounds/drawn_regions.h"

namespace kontur {

/// A word on two parallel sections over each other that are much farther apart than those beside them, contours
/// counted from 1: the drawing does not tell whether they are one body. None where a plane between them is given as empty,
/// or one that is tilted shows the object there.
std::optional<std::string> wide_gap_note(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions);

}  // namespace kontur
