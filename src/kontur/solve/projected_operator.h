// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/solve/kernel_matrix.h"
#include "kontur/solve/linear_system.h"

namespace kontur {

using Vector = std::vector<double>;

double inner(const Vector& a, const Vector& b);
void add_scaled(Vector& a, double s, const Vector& b);
/// Largest absolute value.
double largest(const Vector& a);

/// What weights have to satisfy: those of centres left out are 0; and but for the screened kernel, which is definite
/// without, all linear polynomials' values at the centres are orthogonal to them.
class SideConditions {
public:
    /// Keeps a reference to the system. Throws Error(singular_system) when all centres lie in one plane and the kernel needs
    /// the polynomials.
    explicit SideConditions(const LinearSystem& system);

    /// Removes the best linear fit, and what stands at centres left out.
    void project(Vector& v) const;

private:
    const LinearSystem& system_;
    std::vector<Vector> basis_;  ///< orthonormal, of the polynomials' values
};

/// sign (Phi + diagonal) w, and what is known of its error.
struct CheckedImage {
    Vector values;
    double deviation = 0;     ///< largest difference between the operator's values and sums over all pairs
    double uncertainty = 0;   ///< largest error that `values` may have
    std::size_t checked = 0;  ///< points at which sums over all pairs were made
};

/// sign (Phi + diagonal) on the weights that satisfy the side conditions; definite there.
class ProjectedOperator {
public:
    /// `tolerance` as in H2Options, unless the system has a setup. Keeps references to its arguments.
    ProjectedOperator(const LinearSystem& system, const SideConditions& conditions, double tolerance,
                      const SolveOptions& options, const Work& work);

    Vector operator()(const Vector& w) const;
    /// Not projected. What the H2 matrix makes is compared with sums over all pairs, beyond 4,000 centres at 4,000 of them,
    /// evenly chosen, from which the others' error is estimated.
    CheckedImage checked_image(const Vector& w) const;

    /// Multiplies the tolerance.
    void tighten(double factor);
    double tolerance() const { return tolerance_; }
    const std::shared_ptr<const KernelMatrix>& matrix() const { return matrix_; }

private:
    Vector image(const KernelMatrix& matrix, const Vector& w) const;
    double sampled_deviation(const Vector& w, const Vector& image, std::size_t samples) const;

    const LinearSystem& system_;
    const SideConditions& conditions_;
    double tolerance_;
    const SolveOptions& options_;
    const Work& work_;
    std::shared_ptr<const KernelMatrix> matrix_;
};

}  // namespace kontur
