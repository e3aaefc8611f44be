// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/offsets.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "kontur/phantom/random.h"
#include "kontur/solve/gaussian_posterior.h"
#include "support/expect_error.h"

namespace kontur {
namespace {

/// Gauss and Jordan, without pivoting: the matrices here are positive definite.
std::vector<double> inverse(std::vector<double> a, std::size_t n) {
    std::vector<double> result(n * n);
    for (std::size_t i = 0; i < n; ++i) result[i * n + i] = 1;
    for (std::size_t p = 0; p < n; ++p) {
        const double pivot = a[p * n + p];
        for (std::size_t j = 0; j < n; ++j) a[p * n + j] /= pivot, result[p * n + j] /= pivot;
        for (std::size_t i = 0; i < n; ++i) {
            if (i == p) continue;
            const double factor = a[i * n + p];
            for (std::size_t j = 0; j < n; ++j)
                a[i * n + j] -= factor * a[p * n + j], result[i * n + j] -= factor * result[p * n + j];
        }
    }
    return result;
}

void compare_with_inverses(std::size_t n) {
    SCOPED_TRACE(n);
    Random random(5);
    std::vector<double> prior(n * n), precision(n), information(n);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j)
            prior[i * n + j] = 2 * std::exp(-0.3 * std::abs(static_cast<double>(i) - static_cast<double>(j)));
        precision[i] = std::array{0.0, 1e-7, 1e-3, random.uniform(0, 4), 1e4}[i % 5];  // unseen, hardly seen, ... pinned
        information[i] = precision[i] * random.gaussian();
    }
    const GaussianPosterior posterior = gaussian_posterior(prior, precision, information);
    std::vector<double> both = inverse(prior, n);
    for (std::size_t i = 0; i < n; ++i) both[i * n + i] += precision[i];
    const std::vector<double> covariance = inverse(both, n);
    for (std::size_t i = 0; i < n; ++i) {
        double mean = 0, by_weights = 0;
        for (std::size_t j = 0; j < n; ++j)
            mean += covariance[i * n + j] * information[j], by_weights += prior[i * n + j] * posterior.weights[j];
        EXPECT_NEAR(posterior.mean[i], mean, 1e-10);
        EXPECT_NEAR(posterior.variance[i] / covariance[i * n + i], 1, 1e-8);
        EXPECT_NEAR(by_weights, mean, 1e-10);
    }
}

TEST(GaussianPosterior, IsWhatInvertingTheMatricesGives) {
    for (const std::size_t n : {1, 7, 16, 17, 70}) compare_with_inverses(n);
}

TEST(GaussianPosterior, RefusesNegativePrecisionsAndWrongCounts) {
    const std::vector<double> one{1}, minus{-1}, two{1, 2};
    EXPECT_KONTUR_ERROR(gaussian_posterior(one, minus, one), ErrorKind::invalid_input, "precision 1 is -1");
    EXPECT_THROW(gaussian_posterior(two, one, one), Error);
}

OffsetEvidence evidence(int points, int most, double step_mm, double (*log_likelihood)(double)) {
    OffsetEvidence e{.step_mm = step_mm, .most = most, .log_likelihood = {}, .image_sd_mm = {}};
    for (int i = 0; i < points; ++i) {
        e.log_likelihood.emplace_back();
        for (int u = -most; u <= most; ++u) e.log_likelihood.back().push_back(log_likelihood(u * step_mm));
    }
    return e;
}

/// Two unlike peaks near each other.
double two_peaks(double u) {
    return std::log(0.7 * std::exp(-2 * (u - 1) * (u - 1)) + 0.3 * std::exp(-4 * (u + 0.5) * (u + 0.5)) + 0.001);
}
double flat(double) { return -3; }

TEST(Offsets, OfOnePointHaveTheMomentsOfItsPosterior) {
    const MovingPoint point{.position = {}, .normal = {1, 0, 0}, .distance_mm = 5, .prior_mm = 1.5};
    const OffsetEvidence e = evidence(1, 24, 0.25, two_peaks);
    const Offsets found = find_offsets(std::span(&point, 1), {}, e);
    double sum = 0, first = 0, second = 0;
    for (int n = -24000; n <= 24000; ++n) {
        const double u = 0.25e-3 * n, q = std::exp(two_peaks(u) - 0.5 * u * u / (1.5 * 1.5));
        sum += q;
        first += q * u;
        second += q * u * u;
    }
    EXPECT_NEAR(found.mean_mm[0], first / sum, 0.02);
    EXPECT_NEAR(found.sd_mm[0], std::sqrt(second / sum - std::pow(first / sum, 2)), 0.03);
}

TEST(Offsets, FlatEvidenceLeavesThePrior) {
    std::vector<MovingPoint> points;
    for (int i = 0; i < 5; ++i)
        points.push_back({.position = {3.0 * i, 0, 0}, .normal = {0, 0, 1}, .distance_mm = 4, .prior_mm = 1 + 0.2 * i});
    const Offsets found = find_offsets(points, {.length_mm = 6}, evidence(5, 12, 0.5, flat));
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(found.mean_mm[i], 0, 1e-9);
        EXPECT_NEAR(found.sd_mm[i], points[i].prior_mm, 1e-3);
    }
}

TEST(Offsets, PointsThatSayNothingFollowTheirNeighbours) {
    std::vector<MovingPoint> points;
    for (int i = 0; i < 3; ++i)
        points.push_back({.position = {2.0 * i, 0, 0}, .normal = {0, 0, 1}, .distance_mm = 4, .prior_mm = 2});
    OffsetEvidence e = evidence(3, 16, 0.25, [](double u) { return -8 * (u - 1.5) * (u - 1.5); });
    e.log_likelihood[1].assign(e.log_likelihood[1].size(), 0);
    const OffsetPrior prior{.length_mm = 10};
    const Offsets found = find_offsets(points, prior, e);
    EXPECT_NEAR(found.mean_mm[1], 1.5, 0.15);
    EXPECT_NEAR(offset_at(points[1], points, prior, found), found.mean_mm[1], 1e-4);
    // The other side of a thin sheet is not moved along.
    const MovingPoint behind{.position = {2, 0, -0.5}, .normal = {0, 0, -1}, .distance_mm = 4, .prior_mm = 2};
    EXPECT_NEAR(offset_at(behind, points, prior, found), 0, 1e-9);
}

TEST(Offsets, ImageThatIsKnownToBeWrongCountsLess) {
    const MovingPoint point{.position = {}, .normal = {1, 0, 0}, .distance_mm = 5, .prior_mm = 1};
    OffsetEvidence e = evidence(1, 24, 0.25, [](double u) { return -8 * (u - 2) * (u - 2); });
    e.image_sd_mm = {1};  // as wrong as the contours alone: halfway
    EXPECT_NEAR(find_offsets(std::span(&point, 1), {}, e).mean_mm[0], 1, 0.05);
}

TEST(Offsets, NeighboursThatErrTogetherCountAsOne) {
    for (const int count : {1, 4, 25}) {
        const std::vector<MovingPoint> points(static_cast<std::size_t>(count),
                                              {.position = {}, .normal = {1, 0, 0}, .distance_mm = 5, .prior_mm = 1});
        OffsetEvidence e = evidence(count, 24, 0.25, [](double u) { return -8 * (u - 2) * (u - 2); });
        e.image_sd_mm.assign(points.size(), 1);
        EXPECT_NEAR(find_offsets(points, {}, e).mean_mm[0], 1, 0.05) << count;
    }
}

TEST(Offsets, AnImageThatIsNotBelievedMovesNothing) {
    const MovingPoint point{.position = {}, .normal = {1, 0, 0}, .distance_mm = 5, .prior_mm = 1};
    OffsetEvidence e = evidence(1, 24, 0.25, [](double u) { return -8 * (u - 2) * (u - 2); });
    e.image_sd_mm = {std::numeric_limits<double>::infinity()};
    EXPECT_EQ(find_offsets(std::span(&point, 1), {}, e).mean_mm[0], 0);
}

}  // namespace
}  // namespace kontur
