// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/voxelize.h"

#include <algorithm>

#include "kontur/base/parallel.h"

namespace kontur {
namespace {

void fill_row(const Lattice& lattice, std::int64_t j, std::int64_t k, std::uint8_t* row) {
    const std::int64_t width = lattice.grid().size.i;
    std::uint8_t inside = 0;
    for (std::int64_t begin = 0; begin < width; begin += 8) {
        const std::int64_t end = std::min(begin + 8, width);
        const double* values = lattice.row_of_block({begin, j, k});
        for (std::int64_t i = begin; i < end; ++i) {
            if (values && !std::isnan(values[i - begin])) inside = values[i - begin] > 0;
            row[i] = inside;
        }
    }
}

}  // namespace

std::string_view name(Voxelizer voxelizer) noexcept { return voxelizer == Voxelizer::tracked ? "tracked" : "exhaustive"; }

Mask fill(const SurfaceLattice& surface, int threads) {
    const Grid& grid = surface.lattice.grid();
    Mask mask{grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()))};
    parallel_for(grid.size.k, 1, threads, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t k = begin; k < end; ++k)
            for (std::int64_t j = 0; j < grid.size.j; ++j)
                fill_row(surface.lattice, j, k, &mask.values[grid.offset(0, j, k)]);
    });
    return mask;
}

}  // namespace kontur
