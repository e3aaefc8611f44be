// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/between_bounds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/contour_sets.h"

namespace kontur {
namespace {

const Vec3 kNormal = normalized({0.3, -0.5, 0.8});

/// Rings of 5 mm at these heights along kNormal.
ContourSet rings(const std::vector<double>& heights, double radius = 5) {
    ContourSet set;
    for (const double h : heights) set.contours.push_back(test::circle(make_plane(h * kNormal, kNormal), radius, 40));
    return set;
}

std::vector<Bound> between(const ContourSet& set) {
    const DrawnPlanes planes(set);
    const std::vector<DrawnRegion> regions = drawn_regions(planes);
    return between_bounds(regions, tube_ways(regions));
}

TEST(BetweenBounds, ATubeGoesOnHalfWayBetweenItsRings) {
    const std::vector<Bound> bounds = between(rings({0, 25, 50}));
    EXPECT_GT(bounds.size(), 30u);
    for (const Bound& bound : bounds) {
        if (bound.most_mm < 1) continue;  // of its wall
        const double height = dot(bound.position, kNormal);
        EXPECT_NEAR(std::min(std::abs(height - 12.5), std::abs(height - 37.5)), 0, 1e-6);
        const double depth = 5 - norm(bound.position - height * kNormal);
        EXPECT_NEAR(bound.least_mm, 0.35 * depth, 0.02);
        EXPECT_TRUE(bound.by_side);
    }
}

TEST(BetweenBounds, ATubeIsNoWiderBetweenItsRings) {
    std::size_t count = 0;
    for (const Bound& bound : between(rings({0, 25, 50}))) {
        if (bound.most_mm > 1) continue;
        const double height = dot(bound.position, kNormal);
        EXPECT_NEAR(std::remainder(height, 6.25), 0, 1e-6);
        EXPECT_NEAR(norm(bound.position - height * kNormal), 5, 0.01);
        EXPECT_NEAR(bound.most_mm, 0.25, 0.1) << "a twentieth of the radius";
        ++count;
    }
    EXPECT_GT(count, 100u);
    for (const Bound& bound : between(rings({0, 25}))) EXPECT_GT(bound.most_mm, 1) << "two rings are no tube for sure";
}

TEST(BetweenBounds, AnArchFollowsTheCurveOfItsRings) {
    ContourSet set;
    for (const double degrees : {0.0, 36.0, 72.0, 108.0}) {
        const double angle = degrees * M_PI / 180;
        set.contours.push_back(test::circle(
            make_plane({40 * std::cos(angle), 0, 40 * std::sin(angle)}, {-std::sin(angle), 0, std::cos(angle)}), 5, 40));
    }
    Vec3 middle;
    std::size_t count = 0;
    for (const Bound& bound : between(set))
        if (bound.by_side && std::atan2(bound.position.z, bound.position.x) < 36 * M_PI / 180) {
            middle += bound.position;
            ++count;
        }
    ASSERT_GT(count, 15u);
    EXPECT_NEAR(norm(middle / static_cast<double>(count)), 40, 0.3) << "a chord's middle lies at 38";
}

TEST(BetweenBounds, AWideStepOfAnArchFollowsItsCurve) {
    ContourSet set;
    for (const double angle : {0.0, M_PI / 3})
        set.contours.push_back(test::circle(
            make_plane({30 * std::cos(angle), 0, 30 * std::sin(angle)}, {-std::sin(angle), 0, std::cos(angle)}), 5, 40));
    const DrawnPlanes planes(set);
    const std::vector<TubeWay> ways = tube_ways(drawn_regions(planes));
    ASSERT_EQ(ways.size(), 1u);
    for (const Vec3& place : ways[0].places) EXPECT_NEAR(norm(place), 30, 0.5) << "a chord's middle lies at 26";
    EXPECT_NEAR(ways[0].distance_mm({0, 0, 0}), 30, 0.6);
    EXPECT_NEAR(ways[0].distance_mm(ways[0].middle()), 0, 1e-12);
}

TEST(BetweenBounds, AreNoneInAnOrdinaryStack) {
    EXPECT_TRUE(between(rings({0, 4, 8, 12})).empty());
    EXPECT_TRUE(between(test::three_great_circles()).empty());
}

TEST(BetweenBounds, JoinNoTwoBodiesOneAboveTheOther) {
    EXPECT_TRUE(between(rings({0, 4, 8, 12, 45, 49, 53})).empty()) << "much farther apart than each one's sections";
    EXPECT_TRUE(between(rings({0, 52})).empty()) << "more than ten radii";
}

TEST(BetweenBounds, JoinNoTwoBodiesBesideEachOther) {
    ContourSet set = rings({0, 25});
    for (Vec3& p : set.contours.back().points) p += 26 * set.contours.back().plane.u;
    EXPECT_TRUE(between(set).empty());
}

TEST(BetweenBounds, AreNoneWhereAPlaneAcrossShowsNothing) {
    ContourSet set = rings({0, 25});
    const std::size_t alone = between(set).size();
    ASSERT_GT(alone, 15u);
    // A small contour beside the tube, in a plane along its axis.
    const Vec3 u = set.contours[0].plane.u;
    set.contours.push_back(test::circle(make_plane(12.5 * kNormal + 9 * u, cross(kNormal, u)), 2, 40));
    EXPECT_LT(between(set).size(), alone / 2);
}

TEST(BetweenBounds, FadeOutAsTheSectionsPartFromEachOther) {
    double last = 0;
    for (const double apart : {39.0, 42.0, 45.0, 48.0}) {
        const std::vector<Bound> bounds = between(rings({0, apart}));
        ASSERT_FALSE(bounds.empty()) << apart;
        EXPECT_GE(bounds.front().noise_mm, last);
        last = bounds.front().noise_mm;
    }
}

}  // namespace
}  // namespace kontur
