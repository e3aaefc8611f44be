// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/boxed_mask.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kontur {
namespace {

/// Calls visit(index) for all voxels of a box, in memory order.
template <class Visit>
void for_each_voxel(const IndexBox& box, const Visit& visit) {
    for (std::int64_t k = box.low.k; k <= box.high.k; ++k)
        for (std::int64_t j = box.low.j; j <= box.high.j; ++j)
            for (std::int64_t i = box.low.i; i <= box.high.i; ++i) visit(Index3{i, j, k});
}

/// The part of an object that lies in a box, on that box.
BoxedMask part_of(const BoxedMask& object, const IndexBox& box, const Grid& grid) {
    BoxedMask part{box, {grid_of(grid, box), {}}};
    part.mask.values.resize(static_cast<std::size_t>(part.mask.grid.voxel_count()));
    const auto common = common_box(object.box, box);
    if (!common) return part;
    const auto row = [](const BoxedMask& of, std::int64_t i, std::int64_t j, std::int64_t k) {
        return static_cast<std::ptrdiff_t>(of.mask.grid.offset(i - of.box.low.i, j - of.box.low.j, k - of.box.low.k));
    };
    for (std::int64_t k = common->low.k; k <= common->high.k; ++k)
        for (std::int64_t j = common->low.j; j <= common->high.j; ++j)
            std::copy_n(object.mask.values.begin() + row(object, common->low.i, j, k), common->size().i,
                        part.mask.values.begin() + row(part, common->low.i, j, k));
    return part;
}

}  // namespace

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

BoxedMask trimmed(const BoxedMask& object, const Grid& grid) {
    std::optional<IndexBox> found;
    std::size_t n = 0;
    for_each_voxel(object.box, [&](const Index3& at) {
        if (!object.mask.values[n++]) return;
        found = found ? box_around(*found, {at, at}) : IndexBox{at, at};
    });
    return part_of(object, found.value_or(IndexBox{object.box.low, object.box.low}), grid);
}

BoxedMask widened(const BoxedMask& object, const IndexBox& box, const Grid& grid) { return part_of(object, box, grid); }

std::vector<Index3> shared_voxels(const BoxedMask& a, const BoxedMask& b) {
    std::vector<Index3> both;
    if (const auto common = common_box(a.box, b.box))
        for_each_voxel(*common, [&](const Index3& at) {
            if (a.contains(at) && b.contains(at)) both.push_back(at);
        });
    return both;
}

bool have_common_face(const BoxedMask& a, const BoxedMask& b) {
    for (int axis = 0; axis < 3; ++axis)
        for (const std::int64_t step : {-1, 1}) {
            IndexBox moved = b.box;  // where a voxel has one of b's beside it
            moved.low[axis] -= step, moved.high[axis] -= step;
            const auto common = common_box(a.box, moved);
            if (!common) continue;
            for (std::int64_t k = common->low.k; k <= common->high.k; ++k)
                for (std::int64_t j = common->low.j; j <= common->high.j; ++j)
                    for (std::int64_t i = common->low.i; i <= common->high.i; ++i) {
                        Index3 beside{i, j, k};
                        beside[axis] += step;
                        if (a.contains({i, j, k}) && b.contains(beside)) return true;
                    }
        }
    return false;
}

}  // namespace kontur
