// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/drawing/boundary_point.h"
#include "kontur/drawing/drawn_planes.h"

namespace kontur {

/// Leaves out the points of lines that are no border in their own plane: where contours touch or overlap, or one runs back
/// along itself, the object lies on both sides of a line, and where a hole leaves the object, on neither. A cleft of up to
/// `cleft_mm` times the point's extent is none. What remains of a ring is open lines; their first and last point, where
/// the border turns onto another line, have no direction.
void leave_out_inner_lines(const DrawnPlanes& planes, double cleft_mm, std::vector<BoundaryPoint>& points);

}  // namespace kontur
