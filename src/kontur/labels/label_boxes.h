// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "kontur/base/geometry.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// A box of voxels, both ends included.
struct IndexBox {
    Index3 low, high;

    Index3 size() const { return {high.i - low.i + 1, high.j - low.j + 1, high.k - low.k + 1}; }
    bool contains(const Index3& at) const;
    /// Grown on both sides by `margin` along each axis, within a grid of `size`.
    IndexBox padded(const Index3& margin, const Index3& size) const;
};

/// The box and the number of voxels of one label.
struct LabelBox {
    IndexBox box;
    std::int64_t voxels = 0;
};

/// Those of every label other than 0, in one pass. Throws Error(invalid_input) as count_labels does.
std::map<std::int64_t, LabelBox> label_boxes(const Image& labels, std::size_t max_labels = 4096);

/// The grid of the voxels of a box.
Grid grid_of(const Grid& grid, const IndexBox& box);

/// The voxels of one label in a box, on the box's grid.
Mask label_mask(const Image& labels, std::int64_t label, const IndexBox& box);

}  // namespace kontur
