// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: planes for contours that come without.

#include <vector>

#include "kontur/shape/contour.h"

namespace kontur {

/// Sets the plane of each contour: that of a larger contour if all points lie on it within `tolerance_mm`, else a plane
/// parallel to that of a larger one under the same condition, else the best fit. So the contours of one slice share one
/// plane, and a tiny contour does not get a tilted one. The best fit of points on one line
/// (an open contour may be straight) is the plane across z.
void assign_planes(std::vector<Contour>& contours, double tolerance_mm);

}  // namespace kontur
