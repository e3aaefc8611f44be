// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>

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
    using Candidate = std::pair<double, std::int32_t>;  ///< squared distance, point
    struct Search;

    void visit(std::int32_t cluster, Search& search) const;

    const PointArrays& points_;
    ClusterTree tree_;
    PointArrays clustered_;               ///< the points in the tree's order
    std::vector<std::int32_t> earliest_;  ///< first point of every cluster
};

}  // namespace kontur
