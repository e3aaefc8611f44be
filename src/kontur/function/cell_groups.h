// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/function/kernel.h"
#include "kontur/function/point_arrays.h"
#include "kontur/function/split_kernel.h"

namespace kontur {

/// Points sorted into the cubes of a lattice through the origin.
struct CellGroups {
    std::vector<Index3> cells;        ///< cube (i, j, k) has its lowest corner at (i, j, k) * edge; in order of appearance
    std::vector<std::size_t> starts;  ///< members of cells[c]: order[starts[c]], ..., order[starts[c + 1] - 1]
    std::vector<std::size_t> order;   ///< indices of points
};

/// A cell's index as one number; each part needs less than 21 bits.
inline std::uint64_t cell_key(const Index3& cell) {
    constexpr std::int64_t bias = std::int64_t{1} << 20;
    return static_cast<std::uint64_t>((((cell.k + bias) << 21 | (cell.j + bias)) << 21) | (cell.i + bias));
}

/// Points must be less than 2^20 edges from the origin.
CellGroups group_by_cell(const PointArrays& points, double edge);

/// Centres and weights, stored cell by cell so that those near a box are a few runs in memory.
class SourceCells {
public:
    SourceCells(const PointArrays& centers, std::span<const double> weights, double edge);

    /// Replaces `sources`, whose memory is used again, by every centre within `radius` of the box and some others close by.
    void gather_near(const Vec3& box_min, const Vec3& box_max, double radius, NearSources& sources) const;

private:
    void append(std::size_t begin, std::size_t end, NearSources& sources) const;
    std::size_t start(std::int64_t i, std::int64_t j, std::int64_t k) const {
        return starts_[static_cast<std::size_t>(i + size_.i * (j + size_.j * k))];
    }

    double edge_;
    Index3 first_, size_;              ///< of the cells
    std::vector<std::size_t> starts_;  ///< of each cell's centres, i fastest
    NearSources sources_;
};

}  // namespace kontur
