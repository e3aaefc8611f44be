// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "kontur/io/geometry/keyhole.h"

namespace kontur {
namespace {

using Point2 = std::array<double, 2>;

struct Corner {
    Vec3 point;
    Point2 uv{};
    bool has_channel = false;
};
using Ring = std::vector<Corner>;

struct Edge {
    Point2 a{}, b{};
};

Ring project(const std::vector<Vec3>& points, const Plane& plane) {
    Ring ring;
    for (const Vec3& p : points) ring.push_back({p, plane.to_uv(p)});
    return ring;
}

double twice_area(const Point2& a, const Point2& b, const Point2& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
}

double twice_area(const Ring& ring) {
    double sum = 0;
    for (std::size_t i = 2; i < ring.size(); ++i) sum += twice_area(ring[0].uv, ring[i - 1].uv, ring[i].uv);
    return sum;
}

void append_edges(std::vector<Edge>& edges, const Ring& ring) {
    for (std::size_t i = 0, before = ring.size() - 1; i < ring.size(); before = i++)
        edges.push_back({ring[before].uv, ring[i].uv});
}

bool is_between(const Point2& a, const Point2& b, const Point2& p) {
    return std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) && std::min(a[1], b[1]) <= p[1] &&
           p[1] <= std::max(a[1], b[1]);
}

/// Touching counts, except at a common end.
bool meets(const Edge& s, const Edge& t) {
    if (s.a == t.a || s.a == t.b || s.b == t.a || s.b == t.b) return false;
    const double ta = twice_area(s.a, s.b, t.a), tb = twice_area(s.a, s.b, t.b);
    const double sa = twice_area(t.a, t.b, s.a), sb = twice_area(t.a, t.b, s.b);
    if (ta * tb < 0 && sa * sb < 0) return true;
    return (ta == 0 && is_between(s.a, s.b, t.a)) || (tb == 0 && is_between(s.a, s.b, t.b)) ||
           (sa == 0 && is_between(t.a, t.b, s.a)) || (sb == 0 && is_between(t.a, t.b, s.b));
}

std::size_t rightmost(const Ring& ring) {
    const auto found =
        std::max_element(ring.begin(), ring.end(), [](const Corner& a, const Corner& b) { return a.uv < b.uv; });
    return static_cast<std::size_t>(found - ring.begin());
}

/// The corner of the path nearest to `from` that sees it. Every channel meets the path at a corner of its own, so that it
/// stays clear in which order the path runs through them.
std::size_t visible_corner(const Ring& path, const Point2& from, const std::vector<Edge>& edges) {
    std::vector<std::pair<double, std::size_t>> by_distance;
    for (std::size_t i = 0; i < path.size(); ++i)
        by_distance.emplace_back(std::hypot(path[i].uv[0] - from[0], path[i].uv[1] - from[1]), i);
    std::sort(by_distance.begin(), by_distance.end());
    for (const auto& [distance, i] : by_distance) {
        const Edge channel{from, path[i].uv};
        if (path[i].has_channel) continue;
        if (std::none_of(edges.begin(), edges.end(), [&](const Edge& edge) { return meets(channel, edge); })) return i;
    }
    return by_distance.front().second;  // only where rings cross; a channel encloses nothing wherever it runs
}

/// The path with the hole inserted: ..., corner, hole once around, corner, ...
void insert(Ring& path, Ring hole, std::vector<Edge>& edges) {
    const std::size_t gate = rightmost(hole);
    const std::size_t corner = visible_corner(path, hole[gate].uv, edges);
    edges.push_back({hole[gate].uv, path[corner].uv});
    path[corner].has_channel = hole[gate].has_channel = true;
    std::rotate(hole.begin(), hole.begin() + static_cast<std::ptrdiff_t>(gate), hole.end());
    hole.push_back(hole.front());
    hole.push_back(path[corner]);
    path.insert(path.begin() + static_cast<std::ptrdiff_t>(corner) + 1, hole.begin(), hole.end());
}

}  // namespace

std::vector<Vec3> join_keyhole(const std::vector<Vec3>& outer, const std::vector<std::vector<Vec3>>& holes,
                               const Plane& plane) {
    Ring path = project(outer, plane);
    std::vector<Edge> edges;
    append_edges(edges, path);
    std::vector<Ring> rings;
    for (const std::vector<Vec3>& hole : holes) {
        Ring ring = project(hole, plane);
        if ((twice_area(ring) > 0) == (twice_area(path) > 0)) std::reverse(ring.begin(), ring.end());
        append_edges(edges, ring);
        rings.push_back(std::move(ring));
    }
    // From the right: whatever a hole's rightmost corner sees farther to the right is part of the path already.
    std::sort(rings.begin(), rings.end(),
              [](const Ring& a, const Ring& b) { return a[rightmost(a)].uv > b[rightmost(b)].uv; });
    for (Ring& ring : rings) insert(path, std::move(ring), edges);
    std::vector<Vec3> points;
    for (const Corner& corner : path) points.push_back(corner.point);
    return points;
}

}  // namespace kontur
