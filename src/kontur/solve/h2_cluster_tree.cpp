// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/h2_cluster_tree.h"

#include <algorithm>
#include <numeric>

#include "kontur/base/parallel.h"

namespace kontur {
namespace {

void enclose(const PointArrays& points, const std::vector<std::int32_t>& order, Cluster& cluster) {
    Box3 box;
    for (std::int32_t i = cluster.begin; i < cluster.end; ++i)
        box.extend(points[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])]);
    cluster.half = 0.5 * box.size();
    cluster.center = box.min + cluster.half;
}

/// Orders the cluster's points so that the lower ones along its longest axis come first; returns where the others begin.
std::int32_t halve(const PointArrays& points, const Cluster& cluster, std::int32_t leaf_size,
                   std::vector<std::int32_t>& order) {
    const Vec3& h = cluster.half;
    const std::vector<double>& along = h.x >= h.y && h.x >= h.z ? points.x : h.y >= h.z ? points.y : points.z;
    // Full leaves fill the vector registers best, so the first half is made of them.
    const std::int32_t leaves = (cluster.size() + leaf_size - 1) / leaf_size;
    const std::int32_t middle = cluster.begin + (leaves + 1) / 2 * leaf_size;
    std::nth_element(order.begin() + cluster.begin, order.begin() + middle, order.begin() + cluster.end,
                     [&](std::int32_t a, std::int32_t b) {
                         const double at_a = along[static_cast<std::size_t>(a)], at_b = along[static_cast<std::size_t>(b)];
                         return at_a != at_b ? at_a < at_b : a < b;
                     });
    return middle;
}

}  // namespace

double box_distance(const Cluster& a, const Cluster& b) {
    const auto gap = [&](int axis) {
        return std::max(0.0, std::abs(a.center[axis] - b.center[axis]) - a.half[axis] - b.half[axis]);
    };
    return norm(Vec3{gap(0), gap(1), gap(2)});
}

ClusterTree::ClusterTree(const PointArrays& points, std::int32_t leaf_size, const Work& work) : order(points.size()) {
    std::iota(order.begin(), order.end(), 0);
    clusters.resize(1);
    clusters.front().end = static_cast<std::int32_t>(points.size());
    enclose(points, order, clusters.front());
    level_begin = {0, 1};
    for (std::size_t level = 0; level_begin[level] < level_begin[level + 1]; ++level) {
        for (std::int32_t c = level_begin[level]; c < level_begin[level + 1]; ++c) {
            Cluster& cluster = clusters[static_cast<std::size_t>(c)];
            if (cluster.size() <= leaf_size) continue;
            cluster.first_child = static_cast<std::int32_t>(clusters.size());
            clusters.insert(clusters.end(), 2, {});
        }
        parallel_for(level_begin[level + 1] - level_begin[level], 1, work, [&](std::int64_t begin, std::int64_t end) {
            for (auto c = static_cast<std::size_t>(level_begin[level] + begin);
                 c < static_cast<std::size_t>(level_begin[level] + end); ++c) {
                const Cluster& parent = clusters[c];
                if (parent.is_leaf()) continue;
                Cluster *lower = &clusters[static_cast<std::size_t>(parent.first_child)], *upper = lower + 1;
                const std::int32_t middle = halve(points, parent, leaf_size, order);
                lower->begin = parent.begin;
                lower->end = upper->begin = middle;
                upper->end = parent.end;
                enclose(points, order, *lower);
                enclose(points, order, *upper);
            }
        });
        level_begin.push_back(static_cast<std::int32_t>(clusters.size()));
    }
    level_begin.pop_back();  // an empty level
}

}  // namespace kontur
