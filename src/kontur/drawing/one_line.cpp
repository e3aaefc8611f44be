// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/one_line.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "kontur/drawing/subdivide.h"
#include "kontur/shape/find_near_lines.h"
#include "kontur/shape/section.h"

namespace kontur {
namespace {

/// The line, moved by that share of the way to the other one.
void move_towards(const Contour& other, double share, Contour& line) {
    line = subdivide(line, std::max(kLeastSegments, static_cast<int>(other.points.size())));
    const Section there = section_of(other, line.plane);
    const SectionSearch search(there);
    for (Vec3& p : line.points) {
        const Vec3 nearest = line.plane.from_uv(search.nearest(line.plane.to_uv(p)).position);
        p += share * (nearest - p);
    }
}

/// The larger ones first: from outside in, the nearest place of the next line moves on evenly where the lines are convex.
Contour mean_line(std::vector<Contour> lines) {
    const auto key = [](const Contour& line) {
        const Vec3& first =
            *std::ranges::min_element(line.points, {}, [](const Vec3& p) { return std::tuple(p.x, p.y, p.z); });
        return std::tuple(-area(section_of(line, line.plane).outlines.front()), first.x, first.y, first.z);
    };
    std::ranges::sort(lines, {}, key);
    Contour mean = lines.front();
    double weights = mean.weight;
    for (std::size_t n = 1; n < lines.size(); ++n) {
        const Contour& line = lines[n];
        weights += line.weight;
        move_towards(line, line.weight / weights, mean);
        mean.weight = std::max(mean.weight, line.weight);
        if (mean.end == ContourEnd::automatic) mean.end = line.end;
    }
    return mean;
}

}  // namespace

std::vector<std::size_t> make_one_line(ContourSet& set, const std::vector<NearLines>& pairs) {
    const std::size_t count = set.contours.size();
    const Groups groups = groups_of(pairs, count);
    std::vector<std::vector<Contour>> lines(count);
    for (std::size_t c = 0; c < count; ++c) lines[groups.of(c)].push_back(std::move(set.contours[c]));
    set.contours.clear();
    std::vector<std::size_t> numbers;
    for (std::size_t c = 0; c < count; ++c) {
        if (lines[c].empty()) continue;
        numbers.push_back(c);
        set.contours.push_back(lines[c].size() == 1 ? std::move(lines[c].front()) : mean_line(std::move(lines[c])));
    }
    return numbers;
}

}  // namespace kontur
