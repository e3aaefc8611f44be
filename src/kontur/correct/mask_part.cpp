// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/mask_part.h"

#include <cstddef>
#include <cstdint>

namespace kontur {

Mask part_of(const Mask& mask, const IndexBox& box) {
    Mask part{grid_of(mask.grid, box), {}};
    part.values.reserve(static_cast<std::size_t>(part.grid.voxel_count()));
    for (std::int64_t k = box.low.k; k <= box.high.k; ++k)
        for (std::int64_t j = box.low.j; j <= box.high.j; ++j) {
            const auto row = mask.values.begin() + static_cast<std::ptrdiff_t>(mask.grid.offset(box.low.i, j, k));
            part.values.insert(part.values.end(), row, row + box.size().i);
        }
    return part;
}

}  // namespace kontur
