// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/inner_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kontur/drawing/orient.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

const Plane kPlane = make_plane({5, -3, 2}, {0.3, -0.5, 0.8});

/// A rectangle from (x, y) on, a point every mm.
Contour box(double x, double y, double width, double height) {
    Contour contour{kPlane, {}, true, false};
    const auto along = [&](double u, double v, double du, double dv, double length) {
        for (int i = 0; i < static_cast<int>(length); ++i) contour.points.push_back(kPlane.from_uv(u + i * du, v + i * dv));
    };
    along(x, y, 1, 0, width);
    along(x + width, y, 0, 1, height);
    along(x + width, y + height, -1, 0, width);
    along(x, y + height, 0, -1, height);
    return contour;
}

/// The points of all lines that stay.
std::vector<BoundaryPoint> borders(const ContourSet& set, double cleft_mm = 0.05) {
    std::vector<BoundaryPoint> points;
    for (std::size_t c = 0; c < set.contours.size(); ++c) {
        const ContourOrientation orientation = orient(set.contours[c]);
        for (std::size_t i = 0; i < set.contours[c].points.size(); ++i)
            points.push_back({.position = set.contours[c].points[i],
                              .inplane_normal = orientation.normals[i],
                              .plane_normal = kPlane.normal,
                              .contour = static_cast<std::int32_t>(c),
                              .on_ring = true});
    }
    leave_out_inner_lines(DrawnPlanes(set), cleft_mm, points);
    return points;
}

ContourSet of(std::initializer_list<Contour> contours) {
    ContourSet set;
    set.contours = contours;
    return set;
}

double across(const BoundaryPoint& point) { return kPlane.to_uv(point.position)[0]; }

TEST(InnerLines, ALineThatLiesInNoOtherStaysAsItIs) {
    const ContourSet set = of({box(0, 0, 20, 10), box(25, 0, 20, 10), test::circle(kPlane, 40, 100)});
    ContourSet ring = set;
    ring.contours[0].hole = ring.contours[1].hole = true;
    for (Vec3& p : ring.contours[2].points) p += 20 * kPlane.u;
    const std::vector<BoundaryPoint> kept = borders(ring);
    EXPECT_EQ(kept.size(), 60u + 60u + 100u);
    for (const BoundaryPoint& point : kept) EXPECT_TRUE(point.on_ring && point.inplane_normal != Vec3{} && point.line == 0);
}

TEST(InnerLines, OpenLinesAndSinglePointsStay) {
    const ContourSet set = of({box(0, 0, 20, 10)});
    std::vector<BoundaryPoint> points(3, {.position = kPlane.from_uv(5, 5), .inplane_normal = kPlane.u});
    points[1].contour = points[2].contour = kNoContour;
    leave_out_inner_lines(DrawnPlanes(set), 0.05, points);
    EXPECT_EQ(points.size(), 3u);
}

TEST(InnerLines, AnEdgeInCommonIsNoBorder) {
    const std::vector<BoundaryPoint> kept = borders(of({box(0, 0, 20, 10), box(20, 0, 20, 10)}));
    EXPECT_EQ(kept.size(), 2u * (60 - 9));
    for (const BoundaryPoint& point : kept) {
        const Point2 at = kPlane.to_uv(point.position);
        EXPECT_TRUE(std::abs(at[0] - 20) > 0.5 || at[1] < 0.5 || at[1] > 9.5) << at[0] << ", " << at[1];
        EXPECT_FALSE(point.on_ring);
        if (std::abs(at[0] - 20) < 0.5) {
            EXPECT_EQ(point.inplane_normal, Vec3{}) << "where the border turns onto the other line";
        }
    }
}

TEST(InnerLines, ACleftIsOneOnlyWhereItIsWideEnough) {
    EXPECT_EQ(borders(of({box(0, 0, 20, 10), box(20.03, 0, 20, 10)})).size(), 2u * (60 - 9));
    EXPECT_EQ(borders(of({box(0, 0, 20, 10), box(20.2, 0, 20, 10)})).size(), 2u * 60);
}

TEST(InnerLines, WallsThinnerThanACleftStay) {
    ContourSet ring = of({box(0, 0, 20, 10), box(1, 1, 18, 8)});
    ring.contours[1].hole = true;
    EXPECT_EQ(borders(ring, 3).size(), 60u + 52u);
}

TEST(InnerLines, OverlapsAreUnitedIntoOpenLines) {
    const std::vector<BoundaryPoint> kept = borders(of({box(0, 0, 20, 10), box(15, 3, 20, 4)}));
    std::set<std::pair<std::int32_t, std::int32_t>> lines;
    for (const BoundaryPoint& point : kept) {
        lines.insert({point.contour, point.line});
        EXPECT_TRUE(point.contour == 0 ? across(point) < 20.5 : across(point) > 19.5);
    }
    EXPECT_EQ(lines.size(), 2u);
}

TEST(InnerLines, AHoleBeyondTheObjectHasNoBorderThere) {
    ContourSet set = of({box(0, 0, 20, 10), box(15, 3, 20, 4)});
    set.contours[1].hole = true;
    for (const BoundaryPoint& point : borders(set)) EXPECT_LT(across(point), 20.5);
}

TEST(InnerLines, TheTwoSidesOfAKeyholesChannelAreNoBorder) {
    Contour contour{kPlane, {}, true, false};
    for (const Point2& p : std::initializer_list<Point2>{{0, 0},
                                                         {5, 0},
                                                         {10, 0},
                                                         {10, 2},
                                                         {10, 4},
                                                         {8, 4},
                                                         {8, 6},
                                                         {12, 6},
                                                         {12, 4},
                                                         {10, 4},
                                                         {10, 2},
                                                         {10, 0},
                                                         {15, 0},
                                                         {20, 0},
                                                         {20, 10},
                                                         {0, 10}})
        contour.points.push_back(kPlane.from_uv(p));
    for (const BoundaryPoint& point : borders(of({contour}))) EXPECT_NE(kPlane.to_uv(point.position)[1], 2);
}

}  // namespace
}  // namespace kontur
