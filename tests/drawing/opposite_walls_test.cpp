// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/opposite_walls.h"

#include <gtest/gtest.h>

#include <limits>

#include "kontur/drawing/subdivide.h"
#include "kontur/fit/constraints.h"
#include "kontur/fit/prepare.h"
#include "kontur/shape/predicates.h"
#include "support/contour_sets.h"
#include "support/polygons.h"
#include "support/random.h"

namespace kontur {
namespace {

const Plane kPlane = make_plane({3, -40, 200}, {0.3, -0.5, 0.8});

TEST(OppositeWalls, OnlyWhatLiesOutsideCounts) {
    // A plate 1 mm thick: its other wall lies inside.
    ContourSet set;
    set.contours = {test::contour_in(kPlane, std::vector<test::Point2>{{0, 0}, {40, 0}, {40, 1}, {0, 1}})};
    for (const BoundaryPoint& point : prepare(set).points) EXPECT_TRUE(std::isinf(point.gap_mm));
}

TEST(OppositeWalls, AcrossACleftAndBetweenNeighbours) {
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

ContourSet in_plane(std::vector<std::vector<test::Point2>> polygons) {
    ContourSet set;
    for (const std::vector<test::Point2>& polygon : polygons) set.contours.push_back(test::contour_in(kPlane, polygon));
    return set;
}

ContourSet subdivided_narrow(const ContourSet& set, double shortest_mm, double long_mm = 0.1) {
    std::vector<PreparedLine> lines;
    for (const Contour& contour : set.contours) lines.push_back({0, contour, contour, long_mm, shortest_mm});
    subdivide_narrow(lines, 1000, 1e-3);
    ContourSet subdivided = set;
    for (std::size_t c = 0; c < lines.size(); ++c) subdivided.contours[c] = lines[c].fitted;
    return subdivided;
}

/// The longest edge whose middle lies in the box.
double longest_edge(const Contour& contour, const test::Point2& low, const test::Point2& high) {
    double longest = 0;
    for_each_edge(contour.points, [&](const Vec3& from, const Vec3& to) {
        const auto [u, v] = kPlane.to_uv(0.5 * (from + to));
        if (u > low[0] && u < high[0] && v > low[1] && v < high[1]) longest = std::max(longest, distance(from, to));
    });
    return longest;
}

TEST(SubdivideNarrow, ThinPartsGetPointsAsCloseAsTheyAreThin) {
    // A spade: a blade of 40 x 40 mm with a handle of 2 mm.
    const ContourSet spade = in_plane({{{-20, 0}, {-1, 0}, {-1, -60}, {1, -60}, {1, 0}, {20, 0}, {20, 40}, {-20, 40}}});
    const ContourSet fine = subdivided_narrow(spade, 0.1);
    EXPECT_LE(longest_edge(fine.contours[0], {-2, -59.9}, {2, -0.1}), 2);
    EXPECT_NEAR(longest_edge(fine.contours[0], {-30, 39}, {30, 41}), 40, 1e-9) << "the blade is as wide as its edge is long";
    const auto& points = fine.contours[0].points;
    auto next = points.begin();
    for (const Vec3& drawn : spade.contours[0].points) {
        next = std::find(next, points.end(), drawn);
        ASSERT_NE(next, points.end()) << "drawn points stay, in their order";
    }
}

TEST(SubdivideNarrow, CleftsBetweenContoursAreNarrowOnBothSides) {
    const ContourSet bars = in_plane({{{0, 0}, {40, 0}, {40, 60}, {0, 60}}, {{0, 61}, {40, 61}, {40, 120}, {0, 120}}});
    const ContourSet fine = subdivided_narrow(bars, 0.1);
    for (const Contour& contour : fine.contours) {
        EXPECT_LE(longest_edge(contour, {0, 59.5}, {40, 61.5}), 1);
        EXPECT_NEAR(longest_edge(contour, {0, -1}, {40, 121}), 40, 1e-9) << "the side that faces away";
    }
}

TEST(SubdivideNarrow, WhatWasDrawnInSmallStepsStaysAsItIs) {
    // A plate of 1 mm, its upper side drawn in steps of 4 mm; pieces of its lower side are as long.
    std::vector<test::Point2> plate{{0, 0}, {40, 0}};
    for (double u = 40; u >= 0; u -= 4) plate.push_back({u, 1});
    const Contour drawn = in_plane({plate}).contours[0];
    std::vector<PreparedLine> lines{{0, drawn, subdivide(drawn, 0), 5.0, 0.1}};
    EXPECT_LT(longest_edge(lines[0].fitted, {0, -0.5}, {40, 0.5}), 8);
    subdivide_narrow(lines, 1000, 1e-3);
    EXPECT_LE(longest_edge(lines[0].fitted, {0, -0.5}, {40, 0.5}), 1);
    EXPECT_NEAR(longest_edge(lines[0].fitted, {0, 0.5}, {40, 1.5}), 4, 1e-9);
}

TEST(SubdivideNarrow, EndsOfThinPartsGetPointsWhereTheLineTurnsTwice) {
    // A bar of 60 x 4 mm with a step; the step's corners turn to either side.
    const Contour drawn = in_plane({{{0, 0}, {30, 0}, {30, 1}, {60, 1}, {60, 5}, {0, 5}}}).contours[0];
    std::vector<PreparedLine> lines{{0, drawn, drawn, 1000, 1.0}};
    subdivide_narrow(lines, 0.6, 1e-3);
    EXPECT_NEAR(longest_edge(lines[0].fitted, {59, 1}, {61, 5}), 2, 1e-9)
        << "4 / 2 tan(90 degrees / 4) is 0.83, 2 / 2 tan(45 degrees / 4) is 0.2";
    EXPECT_NEAR(longest_edge(lines[0].fitted, {29, 0}, {31, 1}), 1, 1e-9);
}

TEST(SubdivideNarrow, PointsHaveALimitAndScaleWithTheDrawing) {
    // Walls that meet at a tip: pieces become shorter towards it, down to the limit.
    ContourSet wedge = in_plane({{{0, 0}, {100, 0}, {100, 10}}});
    const ContourSet fine = subdivided_narrow(wedge, 0.5);
    const std::size_t count = fine.contours[0].points.size();
    EXPECT_GT(count, 40);
    EXPECT_LT(count, 211 / 0.5);
    for_each_edge(fine.contours[0].points, [](const Vec3& from, const Vec3& to) { EXPECT_GE(distance(from, to), 0.5); });
    for (Vec3& p : wedge.contours[0].points) p = kPlane.origin + 7 * (p - kPlane.origin);
    EXPECT_EQ(subdivided_narrow(wedge, 3.5).contours[0].points.size(), count);
}

/// As far as the reach, along the normal, by looking at every edge of every contour.
double gap_by_all_edges(const std::vector<Contour>& contours, const BoundaryPoint& point, double reach) {
    const auto cross2 = [](const Point2& a, const Point2& b) { return a[0] * b[1] - a[1] * b[0]; };
    const Point2 start = kPlane.to_uv(point.position);
    const Point2 along{dot(point.inplane_normal, kPlane.u), dot(point.inplane_normal, kPlane.v)};
    double nearest = std::numeric_limits<double>::infinity();
    for (const Contour& contour : contours)
        for_each_edge(contour.points, [&](const Vec3& from, const Vec3& to) {
            const Point2 a = kPlane.to_uv(from), b = kPlane.to_uv(to);
            const Point2 edge{b[0] - a[0], b[1] - a[1]}, to_a{a[0] - start[0], a[1] - start[1]};
            const double turn = cross2(along, edge), ahead = cross2(to_a, edge) / turn, at = cross2(to_a, along) / turn;
            if (ahead > 1e-6 && ahead <= reach && at >= 0 && at <= 1) nearest = std::min(nearest, ahead);
        });
    return nearest;
}

TEST(OppositeWalls, AmongManyContoursAreThoseThatLookingAtAllOfThemFinds) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> shift(-1, 1), radius(1, 3);
    ContourSet set;
    std::vector<BoundaryPoint> points;
    for (int row = 0; row < 12; ++row)
        for (int column = 0; column < 12; ++column) {
            Plane plane = kPlane;
            plane.origin = kPlane.from_uv(9 * column + shift(random), 9 * row + shift(random));
            Contour& ring = set.contours.emplace_back(test::circle(plane, radius(random), 37));
            for (const Vec3& p : ring.points)
                points.push_back(
                    {p, normalized(p - plane.origin), kPlane.normal, static_cast<std::int32_t>(set.contours.size()) - 1});
            ring.plane = kPlane;
        }
    constexpr double kReach = 20;
    std::vector<PreparedLine> lines;
    for (const Contour& contour : set.contours) lines.emplace_back().fitted = contour;
    find_opposite_walls(lines, kReach, 0.01, points);
    int found = 0;
    for (const BoundaryPoint& point : points) {
        const double expected = gap_by_all_edges(set.contours, point, kReach);
        if (std::isinf(expected)) {
            EXPECT_TRUE(std::isinf(point.gap_mm));
            continue;
        }
        EXPECT_NEAR(point.gap_mm, expected, 1e-9);
        ++found;
    }
    EXPECT_GT(found, 1000);
}

TEST(OppositeWalls, HolesFaceTheirOwnOppositeWall) {
    ContourSet set;
    set.contours = {test::circle(kPlane, 30, 90), test::circle(kPlane, 2, 60)};
    set.contours[1].hole = true;
    for (const BoundaryPoint& point : prepare(set).points) {
        if (point.contour == 1) EXPECT_NEAR(point.gap_mm, 4, 0.02);
        else EXPECT_TRUE(std::isinf(point.gap_mm));
    }
}

TEST(OppositeWalls, NormalConstraintsStayOnTheirSideOfTheMiddle) {
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
