// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/mesh_grid.h"

#include <algorithm>
#include <cmath>

namespace kontur {
namespace {

constexpr std::int64_t kMargin = 2;           // voxels around the object: it may bulge between their centres
constexpr double kMostPoints = 4294967296.0;  // 2^32: the lattice's table of blocks then takes 64 MB

/// Voxels from `low` to `high`.
struct IndexBox {
    Index3 low, high;
};

/// Box of the surface's cells and of the starts, as indices of the grid.
Box3 index_box(const SurfaceLattice& surface, std::span<const Vec3> starts) {
    const Grid& grid = surface.lattice.grid();
    const Affine3 mm_to_index = grid.index_to_mm.inverse();
    Box3 box;
    for (const Index3& c : surface.cells) {
        box.extend({static_cast<double>(c.i), static_cast<double>(c.j), static_cast<double>(c.k)});
        box.extend({static_cast<double>(c.i + 1), static_cast<double>(c.j + 1), static_cast<double>(c.k + 1)});
    }
    for (const Vec3& p : starts)
        if (is_finite(p)) box.extend(mm_to_index.apply(p));
    return box;
}

/// The voxels of the grid in and around a box of indices that is not empty.
IndexBox voxels_around(const Box3& box, const Grid& grid) {
    IndexBox voxels;
    for (int axis = 0; axis < 3; ++axis) {
        const auto last = static_cast<double>(grid.size[axis] - 1);
        voxels.low[axis] =
            std::max<std::int64_t>(static_cast<std::int64_t>(std::clamp(std::floor(box.min[axis]), 0.0, last)) - kMargin, 0);
        voxels.high[axis] = std::min<std::int64_t>(
            static_cast<std::int64_t>(std::clamp(std::ceil(box.max[axis]), 0.0, last)) + kMargin, grid.size[axis] - 1);
    }
    return voxels;
}

/// The least odd numbers that make no part wider than the spacing; odd, so that a voxel's centre is one of its parts'.
Index3 parts(const Grid& grid, double spacing_mm) {
    constexpr double kMost = 500, kNoise = 1e-9;
    const Vec3 spacing = grid.spacing_mm();
    Index3 result;
    for (int axis = 0; axis < 3; ++axis) {
        const double pairs = std::ceil((spacing[axis] / spacing_mm - 1) / 2 - kNoise);
        result[axis] = 1 + 2 * static_cast<std::int64_t>(std::clamp(pairs, 0.0, kMost));
    }
    return result;
}

Grid split(const Grid& grid, const IndexBox& voxels, const Index3& parts) {
    Grid fine;
    Vec3 first;
    for (int axis = 0; axis < 3; ++axis) {
        const auto n = static_cast<double>(parts[axis]);
        fine.size[axis] = parts[axis] * (voxels.high[axis] - voxels.low[axis] + 1);
        fine.index_to_mm.set_column(axis, 1 / n * grid.index_to_mm.column(axis));
        first[axis] = static_cast<double>(voxels.low[axis]) - 0.5 + 0.5 / n;
    }
    fine.index_to_mm.translation = grid.index_to_mm.apply(first);
    return fine;
}

double point_count(const Grid& grid) {
    return static_cast<double>(grid.size.i) * static_cast<double>(grid.size.j) * static_cast<double>(grid.size.k);
}

}  // namespace

Grid mesh_grid(const SurfaceLattice& surface, std::span<const Vec3> starts, double spacing_mm) {
    const Grid& grid = surface.lattice.grid();
    const Box3 box = index_box(surface, starts);
    if (box.is_empty()) return grid;
    const IndexBox voxels = voxels_around(box, grid);
    for (;; spacing_mm *= 1.5) {
        const Index3 number = parts(grid, spacing_mm);
        if (number == Index3{1, 1, 1}) return grid;
        if (const Grid fine = split(grid, voxels, number); point_count(fine) <= kMostPoints) return fine;
    }
}

Grid with_split_voxels(const Grid& grid, double spacing_mm) {
    return split(grid, {{0, 0, 0}, {grid.size.i - 1, grid.size.j - 1, grid.size.k - 1}}, parts(grid, spacing_mm));
}

}  // namespace kontur
