// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/base/work.h"
#include "kontur/function/kernel.h"
#include "kontur/function/point_arrays.h"
#include "kontur/function/screened_kernel.h"

namespace kontur {

/// How the matrix of all phi(|c_i - c_j|) is multiplied with.
enum class Products {
    automatic,     ///< whatever is cheaper
    direct,        ///< pair by pair: n^2 / 2 kernel values
    hierarchical,  ///< clusters of far centres at once: about n, approximate
};

/// phi(r); the screened kernel's only up to kScreenedReach.
inline double kernel_value(Kernel kernel, double r) {
    if (kernel == Kernel::biharmonic) return r;
    if (kernel == Kernel::triharmonic) return r * r * r;
    double even, odd, value;
    screened_halves(kScreenedValue, r * r, even, odd);
    screened_value(r * r, r, even, odd, value);
    return value;
}

/// Sign s that makes s * phi conditionally positive definite on weights with vanishing zeroth and first moments
/// (Wendland 2005, ch. 8): +1 for r^3, -1 for r. The screened kernel is positive definite with its even powers.
inline double kernel_sign(Kernel kernel) { return kernel == Kernel::biharmonic ? -1.0 : 1.0; }

/// What sums of the screened kernel k have beside those of its phi: polynomials of the target, whose coefficients are
/// moments of the weights.
struct EvenPowers {
    double constant = 0;
    Vec3 linear;
    double squared = 0;

    double value(const Vec3& at) const { return constant + dot(linear, at) + squared * dot(at, at); }
    Vec3 gradient(const Vec3& at) const { return linear + 2 * squared * at; }
};
EvenPowers even_powers(const PointArrays& centers, std::span<const double> weights);

/// Sums over centres of their weights times the kernel.
struct KernelSum {
    Kernel kernel;
    const PointArrays& centers;
    std::span<const double> weights;  ///< one for each centre
};

/// out[t] = sum_j weights[j] phi(|targets[t] - centers[j]|). The sum runs over j in order for every target, so
/// on one type of processor a value depends neither on the batch it is computed in nor on `threads`.
/// With the screened kernel no target may be farther than kScreenedReach from a centre.
void sum_kernel(const KernelSum& sum, const PointArrays& targets, std::span<double> out, const Work& work);

/// The same sums of the screened kernel k itself, at any distance; slower.
void sum_far_kernel(const PointArrays& centers, std::span<const double> weights, const PointArrays& targets,
                    std::span<double> out, const Work& work);

/// Two weights for each centre, and two sums for each target.
using WeightPair = std::pair<std::span<const double>, std::span<const double>>;
using SumPair = std::pair<std::span<double>, std::span<double>>;
/// The sums of `sum_far_kernel` by either weights, to the last bit, for little more than one of them.
void sum_far_kernel_twice(const PointArrays& centers, const WeightPair& weights, const PointArrays& targets,
                          const SumPair& out, const Work& work);

/// out[t] = gradient at targets[t] of sum_kernel's sum. At a centre the term of that centre is 0 (for phi = r by
/// convention).
void sum_kernel_gradient(const KernelSum& sum, const PointArrays& targets, std::span<Vec3> out, const Work& work);

/// Both at once, cheaper than one after the other; the screened kernel's values are the same to rounding.
void sum_kernel_and_gradient(const KernelSum& sum, const PointArrays& targets, std::span<double> values,
                             std::span<Vec3> gradients, const Work& work);

}  // namespace kontur
