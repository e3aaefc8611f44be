// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/inner_lines.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace kontur {
namespace {

class InnerLines {
public:
    InnerLines(const DrawnPlanes& planes, double cleft_mm) : planes_(planes), cleft_mm_(cleft_mm) {
        section_of_.resize(planes.set.contours.size());
        for (std::size_t s = 0; s < planes.sections.size(); ++s) {
            searches_.emplace_back(planes.sections[s]);
            for (const std::size_t c : planes.sections[s].contours) section_of_[c] = s;
        }
    }

    bool has(const BoundaryPoint& point) const {
        constexpr double kBeside = 0.01;  // of a cleft: walls are thicker
        if (point.contour == kNoContour || point.inplane_normal == Vec3{}) return false;
        const std::optional<std::size_t> section = section_of_[static_cast<std::size_t>(point.contour)];
        if (!section) return false;
        const double cleft = point.extent * cleft_mm_;
        const auto shows = [&](double outwards_mm) {
            const Vec3 beside = point.position + outwards_mm * point.inplane_normal;
            return searches_[*section].contains(planes_.sections[*section].plane.to_uv(beside));
        };
        return shows(-kBeside * cleft) ? shows(cleft) : !shows(kBeside * cleft);
    }

private:
    const DrawnPlanes& planes_;
    double cleft_mm_;
    std::vector<std::optional<std::size_t>> section_of_;  ///< for each contour; none for open ones
    std::vector<SectionSearch> searches_;
};

/// The borders of one ring, each as an open line. `begin` follows the last inner point before it.
void append_borders(const std::vector<BoundaryPoint>& ring, const std::vector<bool>& is_inner,
                    std::vector<BoundaryPoint>& to) {
    constexpr std::int32_t kFirstLine = 100;  // others of a contour are those of its lid
    const std::size_t n = ring.size();
    const auto first = static_cast<std::size_t>(std::ranges::find(is_inner, true) - is_inner.begin());
    std::int32_t line = kFirstLine;
    bool is_begun = false;
    for (std::size_t step = 1; step <= n; ++step) {
        const std::size_t i = (first + step) % n;
        if (is_inner[i]) {
            if (is_begun) {
                to.back().inplane_normal = {};
                ++line;
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
    const InnerLines inner_lines(planes, cleft_mm);
    std::vector<BoundaryPoint> kept;
    for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
        std::vector<bool> is_inner;
        const auto is_of_line = [&](const BoundaryPoint& p) {
            return p.on_ring && p.contour == points[begin].contour && p.line == points[begin].line;
        };
        do {
            is_inner.push_back(points[end].on_ring && inner_lines.has(points[end]));
            ++end;
        } while (end < points.size() && is_of_line(points[begin]) && is_of_line(points[end]));
        const std::vector<BoundaryPoint> line(points.begin() + static_cast<std::ptrdiff_t>(begin),
                                              points.begin() + static_cast<std::ptrdiff_t>(end));
        if (std::ranges::find(is_inner, true) == is_inner.end()) kept.insert(kept.end(), line.begin(), line.end());
        else append_borders(line, is_inner, kept);
    }
    points = std::move(kept);
}

}  // namespace kontur
