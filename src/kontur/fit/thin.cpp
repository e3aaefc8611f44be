// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/thin.h"

#include <algorithm>
#include <numeric>

#include "kontur/fit/spread.h"
#include "kontur/fit/stretches.h"

namespace kontur {
namespace {

LinePoints line_of(const std::vector<BoundaryPoint>& points, const Stretch& stretch) {
    LinePoints line{{}, stretch.is_ring};
    for (std::size_t i = stretch.begin; i < stretch.end; ++i) line.positions.push_back(points[i].position);
    return line;
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
    std::vector<std::size_t> numbers;
    if (points.size() <= most) {
        numbers.resize(points.size());
        std::iota(numbers.begin(), numbers.end(), std::size_t{0});
        return numbers;
    }
    std::vector<LinePoints> lines;
    std::vector<double> lengths;
    const std::vector<Stretch> all = stretches(points);
    for (const Stretch& stretch : all) {
        lines.push_back(line_of(points, stretch));
        lengths.push_back(line_length(lines.back().positions, stretch.is_ring));
    }
    const double total = std::accumulate(lengths.begin(), lengths.end(), 0.0);
    const double per_short =
        std::clamp(4 * static_cast<double>(most) / static_cast<double>(all.size()), kLeastPerShort, kMostPerShort);
    const double step = total / static_cast<double>(most);
    const std::size_t every = single_point_step(points, most);

    for (std::size_t s = 0, single = 0; s < all.size(); ++s) {
        if (points[all[s].begin].contour == kNoContour && single++ % every != 0) continue;
        const std::vector<double> apart(lines[s].positions.size(), std::min(step, lengths[s] / per_short) / kSpreadApart);
        const std::vector<bool> is_chosen = spread_along(lines[s], apart, 0);
        for (std::size_t i = 0; i < is_chosen.size(); ++i)
            if (is_chosen[i]) numbers.push_back(all[s].begin + i);
    }
    return numbers;
}

}  // namespace kontur
