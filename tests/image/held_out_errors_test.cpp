// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/held_out_errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/phantom/random.h"

namespace kontur {
namespace {

constexpr double kVoxelMm = 0.1, kFarMm = 10;  // of every held-out point

HeldOutErrors errors_of(const std::vector<HeldOutPoint>& points) {
    std::vector<PlaneErrors> planes;
    for (const HeldOutPoint& point : points) {
        planes.resize(std::max(planes.size(), point.plane + 1));
        planes[point.plane].points.push_back(point);
    }
    return {planes, {[](double d) { return 0.1 * d; }}, 100, kVoxelMm};
}

/// Twenty points in each plane, 2 mm off without the image, and with it by so much less.
HeldOutErrors errors_with_gains(const std::vector<double>& gains_mm) {
    std::vector<HeldOutPoint> points;
    for (std::size_t plane = 0; plane < gains_mm.size(); ++plane)
        for (int n = 0; n < 20; ++n) points.push_back({kFarMm, 2, 2 - gains_mm[plane], 2, plane});
    return errors_of(points);
}

/// 20 planes of 100 points: errors of `error_mm`, of which an image tells that is off by `image_mm` of its own.
std::vector<HeldOutPoint> told(double error_mm, double image_mm) {
    Random random(3);
    std::vector<HeldOutPoint> points;
    for (std::size_t plane = 0; plane < 20; ++plane)
        for (int n = 0; n < 100; ++n) {
            const double error = error_mm * random.gaussian(), image = image_mm * random.gaussian();
            points.push_back({kFarMm, error, -image, error, plane});
        }
    return points;
}

double image_mm(const HeldOutErrors& errors, double far_mm = kFarMm) { return errors.beliefs().image_mm(far_mm); }

TEST(HeldOutErrors, WhatHelpsInOnePlaneOfFourMayBeChance) {
    EXPECT_EQ(errors_with_gains({0.5, 0.5, 0.5, 0.5}).weight(), 1);
    EXPECT_EQ(errors_with_gains({0.2, 0.9, 0.6, 0.3}).weight(), 1);
    EXPECT_EQ(errors_with_gains({1.8, 0.2, -0.1, -0.3}).weight(), 0) << "the mean is 0.4 mm, give or take 0.48";
    EXPECT_NEAR(errors_with_gains({1.8, 0.2, -0.1, -0.3}).with_mm(), 1.6, 1e-12);
}

TEST(HeldOutErrors, AnImageOfFewPercentCountsInPart) {
    EXPECT_EQ(errors_with_gains({-0.05, -0.05, -0.05, -0.05}).weight(), 0);
    EXPECT_EQ(errors_with_gains({0, 0, 0, 0}).weight(), 0);
    EXPECT_NEAR(errors_with_gains({0.05, 0.05, 0.05, 0.05}).weight(), 0.5, 1e-9);
    EXPECT_NEAR(errors_with_gains({0.09, 0.09, 0.09, 0.09}).weight(), 0.9, 1e-9);
    EXPECT_EQ(errors_with_gains({0.15, 0.15, 0.15, 0.15}).weight(), 1);
    EXPECT_EQ(errors_with_gains({0.15, 0.15, 0.15, 0.15}).weight({0.2, 0.3}), 0);
}

TEST(HeldOutErrors, BelowAQuarterOfAVoxelThereIsNothingToSeeNorOfACellForAWalk) {
    constexpr double kCellMm = 4 * kVoxelMm;
    const auto errors = [](double voxels) {
        const double error_mm = voxels * kVoxelMm;
        std::vector<HeldOutPoint> points;
        for (std::size_t plane = 0; plane < 4; ++plane)
            for (int n = 0; n < 20; ++n) points.push_back({kFarMm, error_mm, 0, error_mm, plane});
        return errors_of(points);
    };
    EXPECT_EQ(errors(0.2).visibility(), 0);
    EXPECT_NEAR(errors(0.375).visibility(), 0.5, 1e-9);
    EXPECT_EQ(errors(0.6).visibility(), 1);
    EXPECT_EQ(errors(0.6).visibility(kCellMm), 0) << "the voxels know more than cells that are four of them wide";
    EXPECT_NEAR(errors(1.5).visibility(kCellMm), 0.5, 1e-9);
}

TEST(HeldOutErrors, TellTheErrorOfTheImage) {
    for (const double image : {0.5, 1.0, 2.0}) EXPECT_NEAR(image_mm(errors_of(told(1, image))), image, 0.05 * image);
}

TEST(HeldOutErrors, WhatTheImageMayNotMendTellsNothingOfIt) {
    // Beyond the end of a stack the surface may not follow: 5 mm of error are left whatever the image shows.
    std::vector<HeldOutPoint> points = told(1, 1);
    for (int n = 0; n < 200; ++n) points.push_back({kFarMm, 5, 6, 0, 0});
    EXPECT_NEAR(image_mm(errors_of(points)), image_mm(errors_of(told(1, 1))), 0.2);
    for (HeldOutPoint& point : points) point.reachable_mm = point.without_mm;
    EXPECT_GT(image_mm(errors_of(points)), 1.5);
}

/// Four planes are 1.2 mm off; an image tells 1 mm in three of them, and this in the last.
HeldOutErrors errors_of_which_the_last_is_told(double moved_mm) {
    std::vector<HeldOutPoint> points;
    for (std::size_t plane = 0; plane < 4; ++plane)
        for (int n = 0; n < 20; ++n) {
            const double moved = plane == 3 ? moved_mm : 1;
            points.push_back({kFarMm, 1.2, 1.2 - moved, 1.2, plane});
        }
    return errors_of(points);
}

TEST(HeldOutErrors, WhatCouldBeChanceIsNotFollowedAtAll) {
    // Of four planes one is told wrongly, and by much: the share that is true is 0.5, give or take 0.6.
    const HeldOutErrors errors = errors_of_which_the_last_is_told(-1.4);
    EXPECT_EQ(errors.weight(), 0);
    EXPECT_EQ(image_mm(errors), std::numeric_limits<double>::infinity());
    EXPECT_EQ(image_mm(errors_with_gains({0, 0, 0, 0})), std::numeric_limits<double>::infinity())
        << "an image that says nothing";
}

TEST(HeldOutErrors, WhatHardlyIsNoChanceHardlyCounts) {
    double before = 0;
    for (double moved = -1.4; moved < 1; moved += 0.005) {
        const double weight = errors_of_which_the_last_is_told(moved).weight();
        EXPECT_GE(weight, before - 1e-9) << moved;
        EXPECT_LT(weight, before + 0.1) << moved;
        before = weight;
    }
    EXPECT_EQ(before, 1);
}

TEST(HeldOutErrors, WhatCountsLessMovesLess) {
    const HeldOutErrors errors = errors_of(told(1, 1));
    double less = std::numeric_limits<double>::infinity();
    EXPECT_EQ(errors.beliefs(0).image_mm(kFarMm), less);
    for (const double weight : {0.01, 0.1, 0.5, 0.9, 1.0}) {
        const double image = errors.beliefs(weight).image_mm(kFarMm);
        EXPECT_LT(image, less);
        less = image;
    }
    EXPECT_EQ(less, image_mm(errors));
}

TEST(HeldOutErrors, FartherFromContoursThanAnyWasTheImageIsTrustedLess) {
    const HeldOutErrors errors = errors_of(told(1, 1));
    EXPECT_LT(image_mm(errors, 5), image_mm(errors, 10));
    EXPECT_NEAR(image_mm(errors, 30), 3 * image_mm(errors, 10), 1e-9);
}

}  // namespace
}  // namespace kontur
