// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/shape/contour.h"

namespace kontur {

/// How unsteady the hand was, told by contours in parallel planes, which never cross: the standard deviation in mm of
/// the drawn lines, at right angles to the surface. For each plane the line is compared with a straight continuation
/// from two others, up to two planes off on either side. Errors of shape grow with the gaps to the power of 1.55;
/// errors of the hand do not. They are the nugget of a variogram. Anatomy as fine as the gaps is taken for the hand,
/// too. Closed contours of the largest stack of parallel planes; 0 for fewer than four planes. Turns, moves and
/// scales with the contours. At most 24 planes of the stack are used. Source: Matheron, Principles of geostatistics,
/// 1963.
double parallel_hand_mm(const ContourSet& contours);

}  // namespace kontur
