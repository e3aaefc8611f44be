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

/// What was drawn, with the sides of open contours found. Throws as check_contours.
Drawing read_drawing(const ContourSet& set, FillRule rule = FillRule::even_odd);

/// "contour 3 is open; the object was taken to lie on its left": contours are counted from 1. One sentence for all of one
/// side, and one for those of which it is doubtful.
std::vector<std::string> sentences(const std::vector<FoundSide>& sides);

}  // namespace kontur
