// SPDX-License-Identifier: Apache-2.0
#include "kontur/function/root_by_estimate.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "support/random.h"

#if KONTUR_X86_64_LEVEL != 1

namespace kontur {
namespace {

__attribute__((target("arch=x86-64-v4"))) void find_roots(const std::array<double, 8>& squared,
                                                          std::array<double, 8>& roots) {
    Pack8 from, to;
    for (std::size_t l = 0; l < 8; ++l) from[l] = squared[l];
    root_by_estimate(from, to);
    for (std::size_t l = 0; l < 8; ++l) roots[l] = to[l];
}

class RootByEstimate : public testing::Test {
    void SetUp() override {
        if (x86_64_level() < 4) GTEST_SKIP() << "this processor has no estimate";
    }
};

TEST_F(RootByEstimate, IsTheProcessorsOwnToTheLastBit) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> mantissa(1, 2);
    std::uniform_int_distribution<int> exponent(-990, 990);
    std::array<double, 8> squared, roots;
    for (int n = 0; n < 200'000; ++n) {
        for (double& s : squared) s = std::ldexp(mantissa(random), exponent(random));
        // Squares and their neighbours lie on and beside numbers that have a root.
        const double whole = std::floor(std::ldexp(mantissa(random), 25));
        squared[0] = whole * whole;
        squared[1] = std::nextafter(squared[0], 0);
        squared[2] = std::nextafter(squared[0], HUGE_VAL);
        find_roots(squared, roots);
        for (std::size_t l = 0; l < 8; ++l) ASSERT_EQ(roots[l], std::sqrt(squared[l])) << squared[l];
    }
}

TEST_F(RootByEstimate, OfNothingIsNextToNothingAndOfNoNumberNone) {
    const double least = std::numeric_limits<double>::denorm_min();
    std::array<double, 8> roots;
    find_roots({0, -0.0, least, 1e-310, std::numeric_limits<double>::quiet_NaN(), 1, 4, 1e300}, roots);
    for (std::size_t l = 0; l < 4; ++l) EXPECT_LE(std::abs(roots[l]), 2e-150) << l;
    EXPECT_TRUE(std::isnan(roots[4]));
    EXPECT_EQ(roots[5], 1);
    EXPECT_EQ(roots[6], 2);
    EXPECT_EQ(roots[7], std::sqrt(1e300));
}

}  // namespace
}  // namespace kontur

#endif
