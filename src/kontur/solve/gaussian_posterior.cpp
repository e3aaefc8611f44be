// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/gaussian_posterior.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kontur/base/checks.h"
#include "kontur/base/error.h"
#include "kontur/solve/small_cholesky.h"

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

/// Cholesky's factor of I + S K S in the lower triangle, columns `padded_rows(n)` apart. Not BLAS's, whose bytes differ from
/// machine to machine.
std::vector<double> factor(std::span<const double> prior, const std::vector<double>& s) {
    const std::size_t n = s.size();
    const auto rows = static_cast<int>(n);
    const auto lead = static_cast<std::size_t>(padded_rows(rows));
    std::vector<double> matrix(lead * n);
    for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = j; i < n; ++i) matrix[i + lead * j] = s[i] * prior[i + n * j] * s[j] + (i == j ? 1.0 : 0.0);
    if (!small_cholesky(matrix.data(), rows))
        throw Error(ErrorKind::singular_system, "the prior covariance is not positive definite");
    return matrix;
}

/// K x, from the lower triangle of K.
std::vector<double> product(std::span<const double> symmetric, std::span<const double> x) {
    const std::size_t n = x.size();
    std::vector<double> y(n);
    for (std::size_t j = 0; j < n; ++j) {
        const double* column = &symmetric[n * j];
        double sum = column[j] * x[j];
        for (std::size_t i = j + 1; i < n; ++i) {
            sum += column[i] * x[i];
            y[i] += column[i] * x[j];
        }
        y[j] += sum;
    }
    return y;
}

using Sides = std::array<double, kForwardSides>;

/// Squared lengths of the columns of L^-1 X, which overwrites X; its rows before `first` are zero.
Sides squared_lengths(const std::vector<double>& lower, std::size_t n, std::size_t first, std::vector<double>& x) {
    small_cholesky_forward(lower.data(), static_cast<int>(n), static_cast<int>(first), x.data());
    Sides sums{};
    for (std::size_t i = first; i < n; ++i)
        for (std::size_t c = 0; c < sums.size(); ++c) sums[c] += x[i * sums.size() + c] * x[i * sums.size() + c];
    return sums;
}

/// Those of numbers that were seen clearly: (1 - (I + S K S)^-1_ii) / s_i^2, the inverse's diagonal from that of the factor.
/// Where s_i^2 K_ii is small, that loses digits.
void add_clear_variances(const std::vector<double>& s, const std::vector<double>& lower, std::vector<double>& variance) {
    const std::size_t n = s.size();
    for (std::size_t first = 0; first < n; first += kForwardSides) {
        const std::size_t count = std::min<std::size_t>(kForwardSides, n - first);
        std::vector<double> x(n * kForwardSides);
        for (std::size_t c = 0; c < count; ++c) x[(first + c) * kForwardSides + c] = 1;
        const Sides inverse = squared_lengths(lower, n, first, x);
        for (std::size_t c = 0; c < count; ++c)
            if (const double root = s[first + c]; root > 0) variance[first + c] = (1 - inverse[c]) / (root * root);
    }
}

/// diag(K - V^T V), V = L^-1 S K, of some columns.
void add_variances_of(const std::vector<std::size_t>& columns, std::span<const double> prior, const std::vector<double>& s,
                      const std::vector<double>& lower, std::vector<double>& variance) {
    const std::size_t n = s.size();
    for (std::size_t column = 0; column < columns.size(); column += kForwardSides) {
        const std::size_t count = std::min<std::size_t>(kForwardSides, columns.size() - column);
        std::vector<double> v(n * kForwardSides);
        for (std::size_t c = 0; c < count; ++c)
            for (std::size_t i = 0; i < n; ++i) v[i * kForwardSides + c] = s[i] * prior[i + n * columns[column + c]];
        const Sides squares = squared_lengths(lower, n, 0, v);
        for (std::size_t c = 0; c < count; ++c) {
            const std::size_t j = columns[column + c];
            variance[j] = prior[j + n * j] - squares[c];
        }
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
    const std::vector<double> lower = factor(prior, s);

    // weights = v - S (I + S K S)^-1 S K v, v the information.
    GaussianPosterior posterior{{}, {}, {information.begin(), information.end()}};
    std::vector<double> solution = product(prior, information);
    for (std::size_t i = 0; i < n; ++i) solution[i] *= s[i];
    small_cholesky_solve(lower.data(), static_cast<int>(n), solution.data());
    for (std::size_t i = 0; i < n; ++i) posterior.weights[i] -= s[i] * solution[i];
    posterior.mean = product(prior, posterior.weights);

    posterior.variance = variances(prior, s, lower);
    return posterior;
}

}  // namespace kontur
