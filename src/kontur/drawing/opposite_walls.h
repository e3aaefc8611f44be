// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/drawing/boundary_point.h"
#include "kontur/drawing/prepared_line.h"

namespace kontur {

/// Sets every point's `gap_mm` and `depth_mm`: how far one may go from it along its outward normal and against it, within
/// its contour's plane, before the next line drawn in that plane, up to `reach_mm`; infinity beyond. The edges at the point
/// itself do not count. Contours share a plane within `tolerance_mm` (shared_planes). A point costs the logarithm of the
/// edges in its plane and those that lie as near as the line found.
/// A point's contour is the place of its line.
void find_opposite_walls(std::span<const PreparedLine> lines, double reach_mm, double tolerance_mm,
                         std::vector<BoundaryPoint>& points, const Work& work = {});

/// Subdivides edges of the fitted lines where points as far apart as elsewhere would let f leave the drawn line. Pieces are
/// halved, as long as the halves are not too short,
/// - along thin parts and clefts, until one is no longer than the way across it, to the next line drawn in its plane;
/// - between corners that turn the same way, at the end of a thin part: until the arc with the turns of a piece's ends, half
///   of each, stands out from it by `bulge_mm` at most.
/// Contours share a plane within `tolerance_mm`.
void subdivide_narrow(std::span<PreparedLine> lines, double bulge_mm, double tolerance_mm, const Work& work = {});

}  // namespace kontur
