// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/voxelize.h"

#include <functional>
#include <numeric>

#include "kontur/base/parallel.h"

namespace kontur {
namespace {

/// Marks, for every lattice edge along i that the surface cuts, the point behind the cut. Each such edge belongs to a cell
/// of the surface; beyond the grid no point needs a mark.
void mark_cuts(const SurfaceLattice& surface, Mask& mask) {
    for (const Index3& cell : surface.cells) {
        const unsigned inside = inside_corners(surface.lattice.corners(cell));
        for (const int corner : {0, 2, 4, 6}) {
            const bool is_cut = ((inside >> corner ^ inside >> (corner + 1)) & 1u) != 0;
            const Index3 behind = Lattice::corner(cell, corner + 1);
            if (is_cut && behind.i < mask.grid.size.i) mask.values[mask.grid.offset(behind.i, behind.j, behind.k)] = 1;
        }
    }
}

}  // namespace

std::string_view name(Voxelizer voxelizer) noexcept {
    switch (voxelizer) {
        case Voxelizer::adaptive:
            return "adaptive";
        case Voxelizer::tracked:
            return "tracked";
        case Voxelizer::exhaustive:
            return "exhaustive";
    }
    return "?";
}

Mask fill(const SurfaceLattice& surface, int threads) {
    const Grid& grid = surface.lattice.grid();
    Mask mask{grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()))};
    mark_cuts(surface, mask);
    parallel_for(grid.size.j * grid.size.k, 64, threads, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            const auto first = mask.values.begin() + row * grid.size.i;
            std::partial_sum(first, first + grid.size.i, first, std::bit_xor<>());
        }
    });
    return mask;
}

}  // namespace kontur
