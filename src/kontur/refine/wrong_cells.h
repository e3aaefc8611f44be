// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kontur/refine/voxel_walk.h"

namespace kontur {

/// How many cells in a drawn plane are on the wrong side by proposals that have not seen it.
struct WrongCells {
    double alone = 0;   ///< the surface through the contours of the other planes
    double moved = 0;   ///< the same, moved to where the image shows the border
    double walked = 0;  ///< the random walk
    double drawn = 0;   ///< of all cells in the plane those inside what was drawn; 0: the plane tells nothing
};

/// `left_out`: the contours of the plane. Where one of them is open nothing is told.
WrongCells count_wrong(const ContourSet& left_out, const ImageCells& cells, const CellDepths& alone, const CellDepths& moved,
                       const VoxelWalk& walk);

WrongCells sum(std::span<const WrongCells> planes);

/// Whether the walk has fewer wrong cells than chance makes of so few planes, which are independent, as their cells are not.
/// If the moved surface is to be used, half a standard error fewer than that and than the contours alone; otherwise the
/// image has not shown yet that it helps, and it has to be a whole one, and a tenth of all. Three planes at least have to
/// tell.
bool walk_helps(std::span<const WrongCells> planes, bool is_moved_used);

}  // namespace kontur
