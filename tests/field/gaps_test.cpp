// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/gaps.h"

#include <gtest/gtest.h>

#include "kontur/field/prepare.h"
#include "support/contour_sets.h"
#include "support/polygons.h"

namespace kontur {
namespace {

const Plane kPlane = make_plane({3, -40, 200}, {0.3, -0.5, 0.8});

TEST(FindGaps, OnlyWhatLiesOutsideCounts) {
    // A plate 1 mm thick: its other wall lies inside.
    ContourSet set;
    set.contours = {test::contour_in(kPlane, std::vector<test::Point2>{{0, 0}, {40, 0}, {40, 1}, {0, 1}})};
    for (const BoundaryPoint& point : prepare(set).points) EXPECT_TRUE(std::isinf(point.gap_mm));
}

TEST(FindGaps, AcrossACleftAndBetweenNeighbours) {
    // Two bars, 0.4 mm apart, one of them with a notch 2 mm wide.
    ContourSet set;
    set.contours = {
        test::contour_in(kPlane, std::vector<test::Point2>{{0, 0}, {40, 0}, {40, 10}, {0, 10}}),
        test::contour_in(kPlane, std::vector<test::Point2>{
                                     {0, 10.4}, {40, 10.4}, {40, 20}, {22, 20}, {22, 14}, {20, 14}, {20, 20}, {0, 20}})};
    int between = 0, notch = 0;
    for (const BoundaryPoint& point : prepare(set).points) {
        const auto [u, v] = kPlane.to_uv(point.position);
        const bool inner = u > 0.5 && u < 39.5;
        if (inner && (std::abs(v - 10) < 1e-6 || std::abs(v - 10.4) < 1e-6)) {
            EXPECT_NEAR(point.gap_mm, 0.4, 1e-9);
            ++between;
        } else if (v > 14.5 && v < 19.5 && std::abs(u - 21) < 1.5) {
            EXPECT_NEAR(point.gap_mm, 2, 1e-9);
            ++notch;
        } else if (v < 0.1) {
            EXPECT_TRUE(std::isinf(point.gap_mm));
        }
    }
    EXPECT_GT(between, 30);
    EXPECT_GE(notch, 4);
}

TEST(FindGaps, HolesFaceTheirOwnOppositeWall) {
    ContourSet set;
    set.contours = {test::circle(kPlane, 30, 90), test::circle(kPlane, 2, 60)};
    set.contours[1].hole = true;
    for (const BoundaryPoint& point : prepare(set).points) {
        if (point.contour == 1) EXPECT_NEAR(point.gap_mm, 4, 0.02);
        else EXPECT_TRUE(std::isinf(point.gap_mm));
    }
}

TEST(FindGaps, NormalConstraintsStayOnTheirSideOfTheMiddle) {
    std::vector<BoundaryPoint> points{{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0, 1, 0.5}, {{0, 9, 0}, {0, 1, 0}, {0, 0, 1}, 0}};
    const std::vector<double> slopes{1, 0.5};
    const PlacedConstraints placed = place_constraints(points, slopes, {}, {.normal_offset_mm = 2});
    EXPECT_EQ(placed.constraints.centers[2], (Vec3{0.25, 0, 0}));
    EXPECT_EQ(placed.constraints.centers[3], (Vec3{0, 11, 0}));
    EXPECT_EQ(placed.constraints.values, (std::vector<double>{0, 0, -0.25, -1}));
}

TEST(PlaceConstraints, PointsOfUnknownDirectionGetNoNormalConstraint) {
    const std::vector<BoundaryPoint> points{{.position = {1, 2, 3}, .contour = kNoContour}};
    const PlacedConstraints placed = place_constraints(points, std::vector<double>{1}, {});
    EXPECT_EQ(placed.constraints.size(), 1u);
    EXPECT_EQ(placed.merged, 0u);
}

}  // namespace
}  // namespace kontur
