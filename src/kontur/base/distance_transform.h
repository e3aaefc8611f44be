// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kontur/base/geometry.h"

namespace kontur {

/// Of each point of a lattice the nearest marked one.
struct NearestMarked {
    std::vector<float> steps;  ///< to it, in steps of the lattice, which are alike along its axes; infinity without one
    std::vector<std::uint32_t> nearest;  ///< its offset, i fastest
};

/// Exact; of several as near one of them. The cost is the lattice's size (Felzenszwalb and Huttenlocher 2012). Of fewer than
/// 2^32 points.
NearestMarked nearest_marked(const Index3& size, std::span<const std::uint8_t> marked);

}  // namespace kontur
