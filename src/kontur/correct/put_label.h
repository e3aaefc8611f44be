// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// Voxels that went from one label of a map to another.
struct PassedVoxels {
    std::int64_t from = 0, to = 0;
    std::size_t count = 0;

    friend bool operator==(const PassedVoxels&, const PassedVoxels&) = default;
};

/// A label map with one label corrected.
struct PutLabel {
    Image labels;
    std::vector<PassedVoxels> passed;  ///< first what the label took, then what it gave; by label
};

/// A label's mask before and after a correction, both on the grid of its map.
struct LabelChange {
    std::int64_t label = 1;
    const Mask& before;
    const Mask& after;
};

/// Puts a corrected label into its map: its new voxels get it, whosever they were, and those that it left become 0. With
/// `shared_borders` those that it left go to the label that it touched there (see `ceded_voxels`). All others keep their
/// values. Throws Error(invalid_input) where the masks and the map have different grids, and for a label that the map's
/// values have no room for.
PutLabel put_label(Image labels, const LabelChange& change, bool shared_borders = false, const Work& work = {});

}  // namespace kontur
