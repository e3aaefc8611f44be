// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "kontur/shape/index_box.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// The box and the number of voxels of one label.
struct LabelBox {
    IndexBox box;
    std::int64_t voxels = 0;
};

/// Those of every label other than 0, in one pass. Throws Error(invalid_input) as count_labels does.
std::map<std::int64_t, LabelBox> label_boxes(const Image& labels, std::size_t max_labels = 4096);

/// The voxels of one label in a box, on the box's grid.
Mask label_mask(const Image& labels, std::int64_t label, const IndexBox& box);

}  // namespace kontur
