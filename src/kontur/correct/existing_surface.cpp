// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/existing_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "kontur/base/distance_transform.h"
#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/shape/inside_box.h"

namespace kontur {
namespace {

constexpr double kSmoothingVoxels = 0.7;  ///< standard deviation
constexpr int kTaps = 3;                  ///< on each side
constexpr double kLeastVoxels = 0.05;     ///< f0 at a voxel's centre is no nearer to 0, in the smallest voxel side
constexpr std::int64_t kMargin = 3;       ///< voxels around the object at least
constexpr double kWindowLengths = 1;      ///< around it. Half and 3.2 times: mean Dice within .00005 (bench/correct.py)

/// The box grown by `margin`; beyond the grid by kMargin voxels at most.
IndexBox grown(IndexBox box, const Index3& margin, const Index3& size) {
    for (int axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::max(box.low[axis] - margin[axis], std::min(box.low[axis], std::int64_t{0}) - kMargin);
        box.high[axis] = std::min(box.high[axis] + margin[axis], std::max(box.high[axis], size[axis] - 1) + kMargin);
    }
    return box;
}

/// Distances of the voxels that are not marked from the surface of the marked ones, mm; 0 for marked ones. The surface lies
/// half a voxel before the nearest marked centre.
std::vector<float> distances_from(const std::vector<std::uint8_t>& marked, const Grid& grid, const Work& work) {
    const Vec3 spacing = grid.spacing_mm();
    const DistanceTransform nearest = distance_transform(grid.size, spacing, marked, work);
    std::vector<float> distances(marked.size());
    parallel_for(static_cast<std::int64_t>(marked.size()), 1 << 16, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
            if (marked[n]) continue;
            const Index3 here = index_at(n, grid.size), there = index_at(nearest.nearest[n], grid.size);
            const Vec3 steps{static_cast<double>(there.i - here.i), static_cast<double>(there.j - here.j),
                             static_cast<double>(there.k - here.k)};
            double squared = 0, weighted = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const double along = steps[axis] * spacing[axis];
                squared += along * along;
                weighted += along * along * spacing[axis];
            }
            distances[n] = static_cast<float>(norm(grid.index_to_mm.apply_linear(steps)) - 0.5 * weighted / squared);
        }
    });
    return distances;
}

/// Smooths `values` along one axis by a Gaussian; values beyond the ends are those of the ends.
void smooth(std::vector<float>& values, const Index3& size, int axis, const Work& work) {
    std::array<double, kTaps + 1> taps{};
    double sum = 0;
    for (int t = 0; t <= kTaps; ++t) {
        taps[t] = std::exp(-0.5 * t * t / (kSmoothingVoxels * kSmoothingVoxels));
        sum += t == 0 ? taps[t] : 2 * taps[t];
    }
    for (double& tap : taps) tap /= sum;
    const std::int64_t step = axis == 0 ? 1 : axis == 1 ? size.i : size.i * size.j, count = size[axis];
    const std::int64_t lines = size.i * size.j * size.k / count;
    parallel_for(lines, 64, work, [&](std::int64_t begin, std::int64_t end) {
        std::vector<double> line(static_cast<std::size_t>(count));
        for (std::int64_t l = begin; l < end; ++l) {
            float* first = values.data() + l / step * step * count + l % step;
            for (std::int64_t n = 0; n < count; ++n) line[n] = first[n * step];
            for (std::int64_t n = 0; n < count; ++n) {
                double mean = taps[0] * line[n];
                for (int t = 1; t <= kTaps; ++t)
                    mean += taps[t] * (line[std::max(n - t, std::int64_t{0})] + line[std::min(n + t, count - 1)]);
                first[n * step] = static_cast<float>(mean);
            }
        }
    });
}

double radius_of(const std::vector<std::uint8_t>& inside, const Grid& grid) {
    Vec3 sum;
    double count = 0;
    for (std::size_t n = 0; n < inside.size(); ++n)
        if (inside[n]) {
            const Index3 v = index_at(n, grid.size);
            sum += grid.center_mm(v.i, v.j, v.k);
            ++count;
        }
    const Vec3 mean = sum / count;
    double farthest = 0;
    for (std::size_t n = 0; n < inside.size(); ++n)
        if (inside[n]) {
            const Index3 v = index_at(n, grid.size);
            farthest = std::max(farthest, distance(grid.center_mm(v.i, v.j, v.k), mean));
        }
    return farthest;
}

double length_mm(double inscribed_radius_mm, const Grid& grid) {
    return std::max(kLengthOfRadius * inscribed_radius_mm, kLeastLengthVoxels * largest(grid.spacing_mm()));
}

}  // namespace

ExistingSurface::ExistingSurface(const Mask& mask, const Work& work) : grid_(mask.grid) {
    check_mask(mask);
    const std::optional<IndexBox> object = inside_box(mask);
    if (!object)
        throw Error(ErrorKind::invalid_input,
                    "the mask has no voxel inside, so there is nothing to correct; kontur segment makes one of contours");

    object_ = *object;
    const IndexBox tight = grown(*object, {1, 1, 1}, grid_.size);
    const std::vector<std::uint8_t> inside = object_voxels(mask, tight);
    const Grid tight_grid = grid_of(grid_, tight);
    radius_mm_ = radius_of(inside, tight_grid);
    voxels_inside_ = std::count(inside.begin(), inside.end(), 1);
    std::vector<std::uint8_t> outside(inside.size());
    std::transform(inside.begin(), inside.end(), outside.begin(), [](std::uint8_t v) { return v == 0; });
    const std::vector<float> depths = distances_from(outside, tight_grid, work);
    inscribed_radius_mm_ = *std::max_element(depths.begin(), depths.end());

    const double around = kWindowLengths * length_mm(inscribed_radius_mm_, grid_);
    const Vec3 spacing = grid_.spacing_mm();
    Index3 margin;
    for (int axis = 0; axis < 3; ++axis)
        margin[axis] = std::max(kMargin, static_cast<std::int64_t>(std::ceil(around / spacing[axis])));
    const IndexBox wide = grown(*object, margin, grid_.size);
    first_ = wide.low;
    window_ = grid_of(grid_, wide);
    to_window_ = window_.index_to_mm.inverse();

    const std::vector<std::uint8_t> marked = object_voxels(mask, wide);
    values_ = distances_from(marked, window_, work);
    for (float& value : values_) value = -value;
    for (std::size_t n = 0; n < depths.size(); ++n)
        if (inside[n]) {
            const Index3 v = index_at(n, tight_grid.size);
            values_[window_.offset(v.i + tight.low.i - first_.i, v.j + tight.low.j - first_.j,
                                   v.k + tight.low.k - first_.k)] = depths[n];
        }
    for (int axis = 0; axis < 3; ++axis) smooth(values_, window_.size, axis, work);
    const float least = least_value(*this);
    for (std::size_t n = 0; n < values_.size(); ++n)
        values_[n] = marked[n] ? std::max(values_[n], least) : std::min(values_[n], -least);
}

double ExistingSurface::value(const Vec3& position) const {
    const Vec3 index = to_window_.apply(position);
    Vec3 clamped, part;
    Index3 low;
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t last = window_.size[axis] - 1;
        clamped[axis] = std::clamp(index[axis], 0.0, static_cast<double>(last));
        low[axis] = std::min(static_cast<std::int64_t>(clamped[axis]), std::max(last - 1, std::int64_t{0}));
        part[axis] = clamped[axis] - static_cast<double>(low[axis]);
    }
    const std::int64_t di = window_.size.i > 1, dj = window_.size.j > 1 ? window_.size.i : 0,
                       dk = window_.size.k > 1 ? window_.size.i * window_.size.j : 0;
    const float* at = values_.data() + window_.offset(low.i, low.j, low.k);
    const auto along_i = [&](const float* p) { return p[0] + part.x * (static_cast<double>(p[di]) - p[0]); };
    const auto along_j = [&](const float* p) { return along_i(p) + part.y * (along_i(p + dj) - along_i(p)); };
    const double value = along_j(at) + part.z * (along_j(at + dk) - along_j(at));
    if (clamped == index) return value;
    return std::min(value, 0.0) - norm(window_.index_to_mm.apply_linear(index - clamped));
}

double ExistingSurface::value_at_voxel(const Index3& voxel) const {
    const Index3 v{voxel.i - first_.i, voxel.j - first_.j, voxel.k - first_.k};
    for (int axis = 0; axis < 3; ++axis)
        if (v[axis] < 0 || v[axis] >= window_.size[axis]) return value(grid_.center_mm(voxel.i, voxel.j, voxel.k));
    return values_[window_.offset(v.i, v.j, v.k)];
}

float least_value(const ExistingSurface& surface) {
    return static_cast<float>(kLeastVoxels * smallest(surface.grid().spacing_mm()));
}

std::vector<float> unshrunk_values(const ExistingSurface& surface, const Work& work) {
    const std::span<const float> values = surface.window_values();
    const float least = least_value(surface);
    std::vector<float> unshrunk(values.begin(), values.end());
    for (int axis = 0; axis < 3; ++axis) smooth(unshrunk, surface.window().size, axis, work);
    for (std::size_t n = 0; n < values.size(); ++n) {
        const float value = 2 * values[n] - unshrunk[n];
        unshrunk[n] = values[n] > 0 ? std::max(value, least) : std::min(value, -least);
    }
    return unshrunk;
}

double correction_length_mm(const ExistingSurface& surface) {
    return length_mm(surface.inscribed_radius_mm(), surface.grid());
}

}  // namespace kontur
