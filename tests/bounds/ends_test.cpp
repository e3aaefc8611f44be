// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/ends.h"

#include <gtest/gtest.h>

#include "kontur/drawing/drawn_planes.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

const Vec3 kNormal = normalized({0.3, -0.5, 0.8});

/// Circles of 10 mm at these heights, the last one an end.
ContourSet stack(std::initializer_list<double> heights, ContourEnd end) {
    ContourSet set;
    for (const double h : heights) set.contours.push_back(test::circle(make_plane(h * kNormal, kNormal), 10, 60));
    set.contours.back().end = end;
    return set;
}

TEST(FindEnds, AFlatEndLiesJustBeyondItsPlaneAndFacesAwayFromTheRest) {
    for (const double direction : {1.0, -1.0}) {
        const ContourSet set = stack({0, 4 * direction, 8 * direction}, ContourEnd::flat);
        const Ends ends = find_ends(DrawnPlanes(set));
        EXPECT_GT(ends.lids.size(), 60u);
        EXPECT_TRUE(ends.notes.empty());
        std::size_t wall = 0;
        for (const BoundaryPoint& point : ends.lids) {
            EXPECT_EQ(point.contour, 2);
            const double height = direction * dot(point.position, kNormal);
            const Vec3 from_axis = point.position - direction * height * kNormal;
            if (height < 7.5) {
                EXPECT_NEAR(height, 7, 0.1) << "a tenth of the radius before the end";
                EXPECT_LT(distance(10.0 * point.inplane_normal, from_axis), 1e-6) << "upright";
                ++wall;
                continue;
            }
            EXPECT_NEAR(height, 8.05, 0.01) << "0.005 of the radius beyond what was drawn, which belongs to the object";
            EXPECT_LT(distance(point.inplane_normal, direction * kNormal), 1e-9);
            EXPECT_LT(norm(from_axis), 10);
        }
        EXPECT_EQ(wall, 60u);
    }
}

TEST(FindEnds, TheWallAtAFlatEndGoesOnToTheNextPlane) {
    for (const double wider : {2.0, 0.0, -2.0}) {
        ContourSet set;
        set.contours = {test::circle(make_plane({}, kNormal), 10 + wider, 60),
                        test::circle(make_plane(4 * kNormal, kNormal), 10, 60)};
        set.contours.back().end = ContourEnd::flat;
        std::size_t wall = 0;
        for (const BoundaryPoint& point : find_ends(DrawnPlanes(set)).lids) {
            const double height = dot(point.position, kNormal);
            if (height > 3.5) continue;
            EXPECT_NEAR(norm(point.position - height * kNormal), 10 + (4 - height) / 4 * wider, 0.02) << wider;
            ++wall;
        }
        EXPECT_EQ(wall, 60u);
    }
}

TEST(FindEnds, ARoundEndReachesHalfAPlaneSpacing) {
    double highest = 0;
    for (const BoundaryPoint& point : find_ends(DrawnPlanes(stack({0, 6, 12}, ContourEnd::round))).lids) {
        const double height = dot(point.position, kNormal) - 12;
        EXPECT_GT(height, 0);
        highest = std::max(highest, height);
    }
    EXPECT_NEAR(highest, 3, 0.1);
}

TEST(FindEnds, BranchEndsWhereTheNextPlaneDoesNotShowIt) {
    ContourSet set = stack({0, 4, 8}, ContourEnd::automatic);
    for (const double h : {0.0, 4.0}) {
        Contour branch = test::circle(make_plane(h * kNormal, kNormal), 3, 30);
        for (Vec3& p : branch.points) p += 30 * branch.plane.u;
        set.contours.push_back(branch);
    }
    set.contours[4].end = ContourEnd::flat;
    const Ends ends = find_ends(DrawnPlanes(set));
    EXPECT_GT(ends.lids.size(), 20u);
    for (const BoundaryPoint& point : ends.lids) {
        EXPECT_LT(norm(point.position - set.contours[4].plane.from_uv(30, 0)), 3.1);
        EXPECT_GE(dot(point.inplane_normal, kNormal), -1e-9);
    }
}

TEST(FindEnds, HolesStayOpen) {
    ContourSet set = stack({0, 4, 8}, ContourEnd::flat);
    set.contours.push_back(test::circle(set.contours[2].plane, 4, 30));
    set.contours[3].hole = true;
    for (const BoundaryPoint& point : find_ends(DrawnPlanes(set)).lids) EXPECT_GE(norm(point.position - 8 * kNormal), 3.99);
}

TEST(FindEnds, ABranchThatLeansAwayEndsAwayFromTheNextPlane) {
    ContourSet set = stack({0, 4}, ContourEnd::flat);
    for (Vec3& p : set.contours.back().points) p += 25 * set.contours.back().plane.u;
    const Ends ends = find_ends(DrawnPlanes(set));
    EXPECT_TRUE(ends.notes.empty());
    EXPECT_GT(ends.lids.size(), 60u);
    for (const BoundaryPoint& point : ends.lids)
        if (dot(point.position, kNormal) > 3.5) {
            EXPECT_GT(dot(point.inplane_normal, kNormal), 0.99);
        }
}

TEST(FindEnds, AThinRingGetsItsLid) {
    ContourSet set = stack({0, 4, 8}, ContourEnd::flat);
    for (const double h : {0.0, 4.0, 8.0}) {
        set.contours.push_back(test::circle(make_plane(h * kNormal, kNormal), 9.6, 60));
        set.contours.back().hole = true;
    }
    const Ends ends = find_ends(DrawnPlanes(set));
    EXPECT_TRUE(ends.notes.empty());
    std::size_t lid = 0;
    for (const BoundaryPoint& point : ends.lids) lid += dot(point.position, kNormal) > 7.99;
    EXPECT_GT(lid, 60u);
}

TEST(FindEnds, WhatCannotBeFollowedIsSaid) {
    ContourSet middle = stack({0, 8, 4}, ContourEnd::flat);
    EXPECT_TRUE(find_ends(DrawnPlanes(middle)).lids.empty());
    EXPECT_EQ(find_ends(DrawnPlanes(middle)).notes.at(0),
              "contour 3 ends the object, but contours on both sides carry it on; its end was ignored");
    EXPECT_EQ(find_ends(DrawnPlanes(stack({0}, ContourEnd::round))).notes.at(0),
              "contour 1 ends the object, but nothing says on which side it goes on; its end was ignored");
}

}  // namespace
}  // namespace kontur
