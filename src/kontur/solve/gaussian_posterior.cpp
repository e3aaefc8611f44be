// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/gaussian_posterior.h"

#include <fmt/format.h>
#include <lapacke.h>

#include <algorithm>
#include <cmath>

#include "kontur/base/checks.h"
#include "kontur/base/error.h"
#include "kontur/solve/blas_threads.h"

namespace kontur {
namespace {

constexpr double kLeastVariance = 1e-12;

/// Square roots of the precisions.
std::vector<double> roots(std::span<const double> precision) {
    std::vector<double> s(precision.size());
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (!(precision[i] >= 0 && std::isfinite(precision[i])))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("precision {} is {:g}; it must be finite and at least 0", i + 1, precision[i]));
        s[i] = std::sqrt(precision[i]);
    }
    return s;
}

/// Cholesky's factor of I + S K S in the lower triangle.
std::vector<double> factor(std::span<const double> prior, const std::vector<double>& s) {
    const std::size_t n = s.size();
    std::vector<double> matrix(n * n);
    for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = j; i < n; ++i) matrix[i + n * j] = s[i] * prior[i + n * j] * s[j] + (i == j ? 1.0 : 0.0);
    const auto lead = static_cast<lapack_int>(n);
    if (LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', lead, matrix.data(), lead) != 0)
        throw Error(ErrorKind::singular_system, "the prior covariance is not positive definite");
    return matrix;
}

}  // namespace

GaussianPosterior gaussian_posterior(std::span<const double> prior, std::span<const double> precision,
                                     std::span<const double> information) {
    const std::size_t n = precision.size();
    check_same_count("covariances", prior.size(), "pairs", n * n);
    check_same_count("pieces of information", information.size(), "numbers", n);
    const std::vector<double> s = roots(precision);
    if (n == 0) return {};
    const SingleThreadedBlas guard;
    const auto lead = static_cast<int>(n);
    const std::vector<double> lower = factor(prior, s);

    // weights = v - S (I + S K S)^-1 S K v, v the information.
    GaussianPosterior posterior{std::vector<double>(n), std::vector<double>(n), {information.begin(), information.end()}};
    std::vector<double> seen(n);
    cblas_dsymv(CblasColMajor, CblasLower, lead, 1.0, prior.data(), lead, information.data(), 1, 0.0, seen.data(), 1);
    for (std::size_t i = 0; i < n; ++i) seen[i] *= s[i];
    cblas_dtrsv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit, lead, lower.data(), lead, seen.data(), 1);
    cblas_dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, lead, lower.data(), lead, seen.data(), 1);
    for (std::size_t i = 0; i < n; ++i) posterior.weights[i] -= s[i] * seen[i];
    cblas_dsymv(CblasColMajor, CblasLower, lead, 1.0, prior.data(), lead, posterior.weights.data(), 1, 0.0,
                posterior.mean.data(), 1);

    // variance = diag(K - V^T V), V = L^-1 S K.
    std::vector<double> v(n * n);
    for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i < n; ++i) v[i + n * j] = s[i] * prior[i + n * j];
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, lead, lead, 1.0, lower.data(), lead,
                v.data(), lead);
    for (std::size_t j = 0; j < n; ++j) {
        const double explained = cblas_ddot(lead, &v[n * j], 1, &v[n * j], 1);
        posterior.variance[j] = std::max(prior[j + n * j] - explained, kLeastVariance);
    }
    return posterior;
}

}  // namespace kontur
