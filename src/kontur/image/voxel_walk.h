// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/image/cell_depths.h"

namespace kontur {

/// What is inside by a random walk on the image's cells, in a band about a surface.
struct VoxelWalk {
    std::vector<float> inside;        ///< of each cell the probability; 0 or 1 beyond the band
    std::vector<std::uint32_t> band;  ///< its cells, in memory order

    bool is_inside(std::size_t cell) const { return inside[cell] > 0.5F; }
};

/// What a walk has to know besides cells and depths.
struct WalkOptions {
    const Walls& walls;
    std::function<double(double distance_mm)> prior_mm;  ///< standard deviation of the surface so far from the contours
    double diameter_mm;                                  ///< of the drawing
    CellSlab near{};                                     ///< the band ends there, too
};

/// Seeds are the cells of the drawn planes and all beyond the band, which is as wide as errors of three standard deviations;
/// a step is the less likely the more the cells' looks differ; and each cell is tied to what its depth and its look say:
/// walks end there, too. Parts that hang together with no seed of their side are left out.
VoxelWalk walk_voxels(const ImageCells& cells, const CellDepths& depths, const WalkOptions& options, const Work& work = {});

}  // namespace kontur
