// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/shape_interpolation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/base/smooth_step.h"

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

/// Half of the thickness of a section where it is thickest, mm.
double thickest(const std::vector<float>& distances_mm) {
    return *std::max_element(distances_mm.begin(), distances_mm.end());
}

/// Voxels of a section, and the mean of their indices along both axes.
struct Extent {
    double voxels = 0, u = 0, v = 0;
};

Extent extent(const std::vector<std::uint8_t>& section, std::int64_t width) {
    Extent found;
    for (std::size_t n = 0; n < section.size(); ++n) {
        if (!section[n]) continue;
        found.voxels += 1;
        found.u += static_cast<double>(static_cast<std::int64_t>(n) % width);
        found.v += static_cast<double>(static_cast<std::int64_t>(n) / width);
    }
    found.u /= std::max(found.voxels, 1.0), found.v /= std::max(found.voxels, 1.0);
    return found;
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
      height_(grid.size[slice_axes(low.axis)[1]]),
      gap_mm_(grid.spacing_mm()[low.axis] * static_cast<double>(high.index - low.index)),
      step_u_mm_(grid.spacing_mm()[slice_axes(low.axis)[0]]),
      step_v_mm_(grid.spacing_mm()[slice_axes(low.axis)[1]]) {
    const std::vector<double> first = section_distances(grid, low), second = section_distances(grid, high);
    low_mm_.assign(first.begin(), first.end());
    high_mm_.assign(second.begin(), second.end());
    move(low, high);
}

void ShapeInterpolation::move(const PaintedSlice& low, const PaintedSlice& high) {
    const Extent below = extent(low.section, width_), above = extent(high.section, width_);
    if (below.voxels == 0 || above.voxels == 0) return;
    double common = 0, nearest_mm = -kFar;
    for (std::size_t n = 0; n < low.section.size(); ++n) {
        if (!high.section[n]) continue;
        if (low.section[n]) common += 1;
        nearest_mm = std::max(nearest_mm, double{low_mm_[n]});
    }
    const double thinner_mm = 2 * std::min(thickest(low_mm_), thickest(high_mm_));
    apartness_ = smooth_step(0, 1, 1.5 + nearest_mm / thinner_mm) * (1 - common / std::min(below.voxels, above.voxels));
    way_u_ = apartness_ * (above.u - below.u), way_v_ = apartness_ * (above.v - below.v);
}

double ShapeInterpolation::sampled(const std::vector<float>& distances_mm, double a, double b) const {
    const double inner_a = std::clamp(a, 0.0, static_cast<double>(width_ - 1)),
                 inner_b = std::clamp(b, 0.0, static_cast<double>(height_ - 1));
    const auto low_a = static_cast<std::int64_t>(inner_a), low_b = static_cast<std::int64_t>(inner_b);
    const auto at = [&](std::int64_t i, std::int64_t j) {
        return distances_mm[static_cast<std::size_t>(std::min(i, width_ - 1) + width_ * std::min(j, height_ - 1))];
    };
    const double part_a = inner_a - static_cast<double>(low_a), part_b = inner_b - static_cast<double>(low_b);
    const double inner =
        std::lerp(std::lerp(double{at(low_a, low_b)}, double{at(low_a + 1, low_b)}, part_a),
                  std::lerp(double{at(low_a, low_b + 1)}, double{at(low_a + 1, low_b + 1)}, part_a), part_b);
    return inner - std::hypot((a - inner_a) * step_u_mm_, (b - inner_b) * step_v_mm_);
}

double ShapeInterpolation::depth_mm(const Index3& at) const {
    const auto [u, v] = slice_axes(axis_);
    const double along = static_cast<double>(at[axis_] - low_) / static_cast<double>(high_ - low_);
    const auto place_u = static_cast<double>(at[u]), place_v = static_cast<double>(at[v]);
    const double low = sampled(low_mm_, place_u - along * way_u_, place_v - along * way_v_),
                 high = sampled(high_mm_, place_u + (1 - along) * way_u_, place_v + (1 - along) * way_v_);
    const double slope = (high - low) / gap_mm_;
    return std::lerp(low, high, along) / std::sqrt(1 + slope * slope);
}

double ShapeInterpolation::trust() const {
    const double relative_gap = 2 * gap_mm_ / (thickest(low_mm_) + thickest(high_mm_));
    return 1 / (1 + 2 * relative_gap * relative_gap);  // the 2 was chosen on three sarcomas and a brain (docs/fill.md)
}

}  // namespace kontur
