// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/inner_lines.h"

#include <algorithm>
#include <cmath>

namespace kontur {

InnerLines::InnerLines(const DrawnPlanes& planes) : planes_(planes), section_of_(planes.set.contours.size()) {
    for (std::size_t s = 0; s < planes.sections.size(); ++s) {
        searches_.emplace_back(planes.sections[s]);
        for (const std::size_t c : planes.sections[s].contours) section_of_[c] = s;
    }
}

bool InnerLines::has(std::size_t contour, const Vec3& place, const Vec3& across, double cleft_mm) const {
    constexpr double kBeside = 0.01;  // of a cleft: walls are thicker
    const std::optional<std::size_t> section = section_of_[contour];
    if (!section) return false;
    const auto shows = [&](double away_mm) {
        return searches_[*section].contains(planes_.sections[*section].plane.to_uv(place + away_mm * across));
    };
    const bool here = shows(-kBeside * cleft_mm), there = shows(kBeside * cleft_mm);
    if (here == there) return !here || (shows(cleft_mm) && shows(-cleft_mm));
    return shows(here ? cleft_mm : -cleft_mm);
}

namespace {

/// The borders of one ring, each as an open line. `begin` follows the last inner point before it.
void append_borders(const std::vector<BoundaryPoint>& ring, const std::vector<bool>& is_inner,
                    std::vector<BoundaryPoint>& to) {
    const std::size_t n = ring.size();
    const auto first = static_cast<std::size_t>(std::ranges::find(is_inner, true) - is_inner.begin());
    std::int32_t line = -1;  // and on downwards: those above 0 are of its lid
    bool is_begun = false;
    for (std::size_t step = 1; step <= n; ++step) {
        const std::size_t i = (first + step) % n;
        if (is_inner[i]) {
            if (is_begun) {
                to.back().inplane_normal = {};
                --line;
            }
            is_begun = false;
            continue;
        }
        BoundaryPoint& point = to.emplace_back(ring[i]);
        point.line = line;
        point.on_ring = false;
        if (!is_begun) point.inplane_normal = {};
        is_begun = true;
    }
}

}  // namespace

void leave_out_inner_lines(const DrawnPlanes& planes, double cleft_mm, std::vector<BoundaryPoint>& points) {
    const InnerLines inner_lines(planes);
    const auto is_inner_line = [&](const BoundaryPoint& p) {
        return p.on_ring && p.contour != kNoContour && p.inplane_normal != Vec3{} &&
               inner_lines.has(static_cast<std::size_t>(p.contour), p.position, p.inplane_normal, p.extent * cleft_mm);
    };
    const auto is_cut = [&](const BoundaryPoint& p) {
        return p.on_ring && p.contour != kNoContour && planes.image->is_border(p.position, p.inplane_normal);
    };
    std::vector<BoundaryPoint> outer_points;
    for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
        std::vector<bool> is_inner;
        const auto is_of_line = [&](const BoundaryPoint& p) {
            return p.on_ring && p.contour == points[begin].contour && p.line == points[begin].line;
        };
        do {
            is_inner.push_back(is_inner_line(points[end]));
            ++end;
        } while (end < points.size() && is_of_line(points[begin]) && is_of_line(points[end]));
        const std::vector<BoundaryPoint> line(points.begin() + static_cast<std::ptrdiff_t>(begin),
                                              points.begin() + static_cast<std::ptrdiff_t>(end));
        if (planes.image && 2 * std::ranges::count_if(line, is_cut) < std::ssize(line))
            for (std::size_t i = 0; i < line.size(); ++i) is_inner[i] = is_inner[i] || is_cut(line[i]);
        if (std::ranges::find(is_inner, true) == is_inner.end())
            outer_points.insert(outer_points.end(), line.begin(), line.end());
        else append_borders(line, is_inner, outer_points);
    }
    points = std::move(outer_points);
}

}  // namespace kontur
