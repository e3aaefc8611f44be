// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/geometry/keyhole.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <unordered_map>

namespace kontur {
namespace {

using Vertex = std::size_t;

/// Vertices none of which lies within the tolerance of another, in cells that a point's tolerance reaches two of along an
/// axis at most.
class Vertices {
public:
    Vertices(const std::vector<Vec3>& path, double tolerance) : path_(path), tolerance_(tolerance) {}

    /// The first vertex within the tolerance of a point of the path; without any the point becomes one.
    Vertex at(Vertex point) {
        const Vec3& p = path_[point];
        const Cell low = cell_of(p - Vec3{tolerance_, tolerance_, tolerance_});
        const Cell high = cell_of(p + Vec3{tolerance_, tolerance_, tolerance_});
        Vertex first = point;
        for (unsigned corner = 0; corner < 8; ++corner) {
            Cell cell = low;
            bool repeats_another = false;
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (corner >> axis & 1) {
                    repeats_another |= low[axis] == high[axis];
                    cell[axis] = high[axis];
                }
            const auto found = repeats_another ? cells_.end() : cells_.find(cell);
            if (found == cells_.end()) continue;
            for (const Vertex v : found->second)
                if (distance(path_[v], p) <= tolerance_) first = std::min(first, v);
        }
        if (first == point) cells_[cell_of(p)].push_back(point);
        return first;
    }

private:
    using Cell = std::array<double, 3>;  // whole numbers, which may be too large for integers

    struct Hash {
        std::size_t operator()(const Cell& cell) const {
            std::size_t hash = 0;
            for (const double number : cell) hash = hash * 0x9E3779B97F4A7C15 + std::hash<double>()(number);
            return hash;
        }
    };

    Cell cell_of(const Vec3& p) const {
        const double edge = 4 * tolerance_;
        return {std::floor(p.x / edge), std::floor(p.y / edge), std::floor(p.z / edge)};
    }

    const std::vector<Vec3>& path_;
    double tolerance_;
    std::unordered_map<Cell, std::vector<Vertex>, Hash> cells_;
};

/// For each point the number of the vertex it lies on: the first point of the path within the tolerance that is one.
std::vector<Vertex> merge_points(const std::vector<Vec3>& path, double tolerance) {
    Vertices vertices(path, tolerance);
    std::vector<Vertex> vertex(path.size());
    for (Vertex point = 0; point < path.size(); ++point) vertex[point] = vertices.at(point);
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
