// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/function/cell_groups.h"
#include "kontur/function/implicit_function.h"
#include "kontur/function/stencil.h"

namespace kontur {

/// Values of a function at many points. All coordinates are those of the function's unit frame.
class PointEvaluator {
public:
    virtual ~PointEvaluator() = default;
    virtual void values(const PointArrays& points, std::span<double> out, const Work& work) = 0;
    /// Kernel values computed so far, in all levels.
    virtual std::int64_t kernel_values() const = 0;
};

/// Sums over all centres.
class DirectSum final : public PointEvaluator {
public:
    explicit DirectSum(const ImplicitFunction& function) : function_(function) {}
    void values(const PointArrays& points, std::span<double> out, const Work& work) override;
    std::int64_t kernel_values() const override { return kernel_values_; }

private:
    ImplicitFunction function_;
    std::int64_t kernel_values_ = 0;
};

/// Sums the near part of the kernel (split_kernel.h) over the centres within a radius, and interpolates the smooth rest
/// between the nodes of a lattice. A node's value is f, from `nodes`, less the near part; it is computed when a point first
/// needs it and kept. A value depends on its point only, not on what else was asked.
class FarField final : public PointEvaluator {
public:
    /// The radius in lattice spacings. Interpolation of what the split leaves errs by about 1e-3 of f's unevenness at 5, by
    /// a third of it with each more.
    static constexpr double kRadius = 5;
    FarField(const ImplicitFunction& function, double spacing, std::unique_ptr<PointEvaluator> nodes);

    /// Coordinates of points must be smaller.
    double reach() const { return spacing_ * (1 << 18); }

    void values(const PointArrays& points, std::span<double> out, const Work& work) override;
    void gradients(const PointArrays& points, std::span<Vec3> out, const Work& work);
    std::int64_t kernel_values() const override { return kernel_values_ + nodes_->kernel_values(); }

private:
    using NodeBlock = std::array<double, 512>;  ///< 8 x 8 x 8 nodes; NaN where not computed yet

    /// Computes all nodes that interpolation in the cells needs.
    void prepare(const std::vector<Index3>& cells, const Work& work);
    std::vector<Index3> missing_nodes(const std::vector<Index3>& cells);
    std::vector<double> smooth_values(const std::vector<Index3>& nodes, const Work& work);
    NodeBlock& block(const Index3& number);
    StencilValues stencil(const Index3& cell) const;
    Vec3 within(const Index3& cell, const Vec3& point) const;

    /// Calls add(cell, members, centres near the cell) for each group, in parallel. Members are indices of points.
    template <typename Add>
    void for_each_group(const CellGroups& groups, double edge, const Work& work, const Add& add);

    NearKernel near_kernel_;
    double spacing_;
    SourceCells sources_;
    std::unique_ptr<PointEvaluator> nodes_;
    std::unordered_map<std::uint64_t, std::unique_ptr<NodeBlock>> blocks_;
    std::unordered_set<std::uint64_t> prepared_;  ///< cells whose nodes are all known
    std::int64_t kernel_values_ = 0;
};

}  // namespace kontur
