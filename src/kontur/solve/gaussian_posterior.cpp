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
constexpr double kClear = 1e-3;  // prior variance over that of seeing, from which on a number counts as seen clearly

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

/// Those of numbers that were seen clearly: (1 - (I + S K S)^-1_ii) / s_i^2, the inverse's diagonal from that of the factor.
/// Where s_i^2 K_ii is small, that loses digits.
void add_clear_variances(const std::vector<double>& s, std::vector<double> lower, std::vector<double>& variance) {
    const std::size_t n = s.size();
    const auto lead = static_cast<lapack_int>(n);
    LAPACKE_dtrtri(LAPACK_COL_MAJOR, 'L', 'N', lead, lower.data(), lead);
    for (std::size_t j = 0; j < n; ++j) {
        const auto rows = static_cast<int>(n - j);
        const double inverse = cblas_ddot(rows, &lower[j + n * j], 1, &lower[j + n * j], 1);
        if (s[j] > 0) variance[j] = (1 - inverse) / (s[j] * s[j]);
    }
}

/// diag(K - V^T V), V = L^-1 S K, of some columns.
void add_variances_of(const std::vector<std::size_t>& columns, std::span<const double> prior, const std::vector<double>& s,
                      const std::vector<double>& lower, std::vector<double>& variance) {
    const std::size_t n = s.size();
    const auto lead = static_cast<int>(n);
    std::vector<double> v(n * columns.size());
    for (std::size_t c = 0; c < columns.size(); ++c)
        for (std::size_t i = 0; i < n; ++i) v[i + n * c] = s[i] * prior[i + n * columns[c]];
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, lead, static_cast<int>(columns.size()),
                1.0, lower.data(), lead, v.data(), lead);
    for (std::size_t c = 0; c < columns.size(); ++c) {
        const std::size_t j = columns[c];
        variance[j] = prior[j + n * j] - cblas_ddot(lead, &v[n * c], 1, &v[n * c], 1);
    }
}

std::vector<double> variances(std::span<const double> prior, const std::vector<double>& s,
                              const std::vector<double>& lower) {
    const std::size_t n = s.size();
    std::vector<double> variance(n);
    std::vector<std::size_t> unclear;
    for (std::size_t j = 0; j < n; ++j)
        if (s[j] * s[j] * prior[j + n * j] < kClear) unclear.push_back(j);
    if (unclear.size() < n) add_clear_variances(s, lower, variance);
    if (!unclear.empty()) add_variances_of(unclear, prior, s, lower, variance);
    for (double& v : variance) v = std::max(v, kLeastVariance);
    return variance;
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

    posterior.variance = variances(prior, s, lower);
    return posterior;
}

}  // namespace kontur
