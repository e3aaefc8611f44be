// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/function/kernel.h"
#include "kontur/function/point_arrays.h"

namespace kontur {

/// Points that lie together: a run of ClusterTree::order, with their bounding box.
struct Cluster {
    std::int32_t begin = 0, end = 0;
    std::int32_t first_child = -1;  ///< its two children are neighbours in ClusterTree::clusters; -1 for a leaf
    Vec3 center, half;              ///< of the box

    bool is_leaf() const { return first_child < 0; }
    std::int32_t size() const { return end - begin; }
    double diameter() const { return 2 * norm(half); }
};

/// Distance between two boxes; 0 where they touch or overlap.
double box_distance(const Cluster& a, const Cluster& b);

/// A binary tree of clusters: each box is halved across its longest axis such that both sides get as many points, until
/// `leaf_size` are left (Hackbusch 2015, ch. 5.4). Points that coincide cannot stop it, and a far outlier costs one level.
struct ClusterTree {
    ClusterTree(const PointArrays& points, std::int32_t leaf_size, const Work& work);

    std::vector<std::int32_t> order;        ///< points so that every cluster is a run
    std::vector<Cluster> clusters;          ///< level after level, the root first, siblings side by side
    std::vector<std::int32_t> level_begin;  ///< of every level in `clusters`, and its end
};

}  // namespace kontur
