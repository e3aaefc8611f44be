// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "kontur/function/kernel.h"

namespace kontur {

/// Consecutive nodes: points of a cluster or its skeleton.
struct NodeRun {
    std::int32_t begin = 0, end = 0;

    std::int32_t size() const { return end - begin; }
};

/// Coordinates and weights of nodes. Behind the last node, kNodePadding more entries must be readable.
struct NodeView {
    const double *x, *y, *z, *weight;
};
constexpr std::int32_t kNodePadding = 32;

/// Adds to out[i] the sum of w_j phi(|x_i - x_j|) over the right nodes j for every left node i, and to out[j] the sum over
/// the left nodes: each phi is computed once and used twice. Left and right must not overlap.
void add_mutual_sums(Kernel kernel, const NodeView& nodes, NodeRun left, std::span<const NodeRun> right, double* out);

/// Adds to out[i] the sum over all nodes j of the same run.
void add_own_sums(Kernel kernel, const NodeView& nodes, NodeRun run, double* out);

}  // namespace kontur
