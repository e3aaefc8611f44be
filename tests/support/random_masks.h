// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

#include "kontur/shape/volume.h"
#include "support/random.h"

namespace kontur::test {

/// Each voxel is inside with the given probability.
inline Mask random_mask(const Grid& grid, double probability, std::mt19937& random) {
    Mask mask{grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()))};
    std::bernoulli_distribution inside(probability);
    for (std::uint8_t& value : mask.values) value = inside(random);
    return mask;
}

/// Voxels whose centres lie within `radius_mm` of `center`.
inline Mask ball_mask(const Grid& grid, const Vec3& center, double radius_mm) {
    Mask mask{grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()))};
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i)
                mask.values[grid.offset(i, j, k)] = distance(grid.center_mm(i, j, k), center) <= radius_mm;
    return mask;
}

}  // namespace kontur::test
