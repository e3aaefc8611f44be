// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kontur/image/voxel_walk.h"

namespace kontur {

/// How many cells in a drawn plane are on the wrong side by proposals that have not seen it.
struct WrongCells {
    double by_contours = 0;  ///< the surface through the contours of the other planes
    double by_movement = 0;  ///< the same, moved to where the image shows the border
    double by_walk = 0;      ///< the random walk
    double inside = 0;       ///< of all cells in the plane those inside what was drawn; 0: the plane tells nothing
};

/// `left_out`: the contours of the plane. Where one of them is open nothing is told.
WrongCells count_wrong(const ContourSet& left_out, const ImageCells& cells, const CellDepths& by_contours,
                       const CellDepths& by_movement, const VoxelWalk& by_walk);

WrongCells sum(std::span<const WrongCells> planes);

/// How much the walk counts in the result, from 0 to 1. The rest is the surface through the contours, moved as far as
/// `moving`, 0 to 1. The weight is the probability that the walk has fewer wrong cells than that surface, times the
/// probability that it has fewer than the contours alone. Both are of the mean over planes, which are independent; cells are
/// not. Without help shown by moving, the walk has to show it: by one to two standard errors, and by about a tenth of all
/// wrong cells. 0 where fewer than three planes tell.
double walk_weight(std::span<const WrongCells> planes, double moving);

}  // namespace kontur
