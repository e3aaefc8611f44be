// SPDX-License-Identifier: Apache-2.0
#include "kontur/function/split_kernel.h"

#include <gtest/gtest.h>

#include "support/random.h"

#include "kontur/function/screened_kernel.h"

namespace kontur {
namespace {

constexpr Kernel kKernels[] = {Kernel::screened, Kernel::triharmonic, Kernel::biharmonic};

NearSources one_source(const Vec3& at, double weight) {
    NearSources sources;
    sources.x.assign(kNearLanes, at.x);
    sources.y.assign(kNearLanes, at.y);
    sources.z.assign(kNearLanes, at.z);
    sources.w.assign(kNearLanes, 0.0);
    sources.w[3] = weight;
    return sources;
}

/// The odd powers of r that are split: {factor, exponent}.
std::vector<std::pair<double, double>> odd_powers_of(Kernel kernel) {
    constexpr double l2 = kScreeningLength * kScreeningLength;
    if (kernel == Kernel::biharmonic) return {{1, 1}};
    if (kernel == Kernel::triharmonic) return {{1, 3}};
    return {{1, 3}, {1 / (10 * l2), 5}, {1 / (280 * l2 * l2), 7}};
}

/// The series of r^exponent in q = (r / radius)^2 about 1, to its fifth power.
double smooth_power(double exponent, double radius, double r) {
    const double q = r * r / (radius * radius);
    double series = 0, term = 1;
    for (int m = 0; m <= 5; ++m) {
        series += term;
        term *= (exponent / 2 - m) / (m + 1) * (q - 1);
    }
    return std::pow(radius, exponent) * series;
}

TEST(SplitKernel, TheSplitPowersAreTheOddPartOfTheScreenedKernel) {
    for (const double r : {0.01, 0.1, 0.5, 1.0, 2.0}) {
        double sum = 0;
        for (const auto& [factor, exponent] : odd_powers_of(Kernel::screened)) sum += factor * std::pow(r, exponent);
        // The odd part of (1 + s) exp(-s) is s cosh s - sinh s.
        const double s = r / kScreeningLength, odd = 3 * std::pow(kScreeningLength, 3) * (s * std::cosh(s) - std::sinh(s));
        EXPECT_NEAR(sum / odd, 1, 1e-9 + 2e-8 * std::pow(r, 6)) << r;
    }
}

TEST(SplitKernel, NearPartIsThatOfTheTaylorSeriesAndVanishesBeyondTheRadius) {
    const double radius = 0.7;
    for (const Kernel kernel : kKernels) {
        for (int step = 0; step <= 60; ++step) {
            const double r = 0.02 * step;
            double expected = 0;
            for (const auto& [factor, exponent] : odd_powers_of(kernel))
                if (r < radius) expected += factor * (std::pow(r, exponent) - smooth_power(exponent, radius, r));
            const Vec3 target = Vec3{0.1, -0.2, 0.3} + r * normalized({2, -1, 3});
            const double found = NearKernel(kernel, radius).value(one_source({0.1, -0.2, 0.3}, 2), target);
            EXPECT_NEAR(found, 2 * expected, 1e-15) << r;
        }
    }
}

TEST(SplitKernel, FiveDerivativesOfTheSmoothPartPassTheRadiusContinuously) {
    // Of the near part, which is 0 beyond: the sixth difference over steps h is h^6 times a bounded derivative.
    const auto near = [](Kernel kernel, double r) { return NearKernel(kernel, 1).value(one_source({}, 1), {r, 0, 0}); };
    for (const Kernel kernel : kKernels)
        for (const double h : {0.04, 0.02}) EXPECT_LT(std::abs(near(kernel, 1 - h)), 10 * std::pow(h, 6));
}

TEST(SplitKernel, SumsOverAllSourcesAndItsGradientIsTheSlope) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> coordinate(-1, 1);
    NearSources sources;
    for (std::size_t i = 0; i < 5 * kNearLanes; ++i) {
        sources.x.push_back(coordinate(random));
        sources.y.push_back(coordinate(random));
        sources.z.push_back(coordinate(random));
        sources.w.push_back(coordinate(random));
    }
    for (const Kernel kernel : kKernels) {
        const NearKernel near(kernel, 0.9);
        for (int round = 0; round < 20; ++round) {
            const Vec3 target{coordinate(random), coordinate(random), coordinate(random)};
            double sum = 0;
            for (std::size_t i = 0; i < sources.x.size(); ++i)
                sum += near.value(one_source({sources.x[i], sources.y[i], sources.z[i]}, sources.w[i]), target);
            EXPECT_NEAR(near.value(sources, target), sum, 1e-14);
            const Vec3 gradient = near.gradient(sources, target);
            for (int axis = 0; axis < 3; ++axis) {
                const double h = 1e-5;
                Vec3 low = target, high = target;
                low[axis] -= h;
                high[axis] += h;
                EXPECT_NEAR(gradient[axis], (near.value(sources, high) - near.value(sources, low)) / (2 * h), 1e-7);
            }
        }
    }
}

TEST(SplitKernel, AtACentreTheGradientOfItsTermIsZero) {
    for (const Kernel kernel : kKernels)
        EXPECT_EQ(NearKernel(kernel, 1).gradient(one_source({0.25, 0.5, 0.125}, 1), {0.25, 0.5, 0.125}), Vec3{});
}

}  // namespace
}  // namespace kontur
