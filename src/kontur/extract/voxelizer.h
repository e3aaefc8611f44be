// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kontur {

enum class Voxelizer {
    adaptive,    ///< follow the surface from the contours on a coarse lattice, look finer where the sign is in doubt, fill
    tracked,     ///< follow the surface from the contours voxel by voxel, fill: the paper's
    exhaustive,  ///< evaluate every voxel: the oracle; keeps sheets and bubbles that no contour touches
};
std::string_view name(Voxelizer voxelizer) noexcept;

}  // namespace kontur
