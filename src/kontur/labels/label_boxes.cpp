// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/label_boxes.h"

#include <algorithm>
#include <type_traits>
#include <variant>

namespace kontur {
namespace {

void extend(LabelBox& label_box, std::int64_t first, std::int64_t last, std::int64_t j, std::int64_t k) {
    if (label_box.voxels == 0) label_box.box = {{first, j, k}, {last, j, k}};
    label_box.box.low = {std::min(label_box.box.low.i, first), std::min(label_box.box.low.j, j),
                         std::min(label_box.box.low.k, k)};
    label_box.box.high = {std::max(label_box.box.high.i, last), std::max(label_box.box.high.j, j),
                          std::max(label_box.box.high.k, k)};
    label_box.voxels += last - first + 1;
}

}  // namespace

std::map<std::int64_t, LabelBox> label_boxes(const Image& labels, std::size_t max_labels) {
    check_image(labels);
    const Index3 size = labels.grid.size;
    std::map<std::int64_t, LabelBox> boxes;
    const auto look = [&](const auto& samples) {
        using Sample = typename std::decay_t<decltype(samples)>::value_type;
        const Sample* row = samples.data();
        for (std::int64_t k = 0; k < size.k; ++k)
            for (std::int64_t j = 0; j < size.j; ++j, row += size.i)
                for (std::int64_t i = 0; i < size.i;) {
                    const std::int64_t first = i;
                    const Sample value = row[i];
                    while (i < size.i && row[i] == value) ++i;
                    if (value == Sample{}) continue;
                    if constexpr (std::is_floating_point_v<Sample>) {
                        if (!(std::trunc(value) == value && std::abs(value) < 9e15F)) return false;
                    }
                    extend(boxes[static_cast<std::int64_t>(value)], first, i - 1, j, k);
                    if (boxes.size() > max_labels) return false;
                }
        return true;
    };
    if (!std::visit(look, labels.samples)) count_labels(labels, max_labels);  // says what is wrong
    return boxes;
}

Mask label_mask(const Image& labels, std::int64_t label, const IndexBox& box) {
    Mask mask{grid_of(labels.grid, box), {}};
    mask.values.reserve(static_cast<std::size_t>(mask.grid.voxel_count()));
    std::visit(
        [&](const auto& samples) {
            for (std::int64_t k = box.low.k; k <= box.high.k; ++k)
                for (std::int64_t j = box.low.j; j <= box.high.j; ++j) {
                    const auto* const row = samples.data() + labels.grid.offset(0, j, k);
                    for (std::int64_t i = box.low.i; i <= box.high.i; ++i)
                        mask.values.push_back(static_cast<std::int64_t>(row[i]) == label);
                }
        },
        labels.samples);
    return mask;
}

}  // namespace kontur
