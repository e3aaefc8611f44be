// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/searched_band.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "kontur/base/parallel.h"
#include "kontur/base/point_tree.h"

namespace kontur {
namespace {

constexpr std::int64_t kPointsPerChunk = 64;

}  // namespace

SearchedBand::SearchedBand(std::vector<Vec3> surface, std::vector<double> reach_mm)
    : surface_(std::move(surface)), reach_mm_(std::move(reach_mm)) {}

std::vector<Vec3> SearchedBand::left_from(std::span<const Vec3> other, const Work& work) const {
    const PointTree others({other.begin(), other.end()});
    std::vector<std::uint8_t> is_left(surface_.size()), is_out(other.size());
    std::vector<std::size_t> nearest(other.size());
    const auto chunks = [&](std::size_t count, const auto& visit) {
        parallel_for(static_cast<std::int64_t>(count), kPointsPerChunk, work, [&](std::int64_t begin, std::int64_t end) {
            for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) visit(i);
        });
    };
    chunks(surface_.size(), [&](std::size_t i) { is_left[i] = others.distance_to(surface_[i]) > reach_mm_[i]; });
    const PointTree tree(surface_);
    const double least_reach = surface_.empty() ? 0 : *std::min_element(reach_mm_.begin(), reach_mm_.end());
    chunks(other.size(), [&](std::size_t n) {
        if (tree.distance_to(other[n]) <= least_reach) return;  // as nearly all are; only the others need all distances
        double least2 = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < surface_.size(); ++i) {
            const Vec3 apart = other[n] - surface_[i];
            const double distance2 = dot(apart, apart);
            if (distance2 <= reach_mm_[i] * reach_mm_[i]) return;
            if (distance2 < least2) {
                least2 = distance2;
                nearest[n] = i;
            }
        }
        is_out[n] = 1;
    });
    for (std::size_t n = 0; n < other.size(); ++n)
        if (is_out[n] && !surface_.empty()) is_left[nearest[n]] = 1;
    std::vector<Vec3> places;
    for (std::size_t i = 0; i < surface_.size(); ++i)
        if (is_left[i]) places.push_back(surface_[i]);
    return places;
}

}  // namespace kontur
