// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/shape/volume.h"

namespace kontur {

inline constexpr std::uint8_t kShortest = 7;  ///< bits 0 to 2: along which axes the run is the shortest
inline constexpr std::uint8_t kSolid = 16;    ///< the runs along all axes are three voxels long or more

/// For each voxel of a mask that is set, by these bits, along which axes it lies in the shortest runs of set voxels; 0 for
/// the others. Runs of more than 65535 voxels count as that long. Time is linear in the voxels; takes two bytes for each one
/// that is set.
std::vector<std::uint8_t> shortest_runs(const Mask& mask);

}  // namespace kontur
