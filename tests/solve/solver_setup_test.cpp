// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/solver_setup.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kontur/solve/solve.h"
#include "support/random.h"

namespace kontur {
namespace {

constexpr std::size_t kCount = 1500;
constexpr double kTolerance = 1e-4;

/// Points on a ball of 30 mm, of which the first are those of every longer set from the same numbers.
ConstraintSet ball(std::size_t count, std::mt19937& random) {
    std::normal_distribution<double> normal;
    ConstraintSet set;
    while (set.centers.size() < count) {
        const Vec3 direction = normalized({normal(random), normal(random), normal(random)});
        const double off = set.centers.size() % 3 == 0 ? 1.0 : 0.0;
        set.centers.push_back((30 + off) * direction);
        set.values.push_back(-off);
    }
    return set;
}

/// Without the first `without`, only the next `count`.
ConstraintSet part(const ConstraintSet& all, std::size_t without, std::size_t count) {
    const auto cut = [&](const auto& v) {
        const auto first = v.begin() + static_cast<std::ptrdiff_t>(without);
        return std::vector(first, first + static_cast<std::ptrdiff_t>(count));
    };
    return {.centers = cut(all.centers), .values = cut(all.values), .trust = {}, .noise_mm = {}, .extents = {}};
}

SolveOptions options_with(Products products) {
    return {.ball = Ball3{{}, 31}, .tolerance_mm = kTolerance, .products = products};
}

/// Largest difference of two functions at some points near the ball.
double difference(const ImplicitFunction& a, const ImplicitFunction& b) {
    double largest = 0;
    for (double x = -35; x <= 35; x += 7)
        for (double y = -35; y <= 35; y += 7)
            for (double z = -35; z <= 35; z += 7)
                largest = std::max(largest, std::abs(a.value({x, y, z}) - b.value({x, y, z})));
    return largest;
}

class SharedSetup : public testing::TestWithParam<Products> {};
INSTANTIATE_TEST_SUITE_P(Products, SharedSetup, testing::Values(Products::direct, Products::hierarchical));

TEST_P(SharedSetup, SolvesWithAFewOtherCentresToTheSameFunction) {
    std::mt19937 random = test::random_of_this_test();
    const ConstraintSet all = ball(kCount + 20, random);
    const SolveOptions options = options_with(GetParam());
    PreviousSolve previous;
    solve(part(all, 0, kCount), options, {}, &previous);
    const std::vector<std::pair<std::size_t, std::size_t>> parts{{0, kCount + 4}, {3, kCount + 3}, {1, kCount - 1}};
    for (const auto& [without, count] : parts) {
        const ConstraintSet set = part(all, without, count);
        const Solution shared = solve(set, options, {}, &previous);
        EXPECT_EQ(previous.setup->first_centers, kCount) << "the setup is another one";
        const Solution alone = solve(set, options);
        EXPECT_LE(shared.report.residual, kTolerance);
        EXPECT_LT(shared.report.iterations, alone.report.iterations);
        EXPECT_EQ(shared.function.weights().size(), set.size());
        EXPECT_LT(difference(shared.function, alone.function), 100 * kTolerance);
    }
}

TEST_P(SharedSetup, GivesTheSameBytesForAnyNumberOfThreads) {
    std::mt19937 random = test::random_of_this_test();
    const ConstraintSet all = ball(kCount + 20, random);
    const auto weights = [&](int threads) {
        PreviousSolve previous;
        solve(part(all, 0, kCount), options_with(GetParam()), {.threads = threads}, &previous);
        solve(part(all, 2, kCount + 8), options_with(GetParam()), {.threads = threads}, &previous);
        return previous.weights;
    };
    const std::vector<double> one = weights(1);
    for (const int threads : {2, 3}) EXPECT_EQ(weights(threads), one) << threads;
}

TEST(SolverSetup, IsMadeAnewForManyOthersOrAnotherSmoothing) {
    std::mt19937 random = test::random_of_this_test();
    const ConstraintSet all = ball(kCount + 100, random);
    SolveOptions options = options_with(Products::automatic);
    PreviousSolve previous;
    solve(part(all, 0, kCount), options, {}, &previous);
    solve(part(all, 0, kCount + 100), options, {}, &previous);
    EXPECT_EQ(previous.setup->first_centers, kCount + 100);
    options.smoothing = 1e-4;
    solve(part(all, 0, kCount + 99), options, {}, &previous);
    EXPECT_EQ(previous.setup->first_centers, kCount + 99);
}

TEST(SolverSetup, OthersAddUpFromSolveToSolve) {
    std::mt19937 random = test::random_of_this_test();
    const ConstraintSet all = ball(kCount + 100, random);
    PreviousSolve previous;
    std::size_t made = 0, last = 0;
    for (std::size_t count = kCount; count <= kCount + 100; count += 10) {
        solve(part(all, 0, count), options_with(Products::automatic), {}, &previous);
        made += std::exchange(last, previous.setup->first_centers) != previous.setup->first_centers;
        EXPECT_LE(previous.setup->centers.size(), previous.setup->first_centers * 65 / 64);
    }
    EXPECT_GT(made, 1U);
    EXPECT_LT(made, 10U);
}

TEST(SolverSetup, IsNotSharedByKernelsWithSideConditions) {
    std::mt19937 random = test::random_of_this_test();
    const ConstraintSet all = ball(kCount + 2, random);
    SolveOptions options = options_with(Products::automatic);
    options.kernel = Kernel::triharmonic;
    PreviousSolve previous;
    solve(part(all, 0, kCount), options, {}, &previous);
    solve(all, options, {}, &previous);
    EXPECT_EQ(previous.setup->first_centers, all.size());
}

}  // namespace
}  // namespace kontur
