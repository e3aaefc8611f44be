// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "kontur/labels/label_boxes.h"
#include "kontur/shape/volume.h"

namespace kontur::app {

/// The voxels of several structures, one label in each.
class RoiLabelMap {
public:
    /// `smaller_first`: whether a voxel of two belongs to the smaller one; else to the one that was added first.
    RoiLabelMap(const Grid& grid, bool smaller_first)
        : grid_(grid), smaller_first_(smaller_first), labels_(static_cast<std::size_t>(grid.voxel_count())) {}

    /// Gives a structure's voxels its label, except those that others keep; `mask` lies on a box of the grid.
    void add(const Mask& mask, const IndexBox& box, std::uint16_t label);

    /// The first label lies inside the second: its voxels are its own.
    void set_inside(std::uint16_t inner, std::uint16_t outer) { inner_.insert({inner, outer}); }

    /// Voxels that structures share in another frame count in the notes, too.
    void add_shared(const RoiLabelMap& frame);

    /// In 8 bits where they suffice.
    Image image() const;

    /// One sentence for each pair that shares voxels; `names` are those of the labels 1, 2, ...
    std::vector<std::string> notes(const std::vector<std::string>& names) const;

private:
    using Pair = std::pair<std::uint16_t, std::uint16_t>;  ///< the label that was kept first

    bool keeps(std::uint16_t other, std::uint16_t label) const;

    Grid grid_;
    bool smaller_first_;
    std::vector<std::uint16_t> labels_;
    std::uint16_t most_ = 0;
    std::map<Pair, std::int64_t> shared_;
    std::set<Pair> inner_;
    std::map<std::uint16_t, std::int64_t> sizes_;  ///< voxels of each structure
};

}  // namespace kontur::app
