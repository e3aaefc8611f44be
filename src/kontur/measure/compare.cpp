// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/compare.h"

#include <algorithm>
#include <numeric>

#include "kontur/base/parallel.h"
#include "kontur/base/point_tree.h"
#include "kontur/measure/surface_voxels.h"

namespace kontur {
namespace {

/// From each point to the nearest point of the tree, ascending.
std::vector<double> sorted_distances(const std::vector<Vec3>& from, const PointTree& to, const Work& work) {
    std::vector<double> distances(from.size());
    parallel_for(static_cast<std::int64_t>(from.size()), 4096, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) distances[i] = to.distance_to(from[i]);
    });
    std::sort(distances.begin(), distances.end());
    return distances;
}

double percentile(const std::vector<double>& sorted, double fraction) {
    const double rank = fraction * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(rank);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], rank - static_cast<double>(below));
}

SurfaceDistance surface_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b, const Work& work) {
    const std::vector<double> forward = sorted_distances(a, PointTree(b), work);
    const std::vector<double> backward = sorted_distances(b, PointTree(a), work);
    const double sum =
        std::accumulate(forward.begin(), forward.end(), 0.0) + std::accumulate(backward.begin(), backward.end(), 0.0);
    return {std::max(forward.back(), backward.back()), std::max(percentile(forward, 0.95), percentile(backward, 0.95)),
            sum / static_cast<double>(forward.size() + backward.size())};
}

struct Overlap {
    std::int64_t a = 0, b = 0, both = 0;
};

Overlap count_voxels(const Mask& a, const Mask& b) {
    Overlap count;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        const bool in_a = a.values[i] != 0, in_b = b.values[i] != 0;
        count.a += in_a;
        count.b += in_b;
        count.both += in_a && in_b;
    }
    return count;
}

double ratio(std::int64_t part, std::int64_t whole) {
    return whole == 0 ? 1 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

Comparison compare(const Mask& a, const Mask& b, const Work& work) {
    check_comparable(a, b);
    const Overlap count = count_voxels(a, b);
    const double voxel_ml = a.grid.voxel_volume_mm3() / 1000;
    Comparison result;
    result.volume_a_ml = static_cast<double>(count.a) * voxel_ml;
    result.volume_b_ml = static_cast<double>(count.b) * voxel_ml;
    result.dice = ratio(2 * count.both, count.a + count.b);
    result.jaccard = ratio(count.both, count.a + count.b - count.both);
    if (count.a > 0 && count.b > 0)
        result.surface = surface_distance(surface_voxels(a.grid, a.values), surface_voxels(a.grid, b.values), work);
    return result;
}

}  // namespace kontur
