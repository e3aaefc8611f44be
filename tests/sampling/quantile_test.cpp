// SPDX-License-Identifier: Apache-2.0
#include "kontur/sampling/quantile.h"

#include <gtest/gtest.h>

namespace kontur {
namespace {

TEST(Quantile, IsLinearBetweenNeighboursInOrder) {
    const std::vector<double> values{40, 10, 30, 20};
    EXPECT_DOUBLE_EQ(quantile(values, 0), 10);
    EXPECT_DOUBLE_EQ(quantile(values, 1), 40);
    EXPECT_DOUBLE_EQ(quantile(values, 1.0 / 3), 20);
    EXPECT_DOUBLE_EQ(quantile(values, 0.5), 25);
    EXPECT_DOUBLE_EQ(median(values), 25);
    EXPECT_DOUBLE_EQ(median({7}), 7);
    EXPECT_DOUBLE_EQ(median({3, 1, 2}), 2);
}

TEST(Quantile, IsTheSameOfSortedValues) {
    const std::vector<double> sorted{-4, 0, 0, 1, 9, 12};
    std::vector<double> mixed{9, 0, 12, -4, 1, 0};
    for (double fraction = 0; fraction <= 1; fraction += 0.05)
        EXPECT_DOUBLE_EQ(quantile_of_sorted(sorted, fraction), quantile(mixed, fraction)) << fraction;
}

TEST(Quantile, WeighsValues) {
    const std::vector<double> values{3, 1, 2}, weights{1, 8, 1};
    EXPECT_DOUBLE_EQ(weighted_quantile(values, weights, 0.5), 1);
    EXPECT_DOUBLE_EQ(weighted_quantile(values, weights, 0.85), 2);
    EXPECT_DOUBLE_EQ(weighted_quantile(values, weights, 1), 3);
}

}  // namespace
}  // namespace kontur
