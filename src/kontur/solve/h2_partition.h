// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/solve/h2_cluster_tree.h"

namespace kontur {

struct ClusterPair {
    std::int32_t a, b;  ///< indices into ClusterTree::clusters
};

/// All pairs of points, each in exactly one pair of clusters: a block of the matrix and its transposed one.
struct PairPartition {
    std::vector<ClusterPair> far;   ///< admissible: max(diameter a, diameter b) <= eta distance(a, b), so of low rank
    std::vector<ClusterPair> near;  ///< leaves that are not; a == b for the pairs within a leaf
};

/// Hackbusch & Boerm 2002, sec. 2.3. Sorted by a.
PairPartition partition_pairs(const ClusterTree& tree, double eta);

}  // namespace kontur
