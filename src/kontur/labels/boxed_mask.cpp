// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/boxed_mask.h"
#include "kontur/shape/inside_box.h"

#include <algorithm>

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

BoxedMask trimmed(const BoxedMask& object, const Grid& grid) {
    std::optional<IndexBox> box = inside_box(object.mask);
    if (!box) box = IndexBox{};
    for (int axis = 0; axis < 3; ++axis) box->low[axis] += object.box.low[axis], box->high[axis] += object.box.low[axis];
    return part_of(object, *box, grid);
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
            IndexBox beside = b.box;  // where a voxel has one of b's beside it
            beside.low[axis] -= step, beside.high[axis] -= step;
            const auto common = common_box(a.box, beside);
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
