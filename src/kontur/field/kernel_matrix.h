// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "kontur/field/kernel.h"

namespace kontur {

/// The matrix phi(|x_i - x_j|) of fixed points, known by its products only. Products are the same bytes for any number of
/// threads.
class KernelMatrix {
public:
    virtual ~KernelMatrix() = default;

    virtual std::size_t size() const = 0;
    /// out[i] = sum_j weights[j] phi(|x_i - x_j|).
    virtual void multiply(std::span<const double> weights, std::span<double> out) const = 0;
    virtual double megabytes() const = 0;
};

/// Sums all pairs, each once: n^2 / 2 kernel values per product. Exact to rounding.
class DirectKernelMatrix final : public KernelMatrix {
public:
    DirectKernelMatrix(Kernel kernel, PointArrays points, int threads = 0);

    std::size_t size() const override { return points_.size(); }
    void multiply(std::span<const double> weights, std::span<double> out) const override;
    double megabytes() const override;

private:
    Kernel kernel_;
    PointArrays points_;
    int threads_;
};

/// The cheapest matrix for the number of points.
std::unique_ptr<KernelMatrix> make_kernel_matrix(Kernel kernel, const PointArrays& points, int threads = 0);

}  // namespace kontur
