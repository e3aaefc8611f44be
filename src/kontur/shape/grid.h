// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "kontur/base/geometry.h"

namespace kontur {

/// A regular lattice of voxel centres: index (i, j, k), 0-based, maps to mm (LPS) by `index_to_mm`; index (0, 0, 0) is the
/// centre of the first voxel. Oblique, sheared, anisotropic and left-handed axes are all valid.
struct Grid {
    Index3 size;
    Affine3 index_to_mm;

    std::int64_t voxel_count() const { return size.i * size.j * size.k; }
    /// Offset of a voxel in a contiguous array with i fastest.
    std::size_t offset(std::int64_t i, std::int64_t j, std::int64_t k) const {
        return static_cast<std::size_t>(i + size.i * (j + size.j * k));
    }
    Vec3 center_mm(std::int64_t i, std::int64_t j, std::int64_t k) const {
        return index_to_mm.apply({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
    }
    /// Lengths in mm of one step along i, j, k.
    Vec3 spacing_mm() const;
    double voxel_volume_mm3() const { return std::abs(index_to_mm.determinant()); }
    /// Box in mm of the outer faces of all voxels.
    Box3 bounds_mm() const;

    friend bool operator==(const Grid&, const Grid&) = default;
};

/// Throws Error(invalid_input) for a size below 1, too many voxels for 64-bit indexing or a degenerate affine.
void check_grid(const Grid& grid);

/// An axis-aligned LPS grid with the given spacing (> 0, mm) whose voxels cover `box` with `margin_mm` to spare.
Grid grid_around(const Box3& box, const Vec3& spacing_mm, double margin_mm);

/// Largest distance in mm between the two grids' corner voxels; infinity if the sizes differ.
double corner_distance_mm(const Grid& a, const Grid& b);

}  // namespace kontur
