// SPDX-License-Identifier: Apache-2.0
#include "kontur/sureness/image_shares.h"

#include <gtest/gtest.h>

namespace kontur {
namespace {

TEST(ImageShares, AreOneWhereNoImageWasAsked) {
    EXPECT_TRUE(ImageShares().is_empty());
    EXPECT_EQ(ImageShares().at({1, 2, 3}), 1);
}

TEST(ImageShares, AreThoseOfThePointsAskedAndBetweenThemBetween) {
    const ImageShares shares({{{0, 0, 0}, 0.2}, {{10, 0, 0}, 0.8}});
    EXPECT_EQ(shares.at({0, 0, 0}), 0.2);
    EXPECT_EQ(shares.at({10, 0, 0}), 0.8);
    EXPECT_DOUBLE_EQ(shares.at({5, 3, 0}), 0.5);
    EXPECT_NEAR(shares.at({1, 0, 0}), 0.2, 1e-3);
}

}  // namespace
}  // namespace kontur
