// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/base/work.h"
#include "kontur/drawing/drawing.h"
#include "kontur/fit/fit.h"
#include "kontur/fit/prepare.h"
#include "kontur/fit/sides.h"
#include "kontur/image/follow_image.h"
#include "kontur/image/part_fits.h"
#include "kontur/segment_options.h"

namespace kontur {

/// The options of `segment` for its first stages, with all lengths given.
struct StageOptions {
    PrepareOptions prepare;
    FitOptions fit;
};

/// Throws Error(invalid_input) for what check_fit_options refuses.
StageOptions stage_options(const SegmentOptions& options, double diameter_mm);

/// Every few of each contour's points, about `most` in all, though no fewer than 48 of a contour that has as many: preparing
/// contours and reading the surface's tilt costs as much as there are points.
ContourSet thinned(ContourSet set, std::size_t most);

/// f through a part of the contours, from about as many of its points as show the tilts: for how the surface runs between
/// planes that will do.
ImplicitFunction fit_coarsely(const ContourSet& part, const StageOptions& options, const Work& work = {});

/// The fit, moved between the contours to where the image shows the border, where it helps; else as it came. Parts of the
/// drawing that `part_fits` has are not fitted again.
ImageFit follow_image(const FittedDrawing& fit, const Image& image, const StageOptions& options, const Work& work = {},
                      PartFits* part_fits = nullptr);

/// Where the surface is known to pass: every drawn point and point of the fit, each edge of each lobe where contours cross
/// themselves, a place near each exterior point that only just got its side, for it may have made a cavity, and places
/// towards which f leads from contours that the surface misses altogether, by `margin_mm` (0: not looked for). Not near
/// interior points: beside the contours nothing bounds what they make.
std::vector<Vec3> start_points(const ContourSet& contours, const PreparedContours& prepared,
                               const ImplicitFunction& function, double margin_mm);

}  // namespace kontur
