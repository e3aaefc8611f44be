// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "kontur/base/error.h"

namespace kontur {
namespace {

/// An edge as its smaller and larger point, and whether the triangle runs from the larger to the smaller one.
struct Edge {
    std::uint32_t low, high;
    bool backward;

    bool same_points(const Edge& b) const { return low == b.low && high == b.high; }
    friend auto operator<=>(const Edge&, const Edge&) = default;  // NOLINT(modernize-use-nullptr): clang-tidy 14's own
};

std::vector<Edge> sorted_edges(const TriangleMesh& mesh) {
    std::vector<Edge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const auto& t : mesh.triangles)
        for (int side = 0; side < 3; ++side) {
            const std::uint32_t a = t[side], b = t[(side + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), a > b});
        }
    std::sort(edges.begin(), edges.end());
    return edges;
}

/// Disjoint sets of points joined by edges (union by the smaller index, path halving).
class Components {
public:
    explicit Components(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

    std::uint32_t root(std::uint32_t p) {
        while (parent_[p] != p) p = parent_[p] = parent_[parent_[p]];
        return p;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> parent_;
};

void check_triangles(const TriangleMesh& mesh) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (const std::uint32_t corner : mesh.triangles[i])
            if (corner >= mesh.points.size())
                throw Error(ErrorKind::invalid_input, fmt::format("triangle {} of the mesh refers to point {} of {}", i + 1,
                                                                  std::uint64_t{corner} + 1, mesh.points.size()));
}

}  // namespace

void check_mesh(const TriangleMesh& mesh) {
    if (!mesh.normals.empty() && mesh.normals.size() != mesh.points.size())
        throw Error(ErrorKind::invalid_input,
                    fmt::format("the mesh has {} normals for {} points", mesh.normals.size(), mesh.points.size()));
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const Vec3& p = mesh.points[i];
        constexpr double kLargest = std::numeric_limits<float>::max();
        if (!is_finite(p) || std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > kLargest)
            throw Error(ErrorKind::invalid_input, fmt::format("point {} of the mesh is ({}, {}, {}); at most {} is possible",
                                                              i + 1, p.x, p.y, p.z, kLargest));
    }
    check_triangles(mesh);
}

std::vector<Vec3> point_normals(const TriangleMesh& mesh) {
    std::vector<Vec3> normals(mesh.points.size());
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 area = cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]);
        for (const std::uint32_t p : {a, b, c}) normals[p] += area;
    }
    for (Vec3& n : normals) n = normalized(n);
    return normals;
}

double signed_volume_mm3(const TriangleMesh& mesh) {
    check_triangles(mesh);
    if (mesh.points.empty()) return 0;
    // Far from the origin the tetrahedra would cancel almost entirely; a point of the mesh keeps them small.
    const Vec3 apex = bounding_box(mesh.points).center();
    double six_fold = 0;
    for (const auto& t : mesh.triangles)
        six_fold += dot(mesh.points[t[0]] - apex, cross(mesh.points[t[1]] - apex, mesh.points[t[2]] - apex));
    return six_fold / 6;
}

MeshTopology topology(const TriangleMesh& mesh) {
    check_triangles(mesh);
    const std::vector<Edge> edges = sorted_edges(mesh);
    MeshTopology result;
    result.closed = result.oriented = !edges.empty();

    std::vector<bool> is_used(mesh.points.size());
    Components components(mesh.points.size());
    std::int64_t edge_count = 0;
    for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
        while (last < edges.size() && edges[last].same_points(edges[first])) ++last;
        ++edge_count;
        result.closed &= last - first == 2;
        result.oriented &= last - first == 2 && edges[first].backward != edges[first + 1].backward;
        is_used[edges[first].low] = is_used[edges[first].high] = true;
        components.join(edges[first].low, edges[first].high);
    }

    std::int64_t point_count = 0;
    for (std::uint32_t p = 0; p < mesh.points.size(); ++p) {
        if (!is_used[p]) continue;
        ++point_count;
        if (components.root(p) == p) ++result.components;
    }
    result.euler = point_count - edge_count + static_cast<std::int64_t>(mesh.triangles.size());
    return result;
}

}  // namespace kontur
