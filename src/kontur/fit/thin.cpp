// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/thin.h"

#include <algorithm>
#include <numeric>

#include "kontur/fit/stretches.h"

namespace kontur {
namespace {

/// For each point the length of its stretch: consecutive points of one contour; 0 for single points.
std::vector<double> stretch_lengths(const std::vector<BoundaryPoint>& points) {
    std::vector<double> lengths(points.size(), 0.0);
    for (std::size_t first = 0, next = 1; first < points.size(); first = next++) {
        double length = 0;
        for (; next < points.size() && follows(points, next); ++next)
            length += distance(points[next].position, points[next - 1].position);
        std::fill(lengths.begin() + static_cast<std::ptrdiff_t>(first), lengths.begin() + static_cast<std::ptrdiff_t>(next),
                  length);
    }
    return lengths;
}

/// Of how many single points one stays: all do unless they alone are more than `most`.
std::size_t single_point_step(const std::vector<BoundaryPoint>& points, std::size_t most) {
    const auto singles = static_cast<std::size_t>(
        std::count_if(points.begin(), points.end(), [](const BoundaryPoint& p) { return p.contour == kNoContour; }));
    return (singles + most - 1) / most;
}

}  // namespace

std::vector<std::size_t> thin(const std::vector<BoundaryPoint>& points, std::size_t most) {
    constexpr double kMostPerShort = 24, kLeastPerShort = 6;
    std::vector<std::size_t> kept;
    if (points.size() <= most) {
        kept.resize(points.size());
        std::iota(kept.begin(), kept.end(), std::size_t{0});
        return kept;
    }
    const std::vector<double> lengths = stretch_lengths(points);
    double total = 0, stretches = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!follows(points, i)) {
            total += lengths[i];
            ++stretches;
        }
    const double per_short =
        std::clamp(4 * static_cast<double>(most) / std::max(stretches, 1.0), kLeastPerShort, kMostPerShort);
    const double step = total / static_cast<double>(most);
    const std::size_t every = single_point_step(points, most);

    double since = 0;
    for (std::size_t i = 0, single = 0; i < points.size(); ++i) {
        if (points[i].contour == kNoContour && single++ % every != 0) continue;
        if (follows(points, i)) since += distance(points[i].position, points[i - 1].position);
        if (follows(points, i) && since < std::min(step, lengths[i] / per_short)) continue;
        kept.push_back(i);
        since = 0;
    }
    return kept;
}

}  // namespace kontur
