// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kontur/shape/contour.h"

namespace kontur {

/// Says of every open contour that does not tell on which hand the object lies. A coarse fit through all that is known
/// decides, the contour's points among it; where nothing is known, the object is taken to lie towards the middle of all
/// that was drawn. Returns one sentence for each contour, contours counted from 1.
std::vector<std::string> find_sides(ContourSet& set);

}  // namespace kontur
