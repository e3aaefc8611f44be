// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/cell_triangles.h"

#include <optional>
#include <utility>

namespace kontur {
namespace {

constexpr int kAxes = 3;

/// Corners of a face in counter-clockwise order seen from outside of the cell.
struct CellFace {
    std::array<int, 4> corners;
};

std::array<CellEdge, 12> make_edges() {
    std::array<CellEdge, 12> edges;
    for (int axis = 0; axis < kAxes; ++axis)
        for (int position = 0; position < 4; ++position) {
            const int u = (axis + 1) % kAxes, v = (axis + 2) % kAxes;
            const int from = (position & 1) << u | (position >> 1) << v;
            edges[4 * axis + position] = {axis, from, from | 1 << axis};
        }
    return edges;
}

std::array<CellFace, 6> make_faces() {
    std::array<CellFace, 6> faces;
    for (int axis = 0; axis < kAxes; ++axis)
        for (int side = 0; side < 2; ++side) {
            const int u = 1 << (axis + 1) % kAxes, v = 1 << (axis + 2) % kAxes, base = side << axis;
            faces[2 * axis + side].corners = side ? std::array{base, base | u, base | u | v, base | v}
                                                  : std::array{base, base | v, base | u | v, base | u};
        }
    return faces;
}

int edge_between(int a, int b) {
    for (int e = 0; e < 12; ++e) {
        const CellEdge& edge = cell_edges()[static_cast<std::size_t>(e)];
        if ((edge.from == a && edge.to == b) || (edge.from == b && edge.to == a)) return e;
    }
    return -1;
}

bool share_a_face(int edge_a, int edge_b) {
    const CellEdge &a = cell_edges()[static_cast<std::size_t>(edge_a)], &b = cell_edges()[static_cast<std::size_t>(edge_b)];
    const int all = a.from & a.to & b.from & b.to, any = a.from | a.to | b.from | b.to;
    return all != 0 || any != 7;  // some coordinate is 1 for all four corners, or 0 for all
}

/// next[e]: the edge that follows edge e on the surface's border in this pattern, or -1.
std::array<int, 12> link_segments(unsigned inside) {
    static const std::array<CellFace, 6> faces = make_faces();
    const auto is_inside = [&](int corner) { return (inside >> corner & 1u) != 0; };
    std::array<int, 12> next;
    next.fill(-1);
    for (const CellFace& face : faces)
        for (std::size_t first = 0; first < 4; ++first) {
            // A run of inside corners that begins at `first`.
            if (!is_inside(face.corners[first]) || is_inside(face.corners[(first + 3) % 4])) continue;
            std::size_t last = first;
            while (is_inside(face.corners[(last + 1) % 4])) last = (last + 1) % 4;
            const int entry = edge_between(face.corners[(first + 3) % 4], face.corners[first]);
            const int exit = edge_between(face.corners[last], face.corners[(last + 1) % 4]);
            next[static_cast<std::size_t>(entry)] = exit;
        }
    return next;
}

using Loop = std::vector<int>;

std::vector<Loop> find_loops(unsigned inside) {
    std::array<int, 12> next = link_segments(inside);
    std::vector<Loop> loops;
    for (int start = 0; start < 12; ++start) {
        Loop loop;
        for (int e = start; next[static_cast<std::size_t>(e)] >= 0;) {
            loop.push_back(e);
            e = std::exchange(next[static_cast<std::size_t>(e)], -1);
        }
        if (!loop.empty()) loops.push_back(loop);
    }
    return loops;
}

/// Triangles of the polygon loop[first..last] such that no diagonal lies in a face of the cell.
std::optional<std::vector<CellTriangle>> triangulate(const Loop& loop, std::size_t first, std::size_t last) {
    if (last - first < 2) return std::vector<CellTriangle>{};
    const auto is_allowed = [&](std::size_t a, std::size_t b) {
        const bool side = b - a == 1 || (a == 0 && b + 1 == loop.size());
        return side || !share_a_face(loop[a], loop[b]);
    };
    for (std::size_t apex = first + 1; apex < last; ++apex) {
        if (!is_allowed(first, apex) || !is_allowed(apex, last)) continue;
        auto left = triangulate(loop, first, apex), right = triangulate(loop, apex, last);
        if (!left || !right) continue;
        left->insert(left->end(), right->begin(), right->end());
        left->push_back({static_cast<std::int8_t>(loop[first]), static_cast<std::int8_t>(loop[apex]),
                         static_cast<std::int8_t>(loop[last])});
        return left;
    }
    return std::nullopt;
}

std::array<std::vector<CellTriangle>, 256> make_table() {
    std::array<std::vector<CellTriangle>, 256> table;
    for (unsigned inside = 0; inside < 256; ++inside)
        for (const Loop& loop : find_loops(inside)) {
            const auto triangles = triangulate(loop, 0, loop.size() - 1);
            table[inside].insert(table[inside].end(), triangles.value().begin(), triangles.value().end());
        }
    return table;
}

}  // namespace

const std::array<CellEdge, 12>& cell_edges() {
    static const std::array<CellEdge, 12> edges = make_edges();
    return edges;
}

std::span<const CellTriangle> cell_triangles(unsigned inside_corners) {
    static const std::array<std::vector<CellTriangle>, 256> table = make_table();
    return table[inside_corners & 0xffu];
}

}  // namespace kontur
