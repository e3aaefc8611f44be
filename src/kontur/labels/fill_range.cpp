// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/fill_range.h"

#include <algorithm>
#include <cmath>

namespace kontur {

double largest_gap_mm(const PaintedObject& object) {
    double gap = 0;
    const Vec3 spacing = object.grid.spacing_mm();
    for (std::size_t n = 1; n < object.slices.size(); ++n) {
        const PaintedSlice &low = object.slices[n - 1], &high = object.slices[n];
        if (low.axis == high.axis) gap = std::max(gap, spacing[low.axis] * static_cast<double>(high.index - low.index));
    }
    return gap;
}

IndexBox range_to_fill(const PaintedObject& object, const Grid& image, double gaps_beyond) {
    const Vec3 spacing = image.spacing_mm();
    const IndexBox& box = object.found.box;
    const int axis = object.only_axis();
    // Between parallel slices the object may be wider than on them, by less than they are apart. Slices of several
    // directions show its extent; between them it bulges.
    const double gap_mm = largest_gap_mm(object);
    Index3 margin;
    for (int a = 0; a < 3; ++a) {
        const double bulge_mm = axis >= 0 ? gap_mm : 0.25 * spacing[a] * static_cast<double>(box.size()[a]);
        margin[a] = 3 + static_cast<std::int64_t>(std::ceil(bulge_mm / spacing[a]));
    }
    IndexBox range = box.padded(margin, image.size);
    if (axis < 0 || std::isinf(gaps_beyond)) return range;
    const std::vector<std::int64_t> slices = object.indices(axis);
    const std::size_t last = slices.size() - 1;
    const auto beyond = [&](std::size_t a, std::size_t b) {
        return last > 0 ? static_cast<std::int64_t>(gaps_beyond * static_cast<double>(slices[b] - slices[a])) : 0;
    };
    range.low[axis] = std::max<std::int64_t>(slices[0] - beyond(0, 1), 0);
    range.high[axis] = std::min<std::int64_t>(slices[last] + beyond(last - 1, last), image.size[axis] - 1);
    return range;
}

bool is_anything_left_out(const PaintedObject& object, const IndexBox& range) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto first = object.is_whole[static_cast<std::size_t>(axis)].begin();
        const auto low = static_cast<std::ptrdiff_t>(range.low[axis]), high = static_cast<std::ptrdiff_t>(range.high[axis]);
        if (std::all_of(first + low, first + high + 1, [](bool whole) { return whole; })) return false;
    }
    return true;
}

std::string why_as_it_was(const PaintedObject& object) {
    if (object.slices.size() > 1) return "no slice was left out";
    return "left as it was painted: that is 1 slice, and at least 2 are needed unless the ends are open";
}

}  // namespace kontur
