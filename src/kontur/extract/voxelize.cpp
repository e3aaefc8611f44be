// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/voxelize.h"

#include <cstring>

#include "kontur/base/parallel.h"

namespace kontur {
namespace {

/// Marks, for every lattice edge along i that the surface cuts, the point behind the cut. The cell of which the edge is the
/// lowest is among the surface's; beyond the grid no point needs a mark.
void mark_cuts(const SurfaceLattice& surface, const Work& work, Mask& mask) {
    parallel_for(static_cast<std::int64_t>(surface.cells.size()), 4096, work, [&](std::int64_t begin, std::int64_t end) {
        for (; begin < end; ++begin) {
            const Index3& cell = surface.cells[static_cast<std::size_t>(begin)];
            const Index3 behind = Lattice::corner(cell, 1);
            if (behind.i >= mask.grid.size.i || cell.j < 0 || cell.k < 0) continue;
            if ((surface.lattice.value(cell) > 0) != (surface.lattice.value(behind) > 0))
                mask.values[mask.grid.offset(behind.i, behind.j, behind.k)] = 1;
        }
    });
}

/// Inside is what lies behind an odd number of marks.
void fill_row(std::uint8_t* at, std::uint8_t* end) {
    const auto next_mark = [&](std::uint8_t* from) {
        void* first = from < end ? std::memchr(from, 1, static_cast<std::size_t>(end - from)) : nullptr;
        return first ? static_cast<std::uint8_t*>(first) : end;
    };
    while ((at = next_mark(at)) < end) {
        std::uint8_t* const out = next_mark(at + 1);
        std::memset(at, 1, static_cast<std::size_t>(out - at));
        if (out < end) *out = 0;
        at = out + 1;
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

Mask fill(const SurfaceLattice& surface, const Work& work) {
    const Grid& grid = surface.lattice.grid();
    Mask mask{grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()))};
    mark_cuts(surface, work, mask);
    parallel_for(grid.size.j * grid.size.k, 64, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            std::uint8_t* const first = mask.values.data() + row * grid.size.i;
            fill_row(first, first + grid.size.i);
        }
    });
    return mask;
}

}  // namespace kontur
