// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/ceded_voxels.h"

#include <cmath>
#include <cstdint>
#include <span>

#include "kontur/base/distance_transform.h"
#include "kontur/correct/mask_part.h"
#include "kontur/shape/inside_box.h"

namespace kontur {

std::vector<CededVoxel> ceded_voxels(const Mask& before, const Mask& after, const Work& work) {
    const Grid& grid = before.grid;
    const auto inside = inside_box(grid.size, std::span(before.values), [](std::uint8_t v) { return v != 0; });
    if (!inside) return {};
    const IndexBox box = inside->padded({1, 1, 1}, grid.size);
    const Index3 size = box.size();
    std::vector<std::uint8_t> left_out = part_of(before, box).values;
    for (std::uint8_t& value : left_out) value = value == 0;
    const DistanceTransform nearest = distance_transform(size, grid.spacing_mm(), left_out, work);
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
