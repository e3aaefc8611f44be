// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/surface_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "kontur/base/parallel.h"

namespace kontur {
namespace {

/// Of distances. From inside of a ball all of its triangles are about as far: to find the very nearest one would look at
/// thousands.
constexpr double kExactness = 0.98;

using Weights = std::array<double, 3>;

/// The place of the triangle that is nearest to p, as weights of its corners (Ericson 2005, section 5.1.5).
Weights nearest_place(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
    const double to_c = d4 - d3, to_b = d5 - d6;
    if (va <= 0 && to_c >= 0 && to_b >= 0) return {0, to_b / (to_c + to_b), to_c / (to_c + to_b)};
    const double sum = va + vb + vc;
    return {va / sum, vb / sum, vc / sum};
}

class TriangleTree {
public:
    /// `exactness`: the nearest distance over the one that is found, at least.
    TriangleTree(const TriangleMesh& mesh, double exactness)
        : mesh_(mesh), exactness_(exactness), order_(mesh.triangles.size()) {
        std::iota(order_.begin(), order_.end(), std::uint32_t{0});
        std::vector<Vec3> middles;
        middles.reserve(order_.size());
        for (const auto& [a, b, c] : mesh.triangles) middles.push_back(mesh.points[a] + mesh.points[b] + mesh.points[c]);
        nodes_.reserve(2 * (order_.size() / kLeafSize + 1));
        build(0, order_.size(), middles);
    }

    struct Hit {
        double squared = std::numeric_limits<double>::infinity();
        bool is_inside = false;
        Vec3 place;
    };

    Hit nearest(const Vec3& p) const {
        Hit hit;
        search(0, p, hit);
        return hit;
    }

private:
    static constexpr std::size_t kLeafSize = 8;

    struct Node {
        Box3 box;
        std::size_t begin, end, second_child = 0;  ///< the first child follows its parent; 0: a leaf
    };

    std::array<Vec3, 3> corners(std::size_t triangle) const {
        const auto& [a, b, c] = mesh_.triangles[triangle];
        return {mesh_.points[a], mesh_.points[b], mesh_.points[c]};
    }

    static void extend(Box3& box, const Vec3& p) {
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = std::min(box.min[axis], p[axis]);
            box.max[axis] = std::max(box.max[axis], p[axis]);
        }
    }

    void build(std::size_t begin, std::size_t end, const std::vector<Vec3>& middles) {
        const std::size_t here = nodes_.size();
        const Vec3 first = corners(order_[begin])[0];
        nodes_.push_back({{first, first}, begin, end});
        if (end - begin <= kLeafSize) {
            for (std::size_t n = begin; n < end; ++n)
                for (const Vec3& p : corners(order_[n])) extend(nodes_[here].box, p);
            return;
        }
        Box3 spread{middles[order_[begin]], middles[order_[begin]]};
        for (std::size_t n = begin; n < end; ++n) extend(spread, middles[order_[n]]);
        const Vec3 size = spread.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto at = [&](std::size_t n) { return order_.begin() + static_cast<std::ptrdiff_t>(n); };
        const std::size_t half = begin + (end - begin) / 2;
        std::nth_element(at(begin), at(half), at(end),
                         [&](std::uint32_t a, std::uint32_t b) { return middles[a][axis] < middles[b][axis]; });
        build(begin, half, middles);
        nodes_[here].second_child = nodes_.size();
        build(half, end, middles);
        for (const std::size_t child : {here + 1, nodes_[here].second_child}) {
            const Box3 box = nodes_[child].box;
            extend(nodes_[here].box, box.min);
            extend(nodes_[here].box, box.max);
        }
    }

    static double to_box(const Box3& box, const Vec3& p) {
        double squared = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double away = std::max({box.min[axis] - p[axis], p[axis] - box.max[axis], 0.0});
            squared += away * away;
        }
        return squared;
    }

    void search(std::size_t n, const Vec3& p, Hit& hit) const {
        const Node& node = nodes_[n];
        if (to_box(node.box, p) >= exactness_ * exactness_ * hit.squared) return;
        if (node.second_child == 0) {
            for (std::size_t i = node.begin; i < node.end; ++i) look_at(order_[i], p, hit);
            return;
        }
        const std::size_t first = n + 1, second = node.second_child;
        const bool is_first_nearer = to_box(nodes_[first].box, p) <= to_box(nodes_[second].box, p);
        search(is_first_nearer ? first : second, p, hit);
        search(is_first_nearer ? second : first, p, hit);
    }

    /// Inside is told by the normal of the place, between those of the corners: across an edge a triangle's own can be
    /// wrong.
    void look_at(std::size_t triangle, const Vec3& p, Hit& hit) const {
        const auto [a, b, c] = corners(triangle);
        const Weights w = nearest_place(p, a, b, c);
        const Vec3 place = w[0] * a + w[1] * b + w[2] * c, away = p - place;
        const double squared = dot(away, away);
        if (squared >= hit.squared) return;
        const auto& [i, j, k] = mesh_.triangles[triangle];
        const Vec3 normal = w[0] * mesh_.normals[i] + w[1] * mesh_.normals[j] + w[2] * mesh_.normals[k];
        hit = {squared, dot(away, normal) < 0, place};
    }

    const TriangleMesh& mesh_;
    double exactness_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

/// What `value` makes of the nearest place of each point.
template <class Value>
auto of_each(std::span<const Vec3> points, const TriangleMesh& surface, double exactness, const Value& value) {
    std::vector<decltype(value(TriangleTree::Hit{}))> values;
    if (surface.triangles.empty()) return values;
    const TriangleTree tree(surface, exactness);
    values.resize(points.size());
    parallel_for(static_cast<std::int64_t>(points.size()), 1024, 0, [&](std::int64_t begin, std::int64_t end) {
        for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
            values[n] = value(tree.nearest(points[n]));
    });
    return values;
}

}  // namespace

std::vector<double> distances_mm(std::span<const Vec3> points, const TriangleMesh& surface) {
    return of_each(points, surface, kExactness, [](const TriangleTree::Hit& hit) {
        return hit.is_inside ? -std::sqrt(hit.squared) : std::sqrt(hit.squared);
    });
}

std::vector<Vec3> nearest_places(std::span<const Vec3> points, const TriangleMesh& surface) {
    return of_each(points, surface, 1, [](const TriangleTree::Hit& hit) { return hit.place; });
}

}  // namespace kontur
