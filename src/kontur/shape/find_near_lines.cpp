// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/find_near_lines.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "kontur/shape/section.h"

namespace kontur {
namespace {

constexpr double kNear = 1.0 / 3;  // of what the larger line encloses

struct RingLine {
    Section section;
    double enclosed_mm2, length_mm;
};

RingLine line_of(const Contour& contour, const Plane& plane) {
    Section section = section_of(contour, plane);
    const double enclosed = area(section.outlines.front());
    return {std::move(section), enclosed, line_length(contour.points, true)};
}

/// Of a line's places from another line, on average.
double mean_distance_mm(const RingLine& of, const RingLine& from) {
    constexpr std::size_t kMostEdges = 2000;
    const SectionSearch search(from.section);
    const Polygon2& points = of.section.outlines.front();
    const std::size_t stride = 1 + points.size() / kMostEdges;
    double sum = 0, length = 0;
    for (std::size_t i = 0; i < points.size(); i += stride) {
        const Point2 &a = points[i], &b = points[(i + 1) % points.size()];
        const double edge = std::hypot(b[0] - a[0], b[1] - a[1]);
        const Point2 middle{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
        sum += edge * (search.clearance(a) + 4 * search.clearance(middle) + search.clearance(b)) / 6;
        length += edge;
    }
    return length > 0 ? sum / length : 0;
}

std::optional<NearLines> near_lines(const std::vector<Contour>& contours, std::size_t contour, std::size_t other,
                                    bool are_nested) {
    const Plane& plane = contours[other].plane;
    const RingLine a = line_of(contours[contour], plane), b = line_of(contours[other], plane);
    const auto [less, more] = std::minmax(a.enclosed_mm2, b.enclosed_mm2);
    if (less < (1 - kNear) / 2 * more) return std::nullopt;  // far from near
    const double apart = (mean_distance_mm(a, b) + mean_distance_mm(b, a)) / 2;
    const double between = apart * (a.length_mm + b.length_mm) / 2;
    if (between > kNear * more) return std::nullopt;
    return NearLines{contour, other, apart, between / more, are_nested};
}

}  // namespace

std::vector<NearLines> find_near_lines(const std::vector<Contour>& contours, const Nesting& nesting) {
    std::vector<NearLines> result;
    const auto look_at = [&](std::size_t contour, std::size_t other, bool are_nested) {
        if (const auto pair = near_lines(contours, contour, other, are_nested)) result.push_back(*pair);
    };
    for (std::size_t inner = 0; inner < contours.size(); ++inner)
        for (const std::size_t around : nesting.enclosing[inner])
            if (nesting.depth[around] + 1 == nesting.depth[inner]) look_at(inner, around, true);
    for (const auto& [first, second] : nesting.crossings) look_at(first, second, false);
    return result;
}

Groups::Groups(std::size_t count) : least_(count) { std::iota(least_.begin(), least_.end(), std::size_t{0}); }

void Groups::unite(std::size_t a, std::size_t b) {
    const auto [least, most] = std::minmax({of(a), of(b)});
    std::ranges::replace(least_, most, least);
}

std::size_t Groups::of(std::size_t i) const { return least_[i]; }

Groups groups_of(const std::vector<NearLines>& pairs, std::size_t contours) {
    Groups groups(contours);
    for (const NearLines& pair : pairs)
        if (pair.is_one) groups.unite(pair.contour, pair.other);
    return groups;
}

}  // namespace kontur
