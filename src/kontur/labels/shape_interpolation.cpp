// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/shape_interpolation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kontur {
namespace {

SectionField field_of(const Grid& grid, const PaintedSlice& slice) {
    const auto [u, v] = slice_axes(slice.axis);
    const Vec3 spacing = grid.spacing_mm();
    const std::vector<double> distances = section_distances(grid, slice);
    return {0, 0, grid.size[u], grid.size[v], spacing[u], spacing[v], {distances.begin(), distances.end()}};
}

bool is_empty(const std::vector<std::uint8_t>& section) {
    return std::all_of(section.begin(), section.end(), [](std::uint8_t value) { return value == 0; });
}

/// The distances of what is left of a slice; where nothing is, they stay those of the whole.
void leave(std::vector<std::uint8_t> rest, const Grid& grid, PaintedSlice slice, SectionField& field) {
    if (is_empty(rest)) return;
    slice.section = std::move(rest);
    field = field_of(grid, slice);
}

}  // namespace

ShapeInterpolation::ShapeInterpolation(const Grid& grid, const PaintedSlice& low, const PaintedSlice& high)
    : axis_(low.axis),
      low_(low.index),
      high_(high.index),
      gap_mm_(grid.spacing_mm()[low.axis] * static_cast<double>(high.index - low.index)),
      low_mm_(field_of(grid, low)),
      high_mm_(field_of(grid, high)) {
    thickness_mm_ = low_mm_.thickest_mm() + high_mm_.thickest_mm();
    Strands strands = find_strands(grid, low, high);
    strands_ = std::move(strands.strands);
    is_all_strands_ = is_empty(strands.low_rest) && is_empty(strands.high_rest);
    if (strands_.empty()) return;
    leave(std::move(strands.low_rest), grid, low, low_mm_);
    leave(std::move(strands.high_rest), grid, high, high_mm_);
}

ShapeInterpolation::Depth ShapeInterpolation::depth(const Index3& at) const {
    const auto [u, v] = slice_axes(axis_);
    const double along = static_cast<double>(at[axis_] - low_) / static_cast<double>(high_ - low_);
    const auto place_u = static_cast<double>(at[u]), place_v = static_cast<double>(at[v]);
    Depth result{-std::numeric_limits<double>::infinity(), 0};
    if (!is_all_strands_) {
        const double low = low_mm_.at(place_u, place_v), high = high_mm_.at(place_u, place_v);
        result.mm = std::lerp(low, high, along) / std::hypot(1.0, (high - low) / gap_mm_);
        if (low > 0 && high > 0) result.belief = 1;
    }
    for (const Strand& strand : strands_) {
        if (!is_all_strands_ && !strand.is_near(along, place_u, place_v)) continue;
        if (const double mm = strand.depth_mm(along, place_u, place_v, gap_mm_); mm > result.mm)
            result = {mm, strand.belief};
    }
    return result;
}

double ShapeInterpolation::trust() const {
    const double relative_gap = 2 * gap_mm_ / thickness_mm_;
    return 1 / (1 + 2 * relative_gap * relative_gap);  // the 2 was chosen on three sarcomas and a brain (docs/fill.md)
}

}  // namespace kontur
