// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/body_outline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/derive/margin.h"
#include "kontur/derive/mask_levels.h"
#include "kontur/derive/parts.h"

namespace kontur {
namespace {

constexpr double kAirHu = -500, kSkinHu = -250;
constexpr double kNeckMm = 4;  ///< half the width of what does not hold parts together
constexpr int kBins = 256;

struct Range {
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
};

Range range_of(const Image& image) {
    Range range;
    std::visit(
        [&](const auto& samples) {
            for (const auto sample : samples) {
                const auto value = static_cast<double>(sample);
                if (!std::isfinite(value)) continue;
                range.low = std::min(range.low, value);
                range.high = std::max(range.high, value);
            }
        },
        image.samples);
    return range;
}

/// Parts the values so that the classes' variance between them is the largest.
double otsu(const Image& image, const Range& range) {
    std::array<double, kBins> count{};
    const double width = (range.high - range.low) / kBins;
    if (!(width > 0)) return range.high;
    std::visit(
        [&](const auto& samples) {
            for (const auto sample : samples) {
                const auto value = static_cast<double>(sample);
                if (std::isfinite(value))
                    ++count[static_cast<std::size_t>(std::clamp((value - range.low) / width, 0.0, kBins - 1.0))];
            }
        },
        image.samples);
    double all = 0, all_sum = 0;
    for (std::size_t n = 0; n < kBins; ++n) all += count[n], all_sum += count[n] * static_cast<double>(n);
    double below = 0, below_sum = 0, best = -1;
    std::size_t at = 0;
    for (std::size_t n = 0; n + 1 < kBins; ++n) {
        below += count[n];
        below_sum += count[n] * static_cast<double>(n);
        if (below == 0 || below == all) continue;
        const double apart = below_sum / below - (all_sum - below_sum) / (all - below);
        const double between = below * (all - below) * apart * apart;
        if (between > best) best = between, at = n;
    }
    return range.low + width * static_cast<double>(at + 1);
}

Mask above(const Image& image, double threshold) {
    Mask mask{image.grid, std::vector<std::uint8_t>(static_cast<std::size_t>(image.grid.voxel_count()))};
    std::visit(
        [&](const auto& samples) {
            std::transform(samples.begin(), samples.end(), mask.values.begin(),
                           [=](auto v) { return static_cast<std::uint8_t>(static_cast<double>(v) > threshold); });
        },
        image.samples);
    return mask;
}

/// The axis of the grid along which the patient's z mostly runs.
int slice_axis(const Grid& grid) {
    int axis = 0;
    for (int n = 1; n < 3; ++n)
        if (std::abs(normalized(grid.index_to_mm.column(n)).z) > std::abs(normalized(grid.index_to_mm.column(axis)).z))
            axis = n;
    return axis;
}

/// What no way within the slice leads out of becomes inside.
void fill_slice(Mask& mask, int axis, std::int64_t index) {
    const Index3 size = mask.grid.size;
    const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    const std::int64_t steps[] = {1, size.i, size.i * size.j};
    const std::int64_t columns = size[u], rows = size[v];
    const auto place = [&](std::int64_t a, std::int64_t b) {
        return static_cast<std::size_t>(index * steps[axis] + a * steps[u] + b * steps[v]);
    };
    std::vector<std::uint8_t> is_around(static_cast<std::size_t>(columns * rows));
    std::vector<std::array<std::int64_t, 2>> waiting;
    const auto visit = [&](std::int64_t a, std::int64_t b) {
        if (a < 0 || b < 0 || a >= columns || b >= rows) return;
        std::uint8_t& mark = is_around[static_cast<std::size_t>(a + columns * b)];
        if (mark || mask.values[place(a, b)]) return;
        mark = 1;
        waiting.push_back({a, b});
    };
    for (std::int64_t a = 0; a < columns; ++a) visit(a, 0), visit(a, rows - 1);
    for (std::int64_t b = 0; b < rows; ++b) visit(0, b), visit(columns - 1, b);
    while (!waiting.empty()) {
        const auto [a, b] = waiting.back();
        waiting.pop_back();
        visit(a - 1, b), visit(a + 1, b), visit(a, b - 1), visit(a, b + 1);
    }
    for (std::int64_t b = 0; b < rows; ++b)
        for (std::int64_t a = 0; a < columns; ++a)
            mask.values[place(a, b)] = !is_around[static_cast<std::size_t>(a + columns * b)];
}

/// The largest part, and of what hangs on it only what lies within `kNeckMm` of its core.
Mask without_hangers(const Mask& mask, const Work& work) {
    const WorkLattice voxels{mask.grid};
    const SideLengths neck{kNeckMm, kNeckMm, kNeckMm, kNeckMm, kNeckMm, kNeckMm};
    const Levels all = mask_levels(mask, voxels, work);
    const Levels core = largest_part(margin(all, mask.grid, neck, MarginSide::inwards, work));
    if (is_empty(core)) return mask_of(largest_part(all), voxels, mask.grid);
    return mask_of(meet(all, margin(core, mask.grid, neck, MarginSide::outwards, work), work), voxels, mask.grid);
}

}  // namespace

Mask body_outline(const Image& image, const std::optional<double>& threshold, const Work& work) {
    check_image(image);
    const Range range = range_of(image);
    const double least = threshold ? *threshold : range.low < kAirHu ? kSkinHu : otsu(image, range);
    Mask mask = above(image, least);
    if (std::find(mask.values.begin(), mask.values.end(), 1) == mask.values.end())
        throw Error(
            ErrorKind::invalid_input,
            fmt::format("no voxel of the image lies above {:g}, so there is no body; give body() another threshold", least));
    const int axis = slice_axis(image.grid);
    const auto fill_slices = [&] {
        parallel_for(image.grid.size[axis], 1, work, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t n = begin; n < end; ++n) fill_slice(mask, axis, n);
        });
    };
    fill_slices();
    mask = without_hangers(mask, work);
    fill_slices();
    return mask;
}

}  // namespace kontur
