// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/base/work.h"
#include "kontur/drawing/boundary_point.h"
#include "kontur/shape/contour.h"

namespace kontur {

/// Sets every point's `gap_mm` and `depth_mm`: how far one may go from it along its outward normal and against it, within
/// its contour's plane, before the next line drawn in that plane, up to `reach_mm`; infinity beyond. The edges at the point
/// itself do not count. Contours share a plane within `tolerance_mm` (shared_planes). A point costs the logarithm of the
/// edges in its plane and those that lie as near as the line found.
void find_gaps(const ContourSet& set, double reach_mm, double tolerance_mm, std::vector<BoundaryPoint>& points,
               const Work& work = {});

}  // namespace kontur
