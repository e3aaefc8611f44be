// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/index_box.h"

#include <algorithm>
#include <cmath>

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

std::optional<IndexBox> common_box(const IndexBox& a, const IndexBox& b) {
    IndexBox common;
    for (int axis = 0; axis < 3; ++axis) {
        common.low[axis] = std::max(a.low[axis], b.low[axis]);
        common.high[axis] = std::min(a.high[axis], b.high[axis]);
        if (common.low[axis] > common.high[axis]) return std::nullopt;
    }
    return common;
}

IndexBox box_around(const IndexBox& a, const IndexBox& b) {
    IndexBox around;
    for (int axis = 0; axis < 3; ++axis) {
        around.low[axis] = std::min(a.low[axis], b.low[axis]);
        around.high[axis] = std::max(a.high[axis], b.high[axis]);
    }
    return around;
}

std::optional<IndexBox> index_box(const Grid& grid, const Box3& box_mm) {
    const Affine3 to_index = grid.index_to_mm.inverse();
    Box3 indices;
    for (int corner = 0; corner < 8; ++corner)
        indices.extend(to_index.apply({corner & 1 ? box_mm.max.x : box_mm.min.x, corner & 2 ? box_mm.max.y : box_mm.min.y,
                                       corner & 4 ? box_mm.max.z : box_mm.min.z}));
    IndexBox box;
    for (int axis = 0; axis < 3; ++axis) {
        const auto last = static_cast<double>(grid.size[axis] - 1);
        const double low = std::floor(indices.min[axis]), high = std::ceil(indices.max[axis]);
        if (!(low <= last && high >= 0)) return std::nullopt;
        box.low[axis] = static_cast<std::int64_t>(std::max(low, 0.0));
        box.high[axis] = static_cast<std::int64_t>(std::min(high, last));
    }
    return box;
}

IndexBox box_of_part(const Grid& grid, const Grid& part) {
    const Vec3 first = grid.index_to_mm.inverse().apply(part.center_mm(0, 0, 0));
    IndexBox box{{std::llround(first.x), std::llround(first.y), std::llround(first.z)}, {}};
    for (int axis = 0; axis < 3; ++axis) box.high[axis] = box.low[axis] + part.size[axis] - 1;
    return box;
}

}  // namespace kontur
