// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/ceded_voxels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "kontur/base/distance_transform.h"
#include "kontur/correct/mask_part.h"
#include "kontur/shape/index_box.h"

namespace kontur {
namespace {

IndexBox box_of(std::span<const std::size_t> offsets, const Index3& size) {
    const Index3 first = index_at(offsets.front(), size);
    IndexBox box{first, first};
    for (const std::size_t offset : offsets) {
        const Index3 at = index_at(offset, size);
        box = box_around(box, {at, at});
    }
    return box;
}

/// The nearest ones in a box of the grid; nullopt where nearer ones, or any, may lie outside of it.
std::optional<std::vector<CededVoxel>> ceded_in(const IndexBox& box, double known_mm, const Mask& before,
                                                std::span<const std::size_t> left, const Work& work) {
    const Grid& grid = before.grid;
    std::vector<std::uint8_t> outside = part_of(before, box).values;
    for (std::uint8_t& value : outside) value = value == 0;
    const Index3 size = box.size();
    const DistanceTransform nearest = distance_transform(size, grid.spacing_mm(), outside, work);
    std::vector<CededVoxel> ceded;
    for (const std::size_t offset : left) {
        const Index3 at = index_at(offset, grid.size);
        const auto in_box =
            static_cast<std::size_t>(at.i - box.low.i + size.i * (at.j - box.low.j + size.j * (at.k - box.low.k)));
        if (nearest.distances[in_box] > known_mm) return std::nullopt;
        if (!std::isfinite(nearest.distances[in_box])) continue;
        const Index3 there = index_at(nearest.nearest[in_box], size);
        ceded.push_back({offset, grid.offset(there.i + box.low.i, there.j + box.low.j, there.k + box.low.k)});
    }
    return ceded;
}

}  // namespace

std::vector<CededVoxel> ceded_voxels(const Mask& before, std::span<const std::size_t> left, const Work& work) {
    if (left.empty()) return {};
    const Grid& grid = before.grid;
    const IndexBox box = box_of(left, grid.size);
    const double side_mm = smallest(grid.spacing_mm());
    for (std::int64_t pad = 4;; pad *= 2) {  // 2 and 8 find the same
        const IndexBox around = box.padded({pad, pad, pad}, grid.size);
        const bool is_whole = around.size() == grid.size;
        const double known_mm = is_whole ? std::numeric_limits<double>::infinity() : static_cast<double>(pad) * side_mm;
        if (auto ceded = ceded_in(around, known_mm, before, left, work)) return std::move(*ceded);
    }
}

std::vector<CededVoxel> ceded_voxels(const Mask& before, const Mask& after, const Work& work) {
    std::vector<std::size_t> left;
    for (std::size_t n = 0; n < before.values.size(); ++n)
        if (before.values[n] != 0 && after.values[n] == 0) left.push_back(n);
    return ceded_voxels(before, left, work);
}

}  // namespace kontur
