// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "kontur/shape/volume.h"

namespace kontur::test {

inline Grid index_grid(const Index3& size, const Vec3& spacing_mm = {1, 1, 1}) {
    Grid grid{size, {}};
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 step;
        step[axis] = spacing_mm[axis];
        grid.index_to_mm.set_column(axis, step);
    }
    return grid;
}

/// The label of each voxel by its index.
inline Image label_map(const Grid& grid, const std::function<int(const Index3&)>& label_at) {
    std::vector<std::uint8_t> samples;
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i) samples.push_back(static_cast<std::uint8_t>(label_at({i, j, k})));
    return {grid, samples};
}

inline const std::vector<std::uint8_t>& bytes_of_labels(const Image& labels) {
    return std::get<std::vector<std::uint8_t>>(labels.samples);
}

/// Whether a voxel lies in a ball, in index units.
inline bool is_in_ball(const Index3& at, const Vec3& center, double radius) {
    return distance({static_cast<double>(at.i), static_cast<double>(at.j), static_cast<double>(at.k)}, center) < radius;
}

}  // namespace kontur::test
