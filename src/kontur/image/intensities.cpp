// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/intensities.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <unordered_map>

#include "kontur/sampling/quantile.h"

namespace kontur {
namespace {

constexpr std::size_t kQuantiles = 65;

constexpr std::size_t kMostLabels = 4096;
constexpr std::int64_t kLookedAt = 1 << 17;  // voxels
constexpr double kAlike = 0.5;               // of neighbours: voxels of intensities have noise

/// Pairs of neighbours of which the first has this value, and how many of them are alike.
struct Pairs {
    std::int64_t all = 0, alike = 0;
};

bool is_of_one_value(const Image& image) {
    return std::visit(
        [](const auto& samples) {
            return std::all_of(samples.begin(), samples.end(), [&](auto value) { return value == samples.front(); });
        },
        image.samples);
}

}  // namespace

bool is_label_map(const Image& image) {
    const Index3& size = image.grid.size;
    const std::int64_t rows = size.j * size.k, step = std::max<std::int64_t>(1, rows * size.i / kLookedAt);
    std::unordered_map<double, Pairs> pairs;
    bool is_whole = true;
    for (std::int64_t row = 0; row < rows; row += step) {
        const auto first = static_cast<std::size_t>(row * size.i);
        for (std::int64_t i = 0; i + 1 < size.i; ++i) {
            const double value = sample(image, first + static_cast<std::size_t>(i));
            if (!std::isfinite(value)) return false;
            is_whole = is_whole && value == std::round(value);
            Pairs& counts = pairs[value];
            ++counts.all;
            counts.alike += value == sample(image, first + static_cast<std::size_t>(i) + 1);
            if (pairs.size() > (is_whole ? kMostLabels : 2)) return false;
        }
    }
    if (pairs.size() <= 1) return is_of_one_value(image);
    if (pairs.size() == 2) return true;
    Pairs total, background;
    for (const auto& [value, counts] : pairs) {
        total.all += counts.all;
        total.alike += counts.alike;
        if (std::tie(counts.all, counts.alike) > std::tie(background.all, background.alike)) background = counts;
    }
    return static_cast<double>(total.alike - background.alike) > kAlike * static_cast<double>(total.all - background.all);
}

Intensities::Intensities(const Image& image) : image_(&image), mm_to_index_(image.grid.index_to_mm.inverse()) {
    voxel_mm_ = smallest(image.grid.spacing_mm());
    step_mm_ = 0.5 * std::min(std::cbrt(image.grid.voxel_volume_mm3()), 2 * voxel_mm_);
}

double Intensities::at(const Vec3& point_mm) const {
    return interpolate(*image_, mm_to_index_, point_mm, std::numeric_limits<double>::quiet_NaN());
}

IntensityScale::IntensityScale(std::vector<double> values) {
    std::erase_if(values, [](double v) { return !std::isfinite(v); });
    if (values.empty()) return;
    std::sort(values.begin(), values.end());
    if (!(values.back() > values.front())) return;
    low_ = quantile_of_sorted(values, 0.01);
    high_ = quantile_of_sorted(values, 0.99);
    for (std::size_t q = 0; q < kQuantiles; ++q)
        quantiles_.push_back(quantile_of_sorted(values, static_cast<double>(q) / (kQuantiles - 1)));
}

double IntensityScale::operator()(double value) const {
    if (quantiles_.empty()) return 0.5;
    // Of equal quantiles the middle one counts, so that an inverted image has the mirrored ranks.
    const auto [first, last] = std::equal_range(quantiles_.begin(), quantiles_.end(), value);
    const double before = static_cast<double>(first - quantiles_.begin()),
                 after = static_cast<double>(last - quantiles_.begin());
    double rank = (before + after - 1) / 2;
    if (first == last) {
        if (first == quantiles_.begin()) rank = 0;
        else if (first == quantiles_.end()) rank = kQuantiles - 1;
        else rank = before - 1 + (value - *(first - 1)) / (*first - *(first - 1));
    }
    const double line = high_ > low_ ? std::clamp((value - low_) / (high_ - low_), 0.0, 1.0) : 0.5;
    return 0.5 * rank / (kQuantiles - 1) + 0.5 * line;
}

}  // namespace kontur
