// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/gaps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kontur/base/parallel.h"
#include "kontur/shape/contour_nesting.h"

namespace kontur {
namespace {

using Point2 = std::array<double, 2>;

Point2 minus(const Point2& a, const Point2& b) { return {a[0] - b[0], a[1] - b[1]}; }
double cross2(const Point2& a, const Point2& b) { return a[0] * b[1] - a[1] * b[0]; }

/// All lines of a plane in its coordinates.
struct Drawing {
    Plane plane;
    std::vector<std::pair<Point2, Point2>> edges;
    std::vector<std::int32_t> contours;
};

std::vector<Drawing> drawings_of(const ContourSet& set, double tolerance_mm) {
    std::vector<Drawing> drawings;
    for (std::size_t c = 0; c < set.contours.size(); ++c) {
        const Contour& contour = set.contours[c];
        auto found = std::find_if(drawings.begin(), drawings.end(),
                                  [&](const Drawing& d) { return coincide(d.plane, contour.plane, tolerance_mm); });
        if (found == drawings.end()) found = drawings.insert(found, {contour.plane, {}, {}});
        found->contours.push_back(static_cast<std::int32_t>(c));
        for (std::size_t i = contour.closed ? 0 : 1; i < contour.points.size(); ++i) {
            const Vec3 &from = contour.points[i > 0 ? i - 1 : contour.points.size() - 1], &to = contour.points[i];
            found->edges.emplace_back(found->plane.to_uv(from), found->plane.to_uv(to));
        }
    }
    return drawings;
}

/// Where the ray from `start` in the unit direction `along` meets the edge; infinity where it does not.
double hit(const Point2& start, const Point2& along, const Point2& a, const Point2& b) {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    const Point2 edge = minus(b, a), to_a = minus(a, start);
    const double turn = cross2(along, edge);
    if (turn == 0) return kNone;
    const double distance = cross2(to_a, edge) / turn, at = cross2(to_a, along) / turn;
    return distance >= 0 && at >= 0 && at <= 1 ? distance : kNone;
}

double gap(const Drawing& drawing, const BoundaryPoint& point, double reach, double own_edge) {
    const Point2 start = drawing.plane.to_uv(point.position);
    const Point2 along{dot(point.inplane_normal, drawing.plane.u), dot(point.inplane_normal, drawing.plane.v)};
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& [a, b] : drawing.edges) {
        const double limit = std::min(nearest, reach);
        if (std::min(a[0], b[0]) > start[0] + limit || std::max(a[0], b[0]) < start[0] - limit) continue;
        if (std::min(a[1], b[1]) > start[1] + limit || std::max(a[1], b[1]) < start[1] - limit) continue;
        if (const double distance = hit(start, along, a, b); distance > own_edge) nearest = std::min(nearest, distance);
    }
    return nearest <= reach ? nearest : std::numeric_limits<double>::infinity();
}

}  // namespace

void find_gaps(const ContourSet& set, double reach_mm, double tolerance_mm, std::vector<BoundaryPoint>& points, int threads) {
    const std::vector<Drawing> drawings = drawings_of(set, tolerance_mm);
    std::vector<const Drawing*> drawing_of(set.contours.size());
    for (const Drawing& drawing : drawings)
        for (const std::int32_t c : drawing.contours) drawing_of[static_cast<std::size_t>(c)] = &drawing;
    // Points of refined contours lie on their edge only up to rounding.
    const double own_edge = 1e-9 * diameter_mm(set);
    parallel_for(static_cast<std::int64_t>(points.size()), 128, threads, [&](std::int64_t begin, std::int64_t end) {
        for (; begin < end; ++begin) {
            BoundaryPoint& point = points[static_cast<std::size_t>(begin)];
            if (point.contour != kNoContour && !(point.inplane_normal == Vec3{}))
                point.gap_mm = gap(*drawing_of[static_cast<std::size_t>(point.contour)], point, reach_mm, own_edge);
        }
    });
}

}  // namespace kontur
