// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kontur/drawing/drawing.h"

namespace kontur {

/// Says of every open contour that does not tell on which hand the object lies. A coarse fit through all that is known
/// decides, the contour's points among it; where nothing is known, the object is taken to lie towards the middle of all
/// that was drawn. Returns what was found, in the order of the contours.
std::vector<FoundSide> find_sides(ContourSet& set);

/// "contour 3 is open; the object was taken to lie on its left": contours are counted from 1.
std::string sentence(const FoundSide& found);

}  // namespace kontur
