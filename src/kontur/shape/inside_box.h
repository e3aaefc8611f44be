// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kontur/shape/index_box.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// The smallest box around the voxels of a lattice whose value is inside. Indices count from 0, `i` fastest in `values`.
/// nullopt where no voxel is inside.
template <class Value, class IsInside>
std::optional<IndexBox> inside_box(const Index3& size, std::span<const Value> values, const IsInside& is_inside) {
    std::optional<IndexBox> box;
    for (std::int64_t k = 0; k < size.k; ++k)
        for (std::int64_t j = 0; j < size.j; ++j) {
            const Value* row = values.data() + size.i * (j + size.j * k);
            const Value* first = std::find_if(row, row + size.i, is_inside);
            if (first == row + size.i) continue;
            const Value* last = row + size.i - 1;
            while (!is_inside(*last)) --last;
            const IndexBox run{{first - row, j, k}, {last - row, j, k}};
            box = box ? box_around(*box, run) : run;
        }
    return box;
}

/// The smallest box around the object of a mask; nullopt where it is empty.
std::optional<IndexBox> inside_box(const Mask& mask);

/// Which voxels of a box lie inside: 1 or 0, `i` fastest. Beyond the mask's grid none does.
std::vector<std::uint8_t> object_voxels(const Mask& mask, const IndexBox& box);

}  // namespace kontur
