// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/opposite_walls.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/parallel.h"
#include "kontur/shape/box_tree.h"
#include "kontur/shape/contour_nesting.h"
#include "kontur/shape/predicates.h"

namespace kontur {
namespace {

Point2 minus(const Point2& a, const Point2& b) { return {a[0] - b[0], a[1] - b[1]}; }
double cross2(const Point2& a, const Point2& b) { return a[0] * b[1] - a[1] * b[0]; }

/// All lines of a plane in its coordinates.
struct PlaneLines {
    static constexpr std::size_t kStretchEdges = 16;

    Plane plane;
    std::vector<std::pair<Point2, Point2>> edges;
    BoxTree stretches;  ///< boxes of every kStretchEdges edges

    void finish() {
        std::vector<Box2> boxes((edges.size() + kStretchEdges - 1) / kStretchEdges);
        for (std::size_t e = 0; e < edges.size(); ++e)
            for (const Point2& end : {edges[e].first, edges[e].second}) boxes[e / kStretchEdges].extend(end);
        stretches = BoxTree(std::move(boxes));
    }
};

struct AllLines {
    std::vector<PlaneLines> all;
    std::vector<std::size_t> of;  ///< for each contour which one it belongs to

    const PlaneLines& with(std::int32_t contour) const { return all[of[static_cast<std::size_t>(contour)]]; }
};

AllLines lines_of(std::span<const PreparedLine> prepared_lines, Contour PreparedLine::*state, double tolerance_mm) {
    std::vector<Contour> contours;
    for (const PreparedLine& line : prepared_lines) contours.push_back(line.*state);
    const std::vector<std::size_t> plane = shared_planes(contours, tolerance_mm);
    AllLines lines{{}, std::vector<std::size_t>(contours.size())};
    for (std::size_t c = 0; c < contours.size(); ++c)
        if (plane[c] == c) {
            lines.of[c] = lines.all.size();
            lines.all.push_back({contours[c].plane, {}, BoxTree{}});
        }
    for (std::size_t c = 0; c < contours.size(); ++c) {
        const Contour& contour = contours[c];
        lines.of[c] = lines.of[plane[c]];
        PlaneLines& lines_here = lines.all[lines.of[c]];
        for (std::size_t i = contour.closed ? 0 : 1; i < contour.points.size(); ++i) {
            const Vec3 &from = contour.points[i > 0 ? i - 1 : contour.points.size() - 1], &to = contour.points[i];
            lines_here.edges.emplace_back(lines_here.plane.to_uv(from), lines_here.plane.to_uv(to));
        }
    }
    for (PlaneLines& lines_here : lines.all) lines_here.finish();
    return lines;
}

/// Where the ray from `start` in the unit direction `along` meets the edge; infinity where it does not.
double hit(const Point2& start, const Point2& along, const Point2& a, const Point2& b) {
    const Point2 edge = minus(b, a), to_a = minus(a, start);
    const double turn = cross2(along, edge);
    if (turn == 0) return std::numeric_limits<double>::infinity();
    const double distance = cross2(to_a, edge) / turn, at = cross2(to_a, along) / turn;
    return distance >= 0 && at >= 0 && at <= 1 ? distance : std::numeric_limits<double>::infinity();
}

/// From the point in the unit direction to the next line; infinity beyond the reach.
double gap(const PlaneLines& lines_here, const Vec3& from, const Vec3& direction, double reach, double own_edge) {
    const Point2 start = lines_here.plane.to_uv(from);
    const Point2 along{dot(direction, lines_here.plane.u), dot(direction, lines_here.plane.v)};
    Box2 ray;
    ray.extend(start);
    ray.extend(Point2{start[0] + reach * along[0], start[1] + reach * along[1]});
    const double rounding = 1e-6 * reach;
    for (const std::size_t axis : {0u, 1u}) {
        ray.low[axis] -= rounding;
        ray.high[axis] += rounding;
    }
    double nearest = std::numeric_limits<double>::infinity();
    const auto squared_limit = [&] {
        const double limit = std::min(nearest, reach) + rounding;
        return limit * limit;
    };
    const auto key = [&](const Box2& box) {
        return box.meets(ray) ? box.distance2(start) : std::numeric_limits<double>::infinity();
    };
    lines_here.stretches.visit(key, squared_limit, [&](std::size_t s) {
        const std::size_t begin = s * PlaneLines::kStretchEdges;
        const std::size_t end = std::min(begin + PlaneLines::kStretchEdges, lines_here.edges.size());
        for (std::size_t e = begin; e < end; ++e) {
            const auto& [a, b] = lines_here.edges[e];
            if (const double distance = hit(start, along, a, b); distance > own_edge) nearest = std::min(nearest, distance);
        }
    });
    return nearest <= reach ? nearest : std::numeric_limits<double>::infinity();
}

// Points of subdivided contours lie on their edge only up to rounding.
double own_edge(double tolerance_mm) { return 1e-5 * tolerance_mm; }

/// Subdivides edges of one contour.
class NarrowEdges {
public:
    struct Limits {
        double shortest_mm, long_mm, bulge_mm, own_edge_mm;
    };

    NarrowEdges(const PlaneLines& lines_here, const Limits& limits) : lines_(lines_here), limits_(limits) {}

    std::vector<Vec3> subdivision(const std::vector<Vec3>& drawn_points, const Contour& line) const {
        const std::vector<Vec3>& all = line.points;
        const std::size_t n = all.size();
        const auto turn_at = [&](std::size_t i) {
            if (!line.closed && (i == 0 || i == n - 1)) return 0.0;
            return turn(all[(i + n - 1) % n], all[i], all[(i + 1) % n]);
        };
        std::vector<Vec3> points;
        std::size_t next = 0;  // of the drawn points
        bool is_long = false;
        for (std::size_t i = 0; i < (line.closed ? n : n - 1); ++i) {
            if (next < drawn_points.size() && all[i] == drawn_points[next]) {
                ++next;
                is_long = distance(all[i], drawn_points[next % drawn_points.size()]) > limits_.long_mm;
            }
            append({all[i], all[(i + 1) % n], turn_at(i), turn_at((i + 1) % n)}, is_long, points);
        }
        if (!line.closed) points.push_back(all.back());
        return points;
    }

private:
    struct Edge {
        Vec3 from, to;
        double turn_before, turn_after;  ///< rad, of the line at its ends; > 0 to the left
    };

    /// All points of the edge but its last.
    void append(const Edge& edge, bool is_long, std::vector<Vec3>& points) const {
        const bool is_fine = distance(edge.from, edge.to) < 2 * limits_.shortest_mm;
        if (is_fine || !((is_long && is_narrow(edge)) || bulges(edge))) return points.push_back(edge.from);
        const Vec3 middle = 0.5 * (edge.from + edge.to);
        append({edge.from, middle, edge.turn_before, 0}, is_long, points);
        append({middle, edge.to, 0, edge.turn_after}, is_long, points);
    }

    bool is_narrow(const Edge& edge) const {
        const double length = distance(edge.from, edge.to);
        const Vec3 across = cross(lines_.plane.normal, edge.to - edge.from) / length, middle = 0.5 * (edge.from + edge.to);
        return std::isfinite(gap(lines_, middle, across, length, limits_.own_edge_mm)) ||
               std::isfinite(gap(lines_, middle, -across, length, limits_.own_edge_mm));
    }

    bool bulges(const Edge& edge) const {
        if (edge.turn_before * edge.turn_after < 0) return false;
        const double arc = std::abs(edge.turn_before + edge.turn_after) / 2;
        return distance(edge.from, edge.to) / 2 * std::tan(arc / 4) > limits_.bulge_mm;
    }

    double turn(const Vec3& before, const Vec3& at, const Vec3& after) const {
        const Point2 in = minus(lines_.plane.to_uv(at), lines_.plane.to_uv(before)),
                     out = minus(lines_.plane.to_uv(after), lines_.plane.to_uv(at));
        return std::atan2(cross2(in, out), in[0] * out[0] + in[1] * out[1]);
    }

    const PlaneLines& lines_;
    const Limits limits_;
};

}  // namespace

void find_opposite_walls(std::span<const PreparedLine> prepared_lines, double reach_mm, double tolerance_mm,
                         std::vector<BoundaryPoint>& points, const Work& work) {
    const AllLines lines = lines_of(prepared_lines, &PreparedLine::fitted, tolerance_mm);
    const double own = own_edge(tolerance_mm);
    parallel_for(static_cast<std::int64_t>(points.size()), 128, work, [&](std::int64_t begin, std::int64_t end) {
        for (; begin < end; ++begin) {
            BoundaryPoint& point = points[static_cast<std::size_t>(begin)];
            if (point.contour == kNoContour || point.inplane_normal == Vec3{}) continue;
            const PlaneLines& here = lines.with(point.contour);
            point.gap_mm = gap(here, point.position, point.inplane_normal, reach_mm, own);
            point.depth_mm = gap(here, point.position, -point.inplane_normal, reach_mm, own);
        }
    });
}

void subdivide_narrow(std::span<PreparedLine> prepared_lines, double bulge_mm, double tolerance_mm, const Work& work) {
    const AllLines lines = lines_of(prepared_lines, &PreparedLine::reduced, tolerance_mm);
    parallel_for(static_cast<std::int64_t>(prepared_lines.size()), 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (; begin < end; ++begin) {
            PreparedLine& line = prepared_lines[static_cast<std::size_t>(begin)];
            const NarrowEdges edges(lines.with(static_cast<std::int32_t>(begin)),
                                    {line.shortest_mm, line.long_mm, bulge_mm, own_edge(tolerance_mm)});
            line.fitted.points = edges.subdivision(line.reduced.points, line.fitted);
        }
    });
}

}  // namespace kontur
