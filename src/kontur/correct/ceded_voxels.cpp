// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/ceded_voxels.h"

#include <cmath>
#include <cstdint>
#include <span>

#include "kontur/base/distance_transform.h"
#include "kontur/shape/inside_box.h"

namespace kontur {
namespace {

/// Which voxels of a box of its grid a mask leaves out.
std::vector<std::uint8_t> left_out(const Mask& mask, const IndexBox& box) {
    std::vector<std::uint8_t> marked;
    marked.reserve(static_cast<std::size_t>(grid_of(mask.grid, box).voxel_count()));
    for (std::int64_t k = box.low.k; k <= box.high.k; ++k)
        for (std::int64_t j = box.low.j; j <= box.high.j; ++j)
            for (std::int64_t i = box.low.i; i <= box.high.i; ++i)
                marked.push_back(mask.values[mask.grid.offset(i, j, k)] == 0);
    return marked;
}

}  // namespace

std::vector<CededVoxel> ceded_voxels(const Mask& before, const Mask& after, const Work& work) {
    const Grid& grid = before.grid;
    const auto inside = inside_box(grid.size, std::span(before.values), [](std::uint8_t v) { return v != 0; });
    if (!inside) return {};
    const IndexBox box = inside->padded({1, 1, 1}, grid.size);
    const Index3 size = box.size();
    const DistanceTransform nearest = distance_transform(size, grid.spacing_mm(), left_out(before, box), work);
    const auto offset_of = [&](std::size_t in_box) {
        const Index3 at = index_at(in_box, size);
        return grid.offset(at.i + box.low.i, at.j + box.low.j, at.k + box.low.k);
    };
    std::vector<CededVoxel> ceded;
    for (std::size_t n = 0; n < nearest.nearest.size(); ++n) {
        const std::size_t offset = offset_of(n);
        if (before.values[offset] == 0 || after.values[offset] != 0 || !std::isfinite(nearest.distances[n])) continue;
        ceded.push_back({offset, offset_of(nearest.nearest[n])});
    }
    return ceded;
}

}  // namespace kontur
