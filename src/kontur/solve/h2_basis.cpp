// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/h2_basis.h"

#include <algorithm>

#include "kontur/base/instruction_sets.h"
#include "kontur/base/parallel.h"
#include "kontur/function/kernel_sums.h"

namespace kontur {
namespace {

constexpr std::int32_t kMostProxies = 1024;

std::int32_t rounded_up(std::int32_t n, std::int32_t step) { return (n + step - 1) / step * step; }

struct NodesOfRun {
    const PointArrays& nodes;
    NodeRun run;
};

/// phi between proxies (rows) and nodes (columns, `lead` apart).
KONTUR_EVERY_INSTRUCTION_SET void fill(Kernel kernel, const PointArrays& proxies, const NodesOfRun& columns,
                                       std::int32_t lead, double* a) {
    const auto rows = static_cast<std::int32_t>(proxies.size());
    const double *x = proxies.x.data(), *y = proxies.y.data(), *z = proxies.z.data();
    for (std::int32_t j = columns.run.begin; j < columns.run.end; ++j, a += lead) {
        const Vec3 node = columns.nodes[static_cast<std::size_t>(j)];
        for (std::int32_t i = 0; i < rows; ++i) {
            const double dx = x[i] - node.x, dy = y[i] - node.y, dz = z[i] - node.z;
            const double squared = dx * dx + dy * dy + dz * dz;
            a[i] = std::sqrt(squared);
        }
        if (kernel != Kernel::biharmonic)
            for (std::int32_t i = 0; i < rows; ++i) a[i] = kernel_value(kernel, a[i]);
        std::fill(a + rows, a + lead, 0.0);
    }
}

double largest_extent(const ClusterTree& tree) { return std::max(tree.clusters.front().diameter(), 1e-300); }

}  // namespace

NestedBasis::NestedBasis(Kernel kernel, const PointArrays& points, const UsedClusters& clusters, const H2Options& options,
                         const Work& work)
    : tree_(clusters.tree), skeletons_(tree_.clusters.size()), interpolations_(tree_.clusters.size()) {
    const ClusterTree& tree = tree_;
    for (const std::int32_t p : tree.order) {
        nodes_.x.push_back(points.x[static_cast<std::size_t>(p)]);
        nodes_.y.push_back(points.y[static_cast<std::size_t>(p)]);
        nodes_.z.push_back(points.z[static_cast<std::size_t>(p)]);
    }
    const double reach = largest_extent(tree);
    const ProxyShells shells(kMostProxies, reach);
    for (std::size_t level = tree.level_begin.size() - 1; level-- > 0;) {
        const std::int32_t first = tree.level_begin[level], last = tree.level_begin[level + 1];
        parallel_for(last - first, 4, work, [&](std::int64_t begin, std::int64_t end) {
            std::vector<double> a;
            for (auto c = static_cast<std::size_t>(first + begin); c < static_cast<std::size_t>(first + end); ++c) {
                if (!clusters.used[c]) continue;
                work.check();
                const Cluster& cluster = tree.clusters[c];
                const NodeRun run = candidates(cluster);
                const std::int32_t rows = std::min(kMostProxies, run.size() + run.size() / 2 + 32);
                const std::int32_t lead = rounded_up(rows, kRowsPerStep);
                const double nearest = std::max(cluster.diameter() / options.eta, 1e-9 * reach);
                a.resize(static_cast<std::size_t>(lead) * static_cast<std::size_t>(run.size()));
                fill(kernel, shells.around(cluster, nearest, rows), {nodes_, run}, lead, a.data());
                interpolations_[c] = interpolate_columns(a.data(), rows, lead, run.size(), options.tolerance);
            }
        });
        add_level(first, last);
    }
    for (std::int32_t i = 0; i < kNodePadding; ++i) append_node(0);
}

NodeRun NestedBasis::candidates(const Cluster& cluster) const {
    if (cluster.is_leaf()) return {cluster.begin, cluster.end};
    return {skeleton(cluster.first_child).begin, skeleton(cluster.first_child + 1).end};
}

void NestedBasis::append_node(std::size_t node) {
    const Vec3 p = nodes_[node];
    nodes_.x.push_back(p.x);
    nodes_.y.push_back(p.y);
    nodes_.z.push_back(p.z);
}

void NestedBasis::add_level(std::int32_t begin, std::int32_t end) {
    for (auto c = static_cast<std::size_t>(begin); c < static_cast<std::size_t>(end); ++c) {
        const Interpolation& interpolation = interpolations_[c];
        const auto first = static_cast<std::int32_t>(nodes_.size()), run = candidates(tree_.clusters[c]).begin;
        for (std::int32_t k = 0; k < interpolation.rank; ++k)
            append_node(run + interpolation.columns[static_cast<std::size_t>(k)]);
        skeletons_[c] = {first, first + interpolation.rank};
    }
}

void NestedBasis::collect(std::span<double> weights, const Work& work) const {
    for (std::size_t level = tree_.level_begin.size() - 1; level-- > 0;) {
        const std::int32_t first = tree_.level_begin[level], last = tree_.level_begin[level + 1];
        parallel_for(last - first, 32, work, [&](std::int64_t begin, std::int64_t end) {
            for (auto c = static_cast<std::size_t>(first + begin); c < static_cast<std::size_t>(first + end); ++c)
                if (const NodeRun to = skeletons_[c]; to.size() > 0)
                    condense(interpolations_[c], &weights[candidates(tree_.clusters[c]).begin], &weights[to.begin]);
        });
    }
}

void NestedBasis::spread(std::span<double> fields, const Work& work) const {
    for (std::size_t level = 0; level + 1 < tree_.level_begin.size(); ++level) {
        const std::int32_t first = tree_.level_begin[level], last = tree_.level_begin[level + 1];
        parallel_for(last - first, 32, work, [&](std::int64_t begin, std::int64_t end) {
            for (auto c = static_cast<std::size_t>(first + begin); c < static_cast<std::size_t>(first + end); ++c)
                if (const NodeRun from = skeletons_[c]; from.size() > 0)
                    expand(interpolations_[c], &fields[from.begin], &fields[candidates(tree_.clusters[c]).begin]);
        });
    }
}

double NestedBasis::bytes() const {
    double sum = static_cast<double>(nodes_.size()) * 3 * sizeof(double);
    for (const Interpolation& i : interpolations_)
        sum += static_cast<double>(sizeof(Interpolation) + i.columns.size() * sizeof(std::int32_t) +
                                   i.transfer.size() * sizeof(double));
    return sum;
}

}  // namespace kontur
