// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <bitset>
#include <limits>
#include <memory>
#include <vector>

#include "kontur/shape/grid.h"

namespace kontur {

/// Values of a function at the voxel centres of a grid, known only where somebody asked: 8 x 8 x 8 blocks are allocated on
/// demand. Around the grid lies one layer of points that count as outside, so that every surface closes: indices run
/// from -1 to size along each axis. A cell (i, j, k) is the cube whose lowest corner is the point (i, j, k); cells run
/// from -1 to size - 1.
class Lattice {
public:
    static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    static constexpr double kOutside = -std::numeric_limits<double>::infinity();

    explicit Lattice(const Grid& grid);

    const Grid& grid() const { return grid_; }

    bool in_grid(const Index3& p) const {
        return p.i >= 0 && p.j >= 0 && p.k >= 0 && p.i < grid_.size.i && p.j < grid_.size.j && p.k < grid_.size.k;
    }
    bool is_cell(const Index3& c) const {
        return c.i >= -1 && c.j >= -1 && c.k >= -1 && c.i < grid_.size.i && c.j < grid_.size.j && c.k < grid_.size.k;
    }

    /// The value at a point; kOutside beyond the grid, NaN where nobody evaluated yet.
    double value(const Index3& p) const {
        if (!in_grid(p)) return kOutside;
        const Block* block = blocks_[block_of(p)].get();
        return block ? block->values[within(p)].load(std::memory_order_relaxed) : kUnknown;
    }
    void set_value(const Index3& p, double value) { block(p).values[within(p)].store(value, std::memory_order_relaxed); }

    /// Makes room for the values at the points from `low` to `high`, for set_reserved.
    void reserve(const Index3& low, const Index3& high);

    /// set_value for several threads at a time; if more than one sets the same point, then to the same value.
    void set_reserved(const Index3& p, double value) {
        blocks_[block_of(p)]->values[within(p)].store(value, std::memory_order_relaxed);
    }

    /// Marks a cell; true if it was not marked before.
    bool mark_cell(const Index3& c);

    /// Marks a point of the grid; true if it was not marked before. Independent of the cells' marks.
    bool mark_point(const Index3& p) {
        auto bit = block(p).marked_points[within(p)];
        if (bit) return false;
        bit = true;
        return true;
    }

    /// The values at the 8 corners; corner n is displaced by bit 0 of n along i, bit 1 along j, bit 2 along k.
    std::array<double, 8> corners(const Index3& c) const;

    static Index3 corner(const Index3& c, int n) { return {c.i + (n & 1), c.j + (n >> 1 & 1), c.k + (n >> 2 & 1)}; }

private:
    struct Block {
        std::array<std::atomic<double>, 512> values;
        std::bitset<512> marked_cells, marked_points;
        Block() {
            for (std::atomic<double>& value : values) value.store(kUnknown, std::memory_order_relaxed);
        }
    };

    std::size_t block_of(const Index3& p) const {
        return static_cast<std::size_t>((p.i >> 3) + blocks_along_.i * ((p.j >> 3) + blocks_along_.j * (p.k >> 3)));
    }
    static std::size_t within(const Index3& p) {
        return static_cast<std::size_t>((p.i & 7) + 8 * ((p.j & 7) + 8 * (p.k & 7)));
    }
    Block& block(const Index3& p);

    Grid grid_;
    Index3 blocks_along_;
    std::vector<std::unique_ptr<Block>> blocks_;
};

/// Bit n is set where corner n is inside (value > 0).
inline unsigned inside_corners(const std::array<double, 8>& corners) {
    unsigned bits = 0;
    for (unsigned n = 0; n < 8; ++n) bits |= static_cast<unsigned>(corners[n] > 0) << n;
    return bits;
}

}  // namespace kontur
