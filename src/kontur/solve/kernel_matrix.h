// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/function/kernel.h"
#include "kontur/function/kernel_sums.h"
#include "kontur/function/point_arrays.h"

namespace kontur {

/// Products are summed in at most so many groups of rows, so that they do not depend on the number of threads.
inline constexpr std::size_t kMostGroups = 16;

/// The matrix phi(|x_i - x_j|) of fixed points, known by its products only. Products are the same bytes for any number of
/// threads.
class KernelMatrix {
public:
    virtual ~KernelMatrix() = default;

    virtual std::size_t size() const = 0;
    /// out[i] = sum_j weights[j] phi(|x_i - x_j|).
    virtual void multiply(std::span<const double> weights, std::span<double> out) const = 0;
    virtual double megabytes() const = 0;
    /// Values of phi computed per product.
    virtual double evaluations() const = 0;
    /// Whether products are exact to rounding.
    virtual bool is_exact() const = 0;
};

/// Sums all pairs, each once: n^2 / 2 kernel values per product, or n for each weight where most weights are 0. Exact to
/// rounding.
class DirectKernelMatrix final : public KernelMatrix {
public:
    /// Products throw Error(cancelled) if `progress` is asked to stop.
    DirectKernelMatrix(Kernel kernel, const PointArrays& points, const Work& work = {});

    std::size_t size() const override { return size_; }
    void multiply(std::span<const double> weights, std::span<double> out) const override;
    double megabytes() const override;
    double evaluations() const override { return 0.5 * static_cast<double>(size_) * static_cast<double>(size_); }
    bool is_exact() const override { return true; }

private:
    void multiply_all(std::span<const double> weights, std::span<double> out) const;
    void multiply_few(std::span<const double> weights, std::span<double> out) const;

    Kernel kernel_;
    std::size_t size_;
    PointArrays points_;  ///< with kNodePadding more
    Work work_;
};

/// A matrix with the rows and columns of further points beside it: these are stored and multiplied one by one.
class BorderedKernelMatrix final : public KernelMatrix {
public:
    /// The first of the points are those of `inner`.
    BorderedKernelMatrix(Kernel kernel, std::shared_ptr<const KernelMatrix> inner, const PointArrays& points,
                         const Work& work = {});

    std::size_t size() const override { return size_; }
    void multiply(std::span<const double> weights, std::span<double> out) const override;
    double megabytes() const override;
    double evaluations() const override { return inner_->evaluations(); }
    bool is_exact() const override { return inner_->is_exact(); }

private:
    std::shared_ptr<const KernelMatrix> inner_;
    std::size_t size_;
    std::vector<double> rows_;  ///< of the further points, as long as all points are many
    Work work_;
};

/// The matrix whose dozen products, with what they need first, are cheapest for that many points, unless `products` says
/// which: direct, or an H2KernelMatrix of the given tolerance, see H2Options.
std::unique_ptr<KernelMatrix> make_kernel_matrix(Kernel kernel, const PointArrays& points, Products products,
                                                 double tolerance, const Work& work = {});

}  // namespace kontur
