// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/h2_kernel_matrix.h"

#include <algorithm>

#include "kontur/base/parallel.h"

namespace kontur {
namespace {

/// Clusters in far pairs and all below them.
std::vector<bool> clusters_with_basis(const ClusterTree& tree, const PairPartition& partition) {
    std::vector<bool> is_used(tree.clusters.size());
    for (const ClusterPair& pair : partition.far)
        is_used[static_cast<std::size_t>(pair.a)] = is_used[static_cast<std::size_t>(pair.b)] = true;
    for (std::size_t c = 0; c < is_used.size(); ++c)
        if (is_used[c] && !tree.clusters[c].is_leaf())
            for (const std::int32_t child : {0, 1}) is_used[tree.clusters[c].first_child + child] = true;
    return is_used;
}

/// Sorts runs and joins those that touch or nearly do.
void join(std::vector<NodeRun>& runs, std::int32_t gap) {
    std::sort(runs.begin(), runs.end(), [](NodeRun a, NodeRun b) { return a.begin < b.begin; });
    std::size_t count = 0;
    for (const NodeRun& run : runs)
        if (count > 0 && run.begin <= runs[count - 1].end + gap)
            runs[count - 1].end = std::max(runs[count - 1].end, run.end);
        else runs[count++] = run;
    runs.resize(count);
}

}  // namespace

H2KernelMatrix::H2KernelMatrix(Kernel kernel, const PointArrays& points, const H2Options& options, const Work& work)
    : kernel_(kernel),
      work_(work),
      tree_(points, options.leaf_size, work),
      partition_(partition_pairs(tree_, options.eta)),
      basis_(kernel, points, {tree_, clusters_with_basis(tree_, partition_)}, options, work) {
    add_rows(partition_.near, false);
    add_rows(partition_.far, true);
    partition_ = {};
    group_rows();
}

void H2KernelMatrix::add_rows(const std::vector<ClusterPair>& pairs, bool far) {
    const auto nodes = [&](std::int32_t c) {
        const Cluster& cluster = tree_.clusters[static_cast<std::size_t>(c)];
        return far ? basis_.skeleton(c) : NodeRun{cluster.begin, cluster.end};
    };
    std::vector<NodeRun> runs;
    for (std::size_t begin = 0, end; begin < pairs.size(); begin = end) {
        runs.clear();
        bool own = false;
        for (end = begin; end < pairs.size() && pairs[end].a == pairs[begin].a; ++end)
            if (pairs[end].b == pairs[end].a) own = true;
            else runs.push_back(nodes(pairs[end].b));
        join(runs, 0);
        rows_.push_back({nodes(pairs[begin].a), rights_.size(), rights_.size() + runs.size(), own});
        rights_.insert(rights_.end(), runs.begin(), runs.end());
    }
}

double H2KernelMatrix::cost(const Row& row) const {
    double others = row.own ? row.left.size() : 0;
    for (const NodeRun& run : row.rights(rights_)) others += run.size();
    return others * row.left.size();
}

void H2KernelMatrix::group_rows() {
    for (const Row& row : rows_) evaluations_ += cost(row);
    double progress = 0;
    for (std::size_t r = 0; r < rows_.size();) {
        Group group{r, r, {}};
        const double until = evaluations_ * static_cast<double>(groups_.size() + 1) / kMostGroups;
        for (; r < rows_.size() && (r == group.first_row || progress < until); ++r) {
            progress += cost(rows_[r]);
            group.touched.push_back(rows_[r].left);
            const auto rights = rows_[r].rights(rights_);
            group.touched.insert(group.touched.end(), rights.begin(), rights.end());
        }
        group.last_row = r;
        join(group.touched, 64);
        groups_.push_back(std::move(group));
    }
}

void H2KernelMatrix::multiply(std::span<const double> weights, std::span<double> out) const {
    const auto count = static_cast<std::size_t>(basis_.node_count());
    std::vector<double> node_weights(count + kNodePadding);
    for (std::size_t i = 0; i < tree_.order.size(); ++i) node_weights[i] = weights[static_cast<std::size_t>(tree_.order[i])];
    basis_.collect(node_weights, work_);

    const PointArrays& nodes = basis_.nodes();
    const NodeView view{nodes.x.data(), nodes.y.data(), nodes.z.data(), node_weights.data()};
    sums_.resize(groups_.size());
    parallel_for(static_cast<std::int64_t>(groups_.size()), 1, work_, [&](std::int64_t begin, std::int64_t end) {
        for (auto g = static_cast<std::size_t>(begin); g < static_cast<std::size_t>(end); ++g) {
            std::vector<double>& sums = sums_[g];
            sums.resize(count);
            for (const NodeRun& run : groups_[g].touched) std::fill(sums.begin() + run.begin, sums.begin() + run.end, 0.0);
            for (std::size_t r = groups_[g].first_row; r < groups_[g].last_row; ++r) {
                if (r % 64 == 0) work_.check();
                if (rows_[r].own) add_own_sums(kernel_, view, rows_[r].left, sums.data());
                add_mutual_sums(kernel_, view, rows_[r].left, rows_[r].rights(rights_), sums.data());
            }
        }
    });
    std::vector<double> fields(count);
    for (std::size_t g = 0; g < groups_.size(); ++g)
        for (const NodeRun& run : groups_[g].touched)
            for (auto i = static_cast<std::size_t>(run.begin); i < static_cast<std::size_t>(run.end); ++i)
                fields[i] += sums_[g][i];
    basis_.spread(fields, work_);
    for (std::size_t i = 0; i < tree_.order.size(); ++i) out[static_cast<std::size_t>(tree_.order[i])] = fields[i];
}

double H2KernelMatrix::megabytes() const {
    return (basis_.bytes() + static_cast<double>(rows_.size() * sizeof(Row) + rights_.size() * sizeof(NodeRun) +
                                                 tree_.clusters.size() * sizeof(Cluster))) /
           (1 << 20);
}

}  // namespace kontur
