// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/drawing/drawing.h"
#include "kontur/fit/prepare.h"
#include "kontur/segment_options.h"
#include "kontur/shape/grid.h"

namespace kontur {

/// What the process will hold at most, in MB, when `segment` goes on from here: what it holds now, the solver's matrix,
/// values along a surface as large as the ellipsoid in the box of the drawing, the mask and the mesh. Meant to be above what
/// is then used, seldom more than three times as much; not a bound, because how the surface winds is known only when it has
/// been found.
double estimated_memory_mb(const Drawing& drawing, const PreparedContours& prepared, const Grid& grid,
                           const SegmentOptions& options);

/// Throws Error(too_large) with the estimate and the limit when a run would hold more than `options.max_memory_mb`.
void check_memory(double estimated_mb, const SegmentOptions& options);

}  // namespace kontur
