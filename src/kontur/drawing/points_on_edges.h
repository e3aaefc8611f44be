// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/shape/contour.h"

namespace kontur {

/// Without points that lie on the straight way between those before and after them, up to `tolerance_mm`: how many of them
/// an edge has says nothing of the line. Begins at the first point, which stays, as the ends of an open line do.
Contour without_points_on_edges(const Contour& contour, double tolerance_mm);

}  // namespace kontur
