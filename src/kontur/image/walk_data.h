// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/image/refit.h"
#include "kontur/image/voxel_walk.h"

namespace kontur {

struct WalkDataOptions {
    double off_contours = 1;  ///< cells: what is nearer to the contours is left to them
    double noise = 1;         ///< factor
    std::size_t most = 2000;  ///< cells beside the walk's surface
};

/// A walk, and how deep its cells lie below its surface (depths_below).
struct WalkDepths {
    const VoxelWalk& walk;
    const Depths& depths;
    const ImageCells& cells;
};

/// A fit to the contours alone, and how the cells lie to its surface.
struct FitDepths {
    const FittedFunction& fitted;
    const CellDepths& depths;
};

/// What a walk tells a fit. Cells on both sides of its surface have depths, by where the probability
/// passes one half, as steep as f is there; their noise is .03 cells where it falls steeply, else more.
/// In drawn planes f stays as it was along the lines, and where the walk's surface comes near them beside
/// the lines. The result refers to the walk and the fit.
ImageData walk_data(const WalkDepths& walk, const FitDepths& alone, const Drawing& drawing, const WalkDataOptions& options,
                    const Work& work = {});

/// Of each cell below the surface of the walk; above it less than 0.
Depths depths_below(const VoxelWalk& walk, const ImageCells& cells);

}  // namespace kontur
