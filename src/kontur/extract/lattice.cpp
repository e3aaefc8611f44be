// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/lattice.h"

namespace kontur {

// Points are shifted by one so that the lowest cells, at index -1, have room in the blocks as well.
Lattice::Lattice(const Grid& grid)
    : grid_(grid), blocks_along_{grid.size.i / 8 + 1, grid.size.j / 8 + 1, grid.size.k / 8 + 1} {
    check_grid(grid);
    blocks_.resize(static_cast<std::size_t>(blocks_along_.i * blocks_along_.j * blocks_along_.k));
}

Lattice::Block& Lattice::block(const Index3& p) {
    auto& slot = blocks_[block_of(p)];
    if (!slot) slot = std::make_unique<Block>();
    return *slot;
}

void Lattice::reserve(const Index3& low, const Index3& high) {
    for (std::int64_t k = low.k >> 3; k <= high.k >> 3; ++k)
        for (std::int64_t j = low.j >> 3; j <= high.j >> 3; ++j)
            for (std::int64_t i = low.i >> 3; i <= high.i >> 3; ++i) block({8 * i, 8 * j, 8 * k});
}

bool Lattice::mark_cell(const Index3& c) {
    const Index3 shifted{c.i + 1, c.j + 1, c.k + 1};
    auto bit = block(shifted).marked_cells[within(shifted)];
    if (bit) return false;
    bit = true;
    return true;
}

std::array<double, 8> Lattice::corners(const Index3& c) const {
    std::array<double, 8> result;
    const Index3 last = corner(c, 7);
    if (in_grid(c) && in_grid(last) && block_of(c) == block_of(last)) {
        const Block* block = blocks_[block_of(c)].get();
        if (!block) return {kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
        const auto at = [v = block->values.data() + within(c)](int n) { return v[n].load(std::memory_order_relaxed); };
        return {at(0), at(1), at(8), at(9), at(64), at(65), at(72), at(73)};
    }
    for (int n = 0; n < 8; ++n) result[static_cast<std::size_t>(n)] = value(corner(c, n));
    return result;
}

}  // namespace kontur
