// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

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

}  // namespace kontur
