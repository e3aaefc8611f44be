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
    double drawn = 0;        ///< of all cells in the plane those inside what was drawn; 0: the plane tells nothing
};

/// `left_out`: the contours of the plane. Where one of them is open nothing is told.
WrongCells count_wrong(const ContourSet& left_out, const ImageCells& cells, const CellDepths& alone, const CellDepths& moved,
                       const VoxelWalk& walk);

WrongCells sum(std::span<const WrongCells> planes);

/// How much the walk counts in the result, the rest being the surface through the contours, moved as far as `moving`, 0 to
/// 1: the probability that it has fewer wrong cells than that, times the one that it has fewer than the contours alone, each
/// by the mean over planes, which are independent, as their cells are not. As far as moving has not shown yet that the image
/// helps, the walk has to: by one to two standard errors, and by a tenth of all wrong cells, give or take half of that. 0
/// where fewer than three planes tell.
double walk_weight(std::span<const WrongCells> planes, double moving);

}  // namespace kontur
