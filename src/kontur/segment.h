// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"
#include "kontur/sampling/surface_samples.h"
#include "kontur/segment_options.h"
#include "kontur/segment_report.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/mesh.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// A mask on the grid, the function that it was made from, the surface where it was asked for, and some points of it.
struct Segmentation {
    Mask mask;
    ImplicitFunction function;
    std::optional<TriangleMesh> mesh;
    SegmentReport report;
    SurfaceSamples samples;
};

/// Contours to mask (and mesh) on a grid. With `use_image` the image tells, where it helps, how the surface runs between the
/// contours; without one they do alone. Throws Error as check_contours, check_contours_inside, solve and check_grid do,
/// and Error(too_large) with the estimate for a run beyond `max_memory_mb`. The same bytes for any number of threads.
Segmentation segment(const ContourSet& contours, const Grid& grid, const SegmentOptions& options = {},
                     const Work& work = {});
Segmentation segment(const ContourSet& contours, const Grid& grid, const Image* image, const SegmentOptions& options = {},
                     const Work& work = {});

}  // namespace kontur
