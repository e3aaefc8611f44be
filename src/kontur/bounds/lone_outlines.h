// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kontur/bounds/drawn_regions.h"
#include "kontur/bounds/tube_ways.h"

namespace kontur {

/// A word on outlines that stand alone, contours counted from 1: no other section crosses them or lies within three of their
/// radii, and no tube leads on from them. None where they are a small part of what was drawn, or all of it in one plane.
std::optional<std::string> lone_outlines_note(const std::vector<DrawnRegion>& regions, const std::vector<TubeWay>& ways);

}  // namespace kontur
