// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/offsets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/solve/gaussian_posterior.h"

namespace kontur {
namespace {

constexpr int kSweeps = 3;         // one loses .005 of Dice on hard drawings, two .003 on some; six and damped bring no more
constexpr double kJitter = 1e-6;   // of the mean prior variance
constexpr double kSharpest = 0.3;  // of a step: the smallest standard deviation that is believed of one point
constexpr double kLeastCavity = 1e-9;
constexpr double kFar = 8;  // lengths: points farther apart are hardly correlated, by 1e-5

std::vector<double> correlations(std::span<const MovingPoint> points, const OffsetPrior& prior) {
    const std::size_t n = points.size();
    std::vector<double> c(n * n);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j <= i; ++j) c[i + n * j] = c[j + n * i] = prior.correlation(points[i], points[j]);
    return c;
}

std::vector<double> covariances(std::span<const MovingPoint> points, const std::vector<double>& correlations) {
    const std::size_t n = points.size();
    std::vector<double> k = correlations;
    double trace = 0;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) k[i + n * j] *= points[i].prior_mm * points[j].prior_mm;
        trace += k[i + n * i];
    }
    for (std::size_t i = 0; i < n; ++i) k[i + n * i] += kJitter * trace / static_cast<double>(n);
    return k;
}

/// The largest precision that each point's evidence may have.
std::vector<double> caps(const std::vector<double>& correlations, std::size_t n, const OffsetEvidence& evidence) {
    const double sharpest = kSharpest * evidence.step_mm;
    std::vector<double> most(n, 1 / (sharpest * sharpest));
    if (evidence.image_sd_mm.empty()) return most;
    for (std::size_t i = 0; i < n; ++i) {
        double correlated = 0;
        for (std::size_t j = 0; j < n; ++j) correlated += correlations[j + n * i];
        most[i] = std::min(most[i], 1 / (std::pow(evidence.image_sd_mm[i], 2) * correlated));
    }
    return most;
}

struct Site {
    double precision = 0, information = 0;
};

/// The Gaussian that, beside all that other points say, leaves mean and variance as the evidence does.
Site match(const OffsetEvidence& evidence, std::size_t point, double cavity_precision, double cavity_mean, double cap) {
    const std::vector<double>& log_likelihood = evidence.log_likelihood[point];
    const auto offset = [&](std::size_t u) { return (static_cast<double>(u) - evidence.most) * evidence.step_mm; };
    std::vector<double> energy(log_likelihood.size());
    for (std::size_t u = 0; u < energy.size(); ++u)
        energy[u] = log_likelihood[u] - 0.5 * cavity_precision * std::pow(offset(u) - cavity_mean, 2);
    const double top = *std::max_element(energy.begin(), energy.end());
    double sum = 0, first = 0, second = 0;
    for (std::size_t u = 0; u < energy.size(); ++u) {
        const double q = std::exp(energy[u] - top);
        sum += q;
        first += q * offset(u);
        second += q * offset(u) * offset(u);
    }
    const double mean = first / sum, step = evidence.step_mm;
    const double variance = second / sum - mean * mean + step * step / 12;
    const double sharpest = 1 / std::pow(kSharpest * step, 2);
    const double precision = std::clamp(1 / variance - cavity_precision, 0.0, sharpest);
    if (precision <= 0) return {};
    const double information = mean * (precision + cavity_precision) - cavity_mean * cavity_precision;
    const double limited = std::min(precision, cap);
    return {limited, information * limited / precision};
}

}  // namespace

double OffsetPrior::correlation(const MovingPoint& a, const MovingPoint& b) const {
    const double r = std::sqrt(3.0) * distance(a.position, b.position) / length_mm;
    return (1 + r) * std::exp(-r) * std::clamp(0.5 + 0.5 * dot(a.normal, b.normal), 0.0, 1.0);
}

Offsets find_offsets(std::span<const MovingPoint> points, const OffsetPrior& prior, const OffsetEvidence& evidence,
                     const Work& work) {
    const std::size_t n = points.size();
    const std::vector<double> together = correlations(points, prior);
    const std::vector<double> k = covariances(points, together);
    const std::vector<double> most = caps(together, n, evidence);
    std::vector<double> precision(n), information(n);
    GaussianPosterior posterior{std::vector<double>(n), std::vector<double>(n), {}};  // nothing seen yet: the prior
    for (std::size_t i = 0; i < n; ++i) posterior.variance[i] = k[i + n * i];
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        work.check();
        for (std::size_t i = 0; i < n; ++i) {
            const double inverse = 1 / posterior.variance[i];
            const double cavity = std::max(inverse - precision[i], kLeastCavity);
            const double cavity_mean = (posterior.mean[i] * inverse - information[i]) / cavity;
            const Site site = match(evidence, i, cavity, cavity_mean, most[i]);
            precision[i] = site.precision;
            information[i] = site.information;
        }
        posterior = gaussian_posterior(k, precision, information);
    }
    Offsets offsets{std::move(posterior.mean), std::move(posterior.variance), std::move(posterior.weights)};
    for (double& variance : offsets.sd_mm) variance = std::sqrt(variance);
    return offsets;
}

double offset_at(const MovingPoint& point, std::span<const MovingPoint> points, const OffsetPrior& prior,
                 const Offsets& offsets) {
    const double far2 = std::pow(kFar * prior.length_mm, 2);
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 apart = points[i].position - point.position;
        if (dot(apart, apart) < far2) sum += prior.covariance(point, points[i]) * offsets.weights[i];
    }
    return sum;
}

}  // namespace kontur
