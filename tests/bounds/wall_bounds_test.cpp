// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/wall_bounds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kontur/drawing/drawn_planes.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

constexpr double kRadius = 8;
const Vec3 kNormal = normalized({0.3, -0.5, 0.8});

Plane plane_at(double height, const Vec3& normal = kNormal) { return make_plane(height * kNormal, normal); }

/// Rings about kNormal at 0 and 40 mm, and a plane so far below the first one that shows nothing.
ContourSet tube(double empty_mm, double next_radius = kRadius) {
    ContourSet set;
    set.contours = {test::circle(plane_at(0), kRadius, 40), test::circle(plane_at(40), next_radius, 40)};
    set.empty_planes.push_back(plane_at(-empty_mm));
    return set;
}

/// Of the first contour's region.
std::vector<Bound> walls(const ContourSet& set, double sign) {
    const DrawnPlanes planes(set);
    const std::vector<DrawnRegion> regions = drawn_regions(planes);
    const double towards = dot(regions[0].section.plane.normal, kNormal) > 0 ? sign : -sign;
    return wall_bounds(planes, regions, 0, towards);
}

TEST(WallBounds, HoldTheWallBelowAFlatEnd) {
    const std::vector<Bound> bounds = walls(tube(1), -1);
    ASSERT_EQ(bounds.size(), 40u * 3);
    for (const Bound& bound : bounds) {
        const double below = dot(bound.position, kNormal);
        EXPECT_NEAR(norm(bound.position - below * kNormal), kRadius, 1e-9) << "below the ring itself";
        EXPECT_GT(below, 0);
        EXPECT_NEAR(bound.most_mm, 0.1 * below, 1e-9);
        EXPECT_LT(bound.noise_mm, 0.06 * below);
    }
}

TEST(WallBounds, FadeOutAsThePlaneMovesAway) {
    double before = 0;
    for (const double away : {1.0, 3.0, 6.0, 9.0, 11.0}) {
        const std::vector<Bound> bounds = walls(tube(away), -1);
        ASSERT_FALSE(bounds.empty()) << away;
        EXPECT_GT(bounds.front().noise_mm, before);
        before = bounds.front().noise_mm;
    }
    EXPECT_TRUE(walls(tube(12), -1).empty());
}

TEST(WallBounds, AreOnlyOnTheSideThatEnds) {
    EXPECT_TRUE(walls(tube(1), 1).empty());
    ContourSet open = tube(1);
    open.empty_planes.clear();
    EXPECT_TRUE(walls(open, -1).empty());
}

TEST(WallBounds, LeaveAWallThatFlaresToTheNextSection) {
    for (const Bound& bound : walls(tube(1, 20), -1)) {
        const double below = dot(bound.position, kNormal);
        EXPECT_NEAR(bound.most_mm, (0.1 + 12 / 40.0) * below, 0.01 * below) << "12 mm deeper over 40 mm";
    }
}

TEST(WallBounds, ReachHalfTheWayToTheNextSection) {
    ContourSet near = tube(1);
    near.contours[1] = test::circle(plane_at(10), kRadius, 40);
    for (const Bound& bound : walls(near, -1)) EXPECT_LE(dot(bound.position, kNormal), 5);
}

TEST(WallBounds, ADrawnPlaneThatShowsNothingThereIsAsGoodAsAnEmptyOne) {
    ContourSet set = tube(1);
    set.empty_planes.clear();
    Vec3 beside = cross(kNormal, {0, 0, 1});
    beside = 60 / norm(beside) * beside;
    set.contours.push_back(test::circle(make_plane(beside - 1 * kNormal, kNormal), kRadius, 40));
    EXPECT_EQ(walls(set, -1).size(), 40u * 3);
    set.contours.back() = test::circle(plane_at(-1), kRadius, 40);
    EXPECT_TRUE(walls(set, -1).empty()) << "it carries the region on";
}

TEST(WallBounds, APlaneThatCrossesSaysNothing) {
    ContourSet set = tube(1);
    set.empty_planes.front() = plane_at(-1, normalized(kNormal + cross(kNormal, {0, 0, 1})));
    EXPECT_TRUE(walls(set, -1).empty());
}

}  // namespace
}  // namespace kontur
