// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/work.h"
#include "kontur/solve/h2_basis.h"
#include "kontur/solve/h2_partition.h"
#include "kontur/solve/kernel_matrix.h"

namespace kontur {

/// The matrix phi(|x_i - x_j|) in linear memory as an H2 matrix (Hackbusch & Boerm 2002): clusters of points that are far
/// from each other act through their skeletons, all others directly. On contours, which are curves, skeletons are small.
/// `out` has an error of about the tolerance times the norm of the weights.
class H2KernelMatrix final : public KernelMatrix {
public:
    H2KernelMatrix(Kernel kernel, const PointArrays& points, const H2Options& options, const Work& work = {});

    std::size_t size() const override { return tree_.order.size(); }
    /// One call at a time. Throws Error(cancelled) if the progress given to the constructor is asked to stop.
    void multiply(std::span<const double> weights, std::span<double> out) const override;
    double megabytes() const override;
    bool is_exact() const override { return false; }
    double evaluations() const override { return evaluations_; }

private:
    /// Blocks with the same left side.
    struct Row {
        NodeRun left;
        std::size_t first_right, last_right;  ///< in rights_
        bool own;                             ///< and the block left x left

        std::span<const NodeRun> rights(const std::vector<NodeRun>& all) const {
            return std::span(all).subspan(first_right, last_right - first_right);
        }
    };
    /// Rows that add to the same sums one after another, so that no sum depends on who computes it when.
    struct Group {
        std::size_t first_row, last_row;
        std::vector<NodeRun> touched;  ///< nodes that they add to, ascending
    };

    void add_rows(const std::vector<ClusterPair>& pairs, bool far);
    void group_rows();
    double cost(const Row& row) const;

    Kernel kernel_;
    Work work_;
    ClusterTree tree_;
    PairPartition partition_;
    NestedBasis basis_;
    std::vector<Row> rows_;
    std::vector<NodeRun> rights_;
    std::vector<Group> groups_;
    double evaluations_ = 0;
    mutable std::vector<std::vector<double>> sums_;  ///< of every group, kept between products
};

}  // namespace kontur
