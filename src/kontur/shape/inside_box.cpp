// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/inside_box.h"

#include <cstddef>

namespace kontur {

std::optional<IndexBox> inside_box(const Mask& mask) {
    return inside_box(mask.grid.size, std::span(mask.values), [](std::uint8_t v) { return v != 0; });
}

std::vector<std::uint8_t> object_voxels(const Mask& mask, const IndexBox& box) {
    const Index3 size = box.size(), whole = mask.grid.size;
    std::vector<std::uint8_t> inside(static_cast<std::size_t>(size.i * size.j * size.k));
    const std::int64_t first = std::max(box.low.i, std::int64_t{0}), last = std::min(box.high.i, whole.i - 1);
    if (first > last) return inside;
    for (std::int64_t k = std::max(box.low.k, std::int64_t{0}); k <= std::min(box.high.k, whole.k - 1); ++k)
        for (std::int64_t j = std::max(box.low.j, std::int64_t{0}); j <= std::min(box.high.j, whole.j - 1); ++j) {
            const auto* from = mask.values.data() + mask.grid.offset(first, j, k);
            auto* to = inside.data() + (first - box.low.i) + size.i * (j - box.low.j + size.j * (k - box.low.k));
            std::transform(from, from + (last - first + 1), to, [](std::uint8_t v) { return v != 0; });
        }
    return inside;
}

}  // namespace kontur
