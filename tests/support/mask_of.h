// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "kontur/shape/volume.h"

namespace kontur::test {

/// Marks the voxels whose centre in mm is `inside`.
inline Mask mask_of(const Grid& grid, const std::function<bool(const Vec3&)>& inside) {
    Mask mask{grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()))};
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i)
                mask.values[grid.offset(i, j, k)] = inside(grid.center_mm(i, j, k));
    return mask;
}

}  // namespace kontur::test
