// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace kontur {

/// What is known of n numbers u ~ N(0, K) after each was seen with Gaussian noise.
struct GaussianPosterior {
    std::vector<double> mean;      ///< K weights
    std::vector<double> variance;  ///< above 0
    std::vector<double> weights;   ///< of the covariances with u, by which other numbers of the same process follow
};

/// `prior` is K, n x n, symmetric and positive definite; seeing multiplies the density by
/// exp(information_i u_i - precision_i u_i^2 / 2). By Cholesky's factors of I + sqrt(P) K sqrt(P), which is well conditioned
/// whatever the precisions are (Rasmussen & Williams 2006, 3.67 to 3.68). 2/3 n^3 flops on one thread, and n^2 for each
/// number of which next to nothing was seen. BLAS takes no part. Throws Error(invalid_input) for a precision below 0 and
/// counts that do not fit, Error(singular_system) where K is not positive definite.
GaussianPosterior gaussian_posterior(std::span<const double> prior, std::span<const double> precision,
                                     std::span<const double> information);

}  // namespace kontur
