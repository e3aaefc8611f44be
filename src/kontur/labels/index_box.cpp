// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/index_box.h"

#include <algorithm>

namespace kontur {

bool IndexBox::contains(const Index3& at) const {
    for (int axis = 0; axis < 3; ++axis)
        if (at[axis] < low[axis] || at[axis] > high[axis]) return false;
    return true;
}

IndexBox IndexBox::padded(const Index3& margin, const Index3& size) const {
    IndexBox box;
    for (int axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::max<std::int64_t>(low[axis] - margin[axis], 0);
        box.high[axis] = std::min<std::int64_t>(high[axis] + margin[axis], size[axis] - 1);
    }
    return box;
}

Grid grid_of(const Grid& grid, const IndexBox& box) {
    Grid part{box.size(), grid.index_to_mm};
    part.index_to_mm.translation = grid.center_mm(box.low.i, box.low.j, box.low.k);
    return part;
}

}  // namespace kontur
