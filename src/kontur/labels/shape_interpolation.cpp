// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/shape_interpolation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kontur {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Along one row: the least of squared distances to other voxels plus what these have. Reads and writes `values` with a
/// stride.
void transform_row(double* values, std::int64_t count, std::int64_t stride, double step_mm, std::vector<double>& row,
                   std::vector<std::int64_t>& parabolas, std::vector<double>& borders) {
    row.resize(static_cast<std::size_t>(count));
    parabolas.clear(), borders.clear();
    const auto at = [&](std::int64_t n) { return row[static_cast<std::size_t>(n)]; };
    const auto place = [&](std::int64_t n) { return step_mm * static_cast<double>(n); };
    for (std::int64_t n = 0; n < count; ++n) row[static_cast<std::size_t>(n)] = values[n * stride];
    for (std::int64_t n = 0; n < count; ++n) {
        if (at(n) == kFar) continue;
        double border = -kFar;
        while (!parabolas.empty()) {
            const std::int64_t m = parabolas.back();
            border = (at(n) + place(n) * place(n) - at(m) - place(m) * place(m)) / (2 * (place(n) - place(m)));
            if (border > borders.back()) break;
            parabolas.pop_back(), borders.pop_back();
            border = -kFar;
        }
        parabolas.push_back(n), borders.push_back(border);
    }
    if (parabolas.empty()) return;
    for (std::int64_t n = 0, which = 0; n < count; ++n) {
        while (which + 1 < static_cast<std::int64_t>(parabolas.size()) &&
               borders[static_cast<std::size_t>(which + 1)] < place(n))
            ++which;
        const std::int64_t m = parabolas[static_cast<std::size_t>(which)];
        values[n * stride] = (place(n) - place(m)) * (place(n) - place(m)) + at(m);
    }
}

/// Squared distances to the nearest voxel that is set.
std::vector<double> squared_distances(const std::vector<std::uint8_t>& section, std::uint8_t set, std::int64_t width,
                                      double step_u_mm, double step_v_mm) {
    std::vector<double> squared(section.size());
    std::transform(section.begin(), section.end(), squared.begin(),
                   [&](std::uint8_t value) { return value == set ? 0.0 : kFar; });
    const std::int64_t height = static_cast<std::int64_t>(section.size()) / width;
    std::vector<double> row, borders;
    std::vector<std::int64_t> parabolas;
    for (std::int64_t b = 0; b < height; ++b)
        transform_row(squared.data() + b * width, width, 1, step_u_mm, row, parabolas, borders);
    for (std::int64_t a = 0; a < width; ++a)
        transform_row(squared.data() + a, height, width, step_v_mm, row, parabolas, borders);
    return squared;
}

}  // namespace

std::vector<double> section_distances(const Grid& grid, const PaintedSlice& slice) {
    const auto [u, v] = slice_axes(slice.axis);
    const Vec3 spacing = grid.spacing_mm();
    const double half = std::min(spacing[u], spacing[v]) / 2;
    const std::vector<double> outside = squared_distances(slice.section, 1, grid.size[u], spacing[u], spacing[v]);
    const std::vector<double> inside = squared_distances(slice.section, 0, grid.size[u], spacing[u], spacing[v]);
    std::vector<double> distances(slice.section.size());
    for (std::size_t n = 0; n < distances.size(); ++n)
        distances[n] = slice.section[n] ? std::sqrt(inside[n]) - half : half - std::sqrt(outside[n]);
    return distances;
}

ShapeInterpolation::ShapeInterpolation(const Grid& grid, const PaintedSlice& low, const PaintedSlice& high)
    : axis_(low.axis),
      low_(low.index),
      high_(high.index),
      width_(grid.size[slice_axes(low.axis)[0]]),
      gap_mm_(grid.spacing_mm()[low.axis] * static_cast<double>(high.index - low.index)) {
    const std::vector<double> first = section_distances(grid, low), second = section_distances(grid, high);
    low_mm_.assign(first.begin(), first.end());
    high_mm_.assign(second.begin(), second.end());
}

double ShapeInterpolation::depth_mm(const Index3& at) const {
    const auto [u, v] = slice_axes(axis_);
    const auto n = static_cast<std::size_t>(at[u] + width_ * at[v]);
    const double low = low_mm_[n], high = high_mm_[n];
    const double along = static_cast<double>(at[axis_] - low_) / static_cast<double>(high_ - low_);
    const double slope = (high - low) / gap_mm_;
    return std::lerp(low, high, along) / std::sqrt(1 + slope * slope);
}

double ShapeInterpolation::trust() const {
    const double low = *std::max_element(low_mm_.begin(), low_mm_.end()),
                 high = *std::max_element(high_mm_.begin(), high_mm_.end());
    const double relative_gap = 2 * gap_mm_ / (low + high);
    return 1 / (1 + 2 * relative_gap * relative_gap);  // the 2 was chosen on three sarcomas and a brain (docs/fill.md)
}

}  // namespace kontur
