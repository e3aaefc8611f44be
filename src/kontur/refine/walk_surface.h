// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/refine/refine.h"
#include "kontur/refine/voxel_walk.h"

namespace kontur {

/// What a walk on the image's cells needs besides the surface that it begins with.
struct WalkedImage {
    const ImageCells& cells;
    const Walls& walls;
    std::function<double(double distance_mm)> prior_mm;  ///< standard deviation of the surface so far from the contours
};

/// The surface of a random walk about the surface `begun` as one function that leaves the contours where they are: what the
/// walk tells is more data beside those of `fitted`, of one more solve. `begun` itself, with the verdict as it was or, where
/// that was not to use the image, astray, if no such function follows the walk.
RefinedFunction walk_surface(const WalkedImage& image, const Drawing& drawing, const PreparedContours& prepared,
                             const FittedFunction& fitted, const RefinedFunction& begun, const RefineOptions& options,
                             double voxel_mm, const Work& work);

}  // namespace kontur
