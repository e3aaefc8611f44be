// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "kontur/base/geometry.h"
#include "kontur/shape/grid.h"

namespace kontur {

/// A box of voxels, both ends included.
struct IndexBox {
    Index3 low, high;

    Index3 size() const { return {high.i - low.i + 1, high.j - low.j + 1, high.k - low.k + 1}; }
    bool contains(const Index3& at) const;
    /// Grown on both sides by `margin` along each axis, within a grid of `size`.
    IndexBox padded(const Index3& margin, const Index3& size) const;
};

/// The grid of the voxels of a box.
Grid grid_of(const Grid& grid, const IndexBox& box);

/// The box of `grid` whose grid (grid_of) `part` is.
IndexBox box_of_part(const Grid& grid, const Grid& part);

/// The voxels that two boxes share.
std::optional<IndexBox> common_box(const IndexBox& a, const IndexBox& b);

/// Around both boxes.
IndexBox box_around(const IndexBox& a, const IndexBox& b);

/// The voxels of a grid whose centres lie in a box in mm, and one more on each side; nullopt if the grid has none there.
std::optional<IndexBox> index_box(const Grid& grid, const Box3& box_mm);

}  // namespace kontur
