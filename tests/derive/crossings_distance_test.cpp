// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/crossings_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/random.h"

namespace kontur {
namespace {

/// Random levels, outside on the outermost points.
Levels random_levels(const Index3& size, std::mt19937& random) {
    Levels levels{{{2, -1, 5}, {size.i + 1, size.j - 2, size.k + 4}}, {}};
    std::uniform_real_distribution<float> value(0.01F, 1);
    std::bernoulli_distribution inside(0.12);
    for (std::int64_t k = 0; k < size.k; ++k)
        for (std::int64_t j = 0; j < size.j; ++j)
            for (std::int64_t i = 0; i < size.i; ++i) {
                const bool border = i == 0 || j == 0 || k == 0 || i + 1 == size.i || j + 1 == size.j || k + 1 == size.k;
                levels.values.push_back(!border && inside(random) ? value(random) : -value(random));
            }
    return levels;
}

/// Each crossing tried for each point.
double nearest(const std::vector<Vec3>& crossings, const Vec3& p, const DirectedWeights& weights) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& c : crossings) {
        double sum = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<std::size_t>(axis);
            const double apart = p[axis] - c[axis];
            sum += std::pow((apart < 0 ? weights.towards_low[a] : weights.towards_high[a]) * apart, 2);
        }
        least = std::min(least, std::sqrt(sum));
    }
    return least;
}

void expect_exact(const DirectedWeights& weights, double reach) {
    std::mt19937 random = test::random_of_this_test();
    const Vec3 spacing{0.7, 1.3, 2.9};
    Grid grid{{1, 1, 1}, {}};
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 column;
        column[axis] = spacing[axis];
        grid.index_to_mm.set_column(axis, column);
    }
    for (int round = 0; round < 6; ++round) {
        const Levels levels = random_levels({9, 8, 7}, random);
        const std::vector<Vec3> crossings = surface_points(levels, grid);
        ASSERT_FALSE(crossings.empty());
        const std::vector<float> found =
            crossings_distance(levels, {.spacing_mm = spacing, .reach = reach, .weights = weights}, {});
        for (std::int64_t k = levels.box.low.k; k <= levels.box.high.k; ++k)
            for (std::int64_t j = levels.box.low.j; j <= levels.box.high.j; ++j)
                for (std::int64_t i = levels.box.low.i; i <= levels.box.high.i; ++i) {
                    const double exact = nearest(crossings, grid.center_mm(i, j, k), weights);
                    const double here = static_cast<double>(found[levels.offset({i, j, k})]);
                    if (exact < reach - 1e-3) {
                        EXPECT_NEAR(here, exact, 1e-4);
                    }
                    if (exact > reach + 1e-3) {
                        EXPECT_TRUE(std::isinf(here));
                    }
                }
    }
}

TEST(CrossingsDistance, IsThatOfEachCrossingTriedForEachPoint) { expect_exact({}, 100); }

TEST(CrossingsDistance, KnowsNothingBeyondItsReach) { expect_exact({}, 1.6); }

TEST(CrossingsDistance, WeighsEachOfSixDirections) {
    expect_exact({.towards_low = {0.3, 1, 0.2}, .towards_high = {0.2, 0.1, 0.5}}, 100);
    expect_exact({.towards_low = {0.3, 1000, 0.2}, .towards_high = {1000, 0.1, 0.5}}, 0.8);
}

TEST(CrossingsDistance, IsTheSameForAnyNumberOfThreads) {
    std::mt19937 random = test::random_of_this_test();
    const Levels levels = random_levels({40, 30, 20}, random);
    const CrossingsDistanceOptions options{.spacing_mm = {1, 2, 3}, .reach = 9};
    EXPECT_EQ(crossings_distance(levels, options, {.threads = 1}), crossings_distance(levels, options, {.threads = 5}));
}

}  // namespace
}  // namespace kontur
