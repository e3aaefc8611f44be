// SPDX-License-Identifier: Apache-2.0
#include "roi_label_map.h"
#include "kontur/base/counted.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace kontur::app {

bool RoiLabelMap::keeps(std::uint16_t other, std::uint16_t label) const {
    if (inner_.contains({label, other})) return false;
    return !smaller_first_ || inner_.contains({other, label}) || sizes_.at(other) <= sizes_.at(label);
}

void RoiLabelMap::add(const Mask& mask, const IndexBox& box, std::uint16_t label) {
    sizes_[label] = std::count_if(mask.values.begin(), mask.values.end(), [](std::uint8_t v) { return v != 0; });
    std::size_t n = 0;
    for (std::int64_t k = box.low.k; k <= box.high.k; ++k)
        for (std::int64_t j = box.low.j; j <= box.high.j; ++j) {
            std::uint16_t* const row = labels_.data() + grid_.offset(0, j, k);
            for (std::int64_t i = box.low.i; i <= box.high.i; ++i) {
                if (mask.values[n++] == 0) continue;
                const std::uint16_t other = row[i];
                const bool is_kept = other != 0 && keeps(other, label);
                if (other != 0) ++shared_[is_kept ? Pair{other, label} : Pair{label, other}];
                if (!is_kept) row[i] = label;
            }
        }
    most_ = std::max(most_, label);
}

void RoiLabelMap::add_shared(const RoiLabelMap& frame) {
    for (const auto& [labels, voxels] : frame.shared_) shared_[labels] += voxels;
}

Image RoiLabelMap::image() const {
    if (most_ > std::numeric_limits<std::uint8_t>::max()) return {grid_, labels_};
    return {grid_, std::vector<std::uint8_t>(labels_.begin(), labels_.end())};
}

std::vector<std::string> RoiLabelMap::notes(const std::vector<std::string>& names) const {
    std::vector<std::string> notes;
    for (const auto& [labels, voxels] : shared_) {
        const char* const s = voxels == 1 ? "s" : "";
        notes.push_back(fmt::format(
            "{} of '{}' lie{} in '{}', too, and keep{} its label {}; a SEG (.dcm) or .seg.nrrd has room for both",
            counted(voxels, "voxel"), names[labels.second - 1u], s, names[labels.first - 1u], s, labels.first));
    }
    return notes;
}

}  // namespace kontur::app
