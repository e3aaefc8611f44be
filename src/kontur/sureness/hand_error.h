// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/shape/contour.h"

namespace kontur {

/// How unsteady the hand was, told by contours in parallel planes, which never cross: standard deviation in mm of the drawn
/// lines, at right angles to the surface. Of each plane it is known how far its line is from where two others, up to two
/// planes off on either side, lead a straight line through it. As far as that is the shape, it grows with the gaps between
/// them to the power of 1.55; as far as it is the hand, it does not: the nugget of a variogram. Anatomy as fine as the gaps
/// is taken for the hand, too. Closed contours of the largest stack of parallel planes; 0 for fewer than four of these, of
/// which too little is known. Turns, moves and scales with the contours. At most 24 planes of the stack are looked at.
/// Source: Matheron, Principles of geostatistics, 1963.
double parallel_hand_mm(const ContourSet& contours);

}  // namespace kontur
