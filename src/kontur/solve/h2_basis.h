// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kontur/base/work.h"
#include "kontur/function/point_arrays.h"
#include "kontur/solve/h2_interpolation.h"
#include "kontur/solve/pair_sums.h"

namespace kontur {

struct H2Options {
    double tolerance = 1e-10;  ///< of an interpolated phi, root mean square, on unit coordinates
    double eta = 1.25;         ///< admissible: diameters at most eta times the distance
    std::int32_t leaf_size = 64;
};

/// Clusters of points, and which of them need a skeleton; the descendants of such a cluster need one, too.
struct UsedClusters {
    const ClusterTree& tree;
    const std::vector<bool>& used;
};

/// Nested cluster bases on the points themselves. The skeleton of a cluster is a few of its own points. From afar, weights
/// may be moved to the skeleton, and values on it determine a smooth field on all points. The skeleton of a cluster is
/// chosen from its children's (Martinsson & Rokhlin 2005).
///
/// All nodes stand in one sequence: first the points in the tree's order, then the skeletons, finest level first.
class NestedBasis {
public:
    /// The tree must outlive it.
    NestedBasis(Kernel kernel, const PointArrays& points, const UsedClusters& clusters, const H2Options& options,
                const Work& work);

    const PointArrays& nodes() const { return nodes_; }  ///< with kNodePadding more at the end
    std::int32_t node_count() const { return static_cast<std::int32_t>(nodes_.size()) - kNodePadding; }
    NodeRun skeleton(std::int32_t cluster) const { return skeletons_[static_cast<std::size_t>(cluster)]; }

    /// From the weights of the points to those of all skeletons.
    void collect(std::span<double> weights, const Work& work) const;
    /// Adds the skeletons' fields to those of the points.
    void spread(std::span<double> fields, const Work& work) const;

    double bytes() const;

private:
    NodeRun candidates(const Cluster& cluster) const;
    void add_level(std::int32_t begin, std::int32_t end);
    void append_node(std::size_t node);

    const ClusterTree& tree_;
    PointArrays nodes_;
    std::vector<NodeRun> skeletons_;             ///< of every cluster, empty if not used
    std::vector<Interpolation> interpolations_;  ///< of every cluster
};

}  // namespace kontur
