// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/solve/solve.h"

namespace kontur {

struct SolverSetup;

/// Smoothing that leaves nothing of a weight: the centre is left out.
inline constexpr double kLeftOut = 1e20;

/// The interpolation problem in unit coordinates, as the solvers see it.
struct LinearSystem {
    Kernel kernel;
    std::vector<double> smoothing;                  ///< of every constraint
    PointArrays centers;                            ///< unit coordinates
    std::vector<double> values;                     ///< mm, above the mean
    std::vector<double> start = {};                 ///< weights that may be close to the solution; empty: none are known
    std::shared_ptr<const SolverSetup> setup = {};  ///< of the first of these centres, if there is one already
    std::shared_ptr<const PreconditionerPattern> pattern = {};  ///< of these centres, if there is one already

    std::size_t size() const { return values.size(); }
    bool is_left_out(std::size_t i) const { return smoothing[i] == kLeftOut; }
    double entry(std::size_t i, std::size_t j) const {
        const double r = distance(centers[i], centers[j]);
        const double value = kernel == Kernel::screened ? screened_kernel(r) : kernel_value(kernel, r);
        return i == j ? value + diagonal(i) : value;
    }
    /// Smoothing enters with the kernel's sign: it must add to the definite direction.
    double diagonal(std::size_t i) const { return kernel_sign(kernel) * smoothing[i]; }
};

/// Adds to `image`, which holds the weights' sums of phi at the centres, what makes them sums of the definite kernel: the
/// even powers of the screened kernel, nothing for the others.
void add_even_powers(Kernel kernel, const PointArrays& centers, std::span<const double> weights, std::span<double> image);

struct Coefficients {
    std::vector<double> weights;
    std::array<double, 4> polynomial{};
    int iterations = 0;
    double residual = 0;              ///< largest |f(c_i) + smoothing_i w_i - h_i|, in mm
    std::size_t residual_points = 0;  ///< see SolveReport
    double matrix_mb = 0;
    double evaluations = 0;  ///< see SolveReport
    std::vector<std::pair<std::string, double>> seconds = {};
    std::shared_ptr<const PreconditionerPattern> pattern = {};
    std::shared_ptr<const SolverSetup> setup = {};  ///< for the next system
};

/// Eq. 6 as printed, by dsysv (Bunch-Kaufman).
Coefficients solve_dense(const LinearSystem& system);

/// By Cholesky. The screened kernel's matrix is definite as it is. The others' is reduced: four well-spread centres carry
/// the polynomial: with their Lagrange basis l_m, the weights that satisfy the side conditions are w = B v, and B^T Phi B is
/// definite because phi is conditionally so. Blocked by tiles in a fixed order, so the result does not depend on the thread
/// count.
Coefficients solve_cholesky(const LinearSystem& system, const Work& work);

/// Conjugate gradients on the weights that satisfy the side conditions.
Coefficients solve_iterative(const LinearSystem& system, const SolveOptions& options, const Work& work);

/// Four centres, far apart and not in one plane, chosen greedily: the farthest from the mean, the farthest from it, then the
/// largest triangle, then the largest tetrahedron. Throws Error(singular_system) when all centres lie in one plane.
std::array<std::size_t, 4> spread_centers(const PointArrays& centers);

/// The largest error of the coefficients over all constraints, in mm, by summation.
double largest_residual(const LinearSystem& system, const Coefficients& coefficients, const Work& work);

/// Values at the four spread centres -> the linear polynomial through them.
std::array<double, 4> linear_through(const PointArrays& centers, const std::array<std::size_t, 4>& spread,
                                     const std::array<double, 4>& values);

}  // namespace kontur
