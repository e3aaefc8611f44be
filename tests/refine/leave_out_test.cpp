// SPDX-License-Identifier: Apache-2.0
#include "kontur/refine/leave_out.h"

#include <gtest/gtest.h>

namespace kontur {
namespace {

/// Twenty points in each plane, 2 mm off without the image, and with it by so much less.
HeldOutErrors errors_of(const std::vector<double>& gains_mm) {
    std::vector<HeldOut> points;
    for (std::size_t plane = 0; plane < gains_mm.size(); ++plane)
        for (int n = 0; n < 20; ++n)
            points.push_back({Vec3{1.0 * n, 10.0 * static_cast<double>(plane), 0}, 10, 2, 2 - gains_mm[plane], plane});
    return HeldOutErrors(points, {[](double d) { return 0.1 * d; }}, 100, 1, 0, gains_mm.size(), 0);
}

TEST(HeldOutErrors, WhatHelpsInOnePlaneOfFourMayBeChance) {
    EXPECT_TRUE(errors_of({0.5, 0.5, 0.5, 0.5}).image_helps());
    EXPECT_TRUE(errors_of({0.2, 0.9, 0.6, 0.3}).image_helps());
    EXPECT_FALSE(errors_of({1.8, 0.2, -0.1, -0.3}).image_helps()) << "the mean is 0.4 mm, give or take 0.48";
    EXPECT_NEAR(errors_of({1.8, 0.2, -0.1, -0.3}).with_mm(), 1.6, 1e-12);
}

TEST(HeldOutErrors, AnImageOfFewPercentIsNone) {
    EXPECT_FALSE(errors_of({0.05, 0.05, 0.05, 0.05}).image_helps());
    EXPECT_TRUE(errors_of({0.15, 0.15, 0.15, 0.15}).image_helps());
}

TEST(HeldOutErrors, FartherFromContoursThanAnyWasTheImageIsTrustedLess) {
    const HeldOutErrors errors = errors_of({0.5, 0.5, 0.5, 0.5});
    const auto image_mm = [&](double distance_mm) {
        return errors.beliefs().image_mm({.position = {5, 15, 0}, .normal = {1, 0, 0}, .distance_mm = distance_mm});
    };
    EXPECT_LT(image_mm(5), image_mm(10));
    EXPECT_NEAR(image_mm(30), 3 * image_mm(10), 1e-9);
}

}  // namespace
}  // namespace kontur
