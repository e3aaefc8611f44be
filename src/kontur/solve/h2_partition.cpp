// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/h2_partition.h"

#include <algorithm>

namespace kontur {
namespace {

class PairSplitter {
public:
    PairSplitter(const ClusterTree& tree, double eta, PairPartition& result) : tree_(tree), eta_(eta), result_(result) {}

    void split_own(std::int32_t c) {
        const Cluster& cluster = at(c);
        if (cluster.is_leaf()) {
            result_.near.push_back({c, c});
            return;
        }
        split_own(cluster.first_child);
        split_own(cluster.first_child + 1);
        split(cluster.first_child, cluster.first_child + 1);
    }

private:
    const Cluster& at(std::int32_t c) const { return tree_.clusters[static_cast<std::size_t>(c)]; }

    void split(std::int32_t a, std::int32_t b) {
        const Cluster &ca = at(a), &cb = at(b);
        const double distance = box_distance(ca, cb), da = ca.diameter(), db = cb.diameter();
        if (distance > 0 && std::max(da, db) <= eta_ * distance) {
            result_.far.push_back({a, b});
        } else if (ca.is_leaf() && cb.is_leaf()) {
            result_.near.push_back({a, b});
        } else if (cb.is_leaf() || (!ca.is_leaf() && da >= db)) {
            split(ca.first_child, b);
            split(ca.first_child + 1, b);
        } else {
            split(a, cb.first_child);
            split(a, cb.first_child + 1);
        }
    }

    const ClusterTree& tree_;
    double eta_;
    PairPartition& result_;
};

}  // namespace

PairPartition partition_pairs(const ClusterTree& tree, double eta) {
    PairPartition result;
    PairSplitter(tree, eta, result).split_own(0);
    for (auto* pairs : {&result.far, &result.near})
        std::sort(pairs->begin(), pairs->end(),
                  [](const ClusterPair& p, const ClusterPair& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
    return result;
}

}  // namespace kontur
