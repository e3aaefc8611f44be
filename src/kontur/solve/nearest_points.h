// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/function/point_arrays.h"
#include "kontur/solve/h2_cluster_tree.h"

namespace kontur {

/// Finds the points of an ordered set that are nearest to a group of its points and come before it.
class EarlierNeighbours {
public:
    /// Keeps a reference to the points.
    EarlierNeighbours(const PointArrays& points, const Work& work);

    /// The `count` points nearest to any of the points [begin, end), among those before `begin`; ascending, and fewer if
    /// there are not that many.
    std::vector<std::int32_t> of(std::int32_t begin, std::int32_t end, std::int32_t count) const;

private:
    struct Search;

    void visit(std::int32_t cluster, Search& search) const;

    const PointArrays& points_;
    ClusterTree tree_;
    PointArrays clustered_;               ///< the points in the tree's order
    std::vector<std::int32_t> earliest_;  ///< first point of every cluster
};

/// The `count` points nearest to a place among those that are `wanted`; ascending, and fewer if there are not that many.
/// Asks all of them: for a few places.
std::vector<std::int32_t> nearest_points(const PointArrays& points, const Vec3& place, std::int32_t count,
                                         const std::function<bool(std::size_t)>& is_wanted);

}  // namespace kontur
