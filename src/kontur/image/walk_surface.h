// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "kontur/image/follow_image.h"
#include "kontur/image/move_surface.h"
#include "kontur/image/voxel_walk.h"

namespace kontur {

/// What a walk on the image's cells needs besides the surface that it begins with.
struct WalkGround {
    const ImageCells& cells;
    const Walls& walls;
    const Beliefs& beliefs;
    double voxel_mm;  ///< of the image
};

/// The surface of a random walk about that of the fit, moved where there is a `start`, as one function that leaves the
/// contours where they are: what the walk tells is more data of one more solve. Nothing if no such function follows the
/// walk.
std::optional<ImageFit> walk_surface(const WalkGround& ground, const FittedDrawing& fit, const SurfaceMovement* start,
                                     const ImageOptions& options, const Work& work);

}  // namespace kontur
