// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/keyhole.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <unordered_map>

namespace kontur {
namespace {

using Vertex = std::size_t;

/// For each point the number of the vertex it lies on: the first point of the path within the tolerance.
std::vector<Vertex> merge_points(const std::vector<Vec3>& path, double tolerance) {
    std::vector<std::size_t> by_x(path.size());
    std::iota(by_x.begin(), by_x.end(), std::size_t{0});
    std::sort(by_x.begin(), by_x.end(), [&](std::size_t a, std::size_t b) { return path[a].x < path[b].x; });
    std::vector<Vertex> vertex(path.size());
    std::iota(vertex.begin(), vertex.end(), Vertex{0});
    for (std::size_t a = 0; a < by_x.size(); ++a)
        for (std::size_t b = a + 1; b < by_x.size() && path[by_x[b]].x - path[by_x[a]].x <= tolerance; ++b) {
            const auto [first, second] = std::minmax(by_x[a], by_x[b]);
            if (distance(path[first], path[second]) <= tolerance) vertex[second] = std::min(vertex[second], first);
        }
    for (Vertex& v : vertex) v = vertex[v];
    return vertex;
}

bool retraces_an_edge(const std::vector<Vertex>& vertices) {
    std::set<std::pair<Vertex, Vertex>> edges;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Vertex from = vertices[i], to = vertices[(i + 1) % vertices.size()];
        if (from == to) continue;
        if (edges.contains({to, from})) return true;
        edges.insert({from, to});
    }
    return false;
}

/// Cuts a ring off whenever the path comes back to a vertex that it is still on.
std::vector<std::vector<Vertex>> simple_rings(const std::vector<Vertex>& vertices) {
    std::vector<std::vector<Vertex>> rings;
    std::vector<Vertex> open;
    std::unordered_map<Vertex, std::size_t> place_in_open;
    for (const Vertex vertex : vertices) {
        const auto seen = place_in_open.find(vertex);
        if (seen == place_in_open.end()) {
            place_in_open[vertex] = open.size();
            open.push_back(vertex);
            continue;
        }
        const auto start = open.begin() + static_cast<std::ptrdiff_t>(seen->second);
        rings.emplace_back(start, open.end());
        for (auto left = start + 1; left != open.end(); ++left) place_in_open.erase(*left);
        open.erase(start + 1, open.end());
    }
    rings.push_back(std::move(open));
    return rings;
}

}  // namespace

std::vector<std::vector<Vec3>> split_keyhole(const std::vector<Vec3>& path, double tolerance_mm) {
    const std::vector<Vertex> vertices = merge_points(path, tolerance_mm);
    if (!retraces_an_edge(vertices)) return {path};
    std::vector<std::vector<Vec3>> rings;
    for (const std::vector<Vertex>& ring : simple_rings(vertices)) {
        if (ring.size() < 3) continue;  // an edge of the channel, there and back
        rings.emplace_back();
        for (const Vertex vertex : ring) rings.back().push_back(path[vertex]);
    }
    return rings;
}

}  // namespace kontur
