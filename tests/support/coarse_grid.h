// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/shape/volume.h"

namespace kontur::test {

/// Every `step`-th voxel centre of a grid.
inline Grid coarse(Grid grid, std::int64_t step) {
    for (int axis = 0; axis < 3; ++axis) {
        grid.size[axis] = (grid.size[axis] + step - 1) / step;
        grid.index_to_mm.set_column(axis, static_cast<double>(step) * grid.index_to_mm.column(axis));
    }
    return grid;
}

/// 2 |A and B| / (|A| + |B|) over all voxels.
inline double dice(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    std::int64_t both = 0, sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        both += a[i] != 0 && b[i] != 0;
        sum += (a[i] != 0) + (b[i] != 0);
    }
    return 2.0 * static_cast<double>(both) / static_cast<double>(sum);
}

}  // namespace kontur::test
