// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/prepare.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/contour_sets.h"
#include "support/polygons.h"

namespace kontur {
namespace {

TEST(Prepare, EveryPointCarriesItsContoursNormalsAndNumber) {
    const ContourSet set = test::three_circles();
    const PreparedContours prepared = prepare(set, {.least_segments = 0});
    ASSERT_EQ(prepared.points.size(), 60u);
    EXPECT_FALSE(prepared.coplanar);
    for (std::size_t i = 0; i < 60; ++i) {
        const Contour& contour = set.contours[i / 20];
        EXPECT_EQ(prepared.points[i].contour, static_cast<int>(i / 20));
        EXPECT_EQ(prepared.points[i].position, contour.points[i % 20]);
        EXPECT_EQ(prepared.points[i].plane_normal, contour.plane.normal);
        EXPECT_LT(distance(prepared.points[i].inplane_normal, (contour.points[i % 20] - contour.plane.origin) / 10), 1e-12);
    }
}

TEST(Prepare, CoplanarContoursGetAShiftedCopyOfTheFirstOnDemand) {
    const Plane plane = test::three_circles().contours[0].plane;
    ContourSet set;
    set.contours = {test::circle(plane, 10, 20), test::circle(plane, 4, 12)};
    set.contours[1].plane.normal = -plane.normal;  // the same plane, seen from its other side
    EXPECT_TRUE(prepare(set).coplanar);
    EXPECT_EQ(prepare(set, {.least_segments = 0}).points.size(), 32u);
    const PreparedContours prepared = prepare(set, {.least_segments = 0, .copy_shift_mm = 0.5});
    ASSERT_EQ(prepared.points.size(), 20u + 12u + 20u);
    for (std::size_t i = 0; i < 20; ++i)
        EXPECT_LT(distance(prepared.points[32 + i].position, set.contours[0].points[i] + 0.5 * plane.normal), 1e-12);
    EXPECT_EQ(prepare(test::three_circles(), {.least_segments = 0, .copy_shift_mm = 0.5}).points.size(), 60u);
}

TEST(Prepare, ReducesAndSubdividesBeforeItOrients) {
    EXPECT_EQ(prepare(test::three_circles(), {.quality = 0.5, .least_segments = 0}).points.size(), 30u);

    ContourSet set = test::three_circles();
    for (Contour& contour : set.contours) contour.points.resize(12);  // the other 8 of 20 leave a gap
    EXPECT_GT(prepare(set, {.least_segments = 0}).points.size(), 36u + 6u);
    EXPECT_GE(prepare(set).points.size(), 3u * 40u);
}

TEST(Prepare, ReducedLinesAreBordersWhereTheDrawnOnesAre) {
    ContourSet circles = test::three_circles();
    const PreparedContours apart = prepare(circles, {.quality = 0.3});
    for (const BoundaryPoint& point : apart.points) EXPECT_TRUE(point.on_ring && point.inplane_normal != Vec3{});

    const auto square = [](double left) {
        std::vector<test::Point2> points;
        for (int i = 0; i < 40; ++i) {
            const double along = 20 * (i % 10 / 10.0);
            const int side = i / 10;
            points.push_back({left + (side == 0   ? along
                                      : side == 1 ? 20
                                      : side == 2 ? 20 - along
                                                  : 0),
                              side == 0   ? 0
                              : side == 1 ? along
                              : side == 2 ? 20
                                          : 20 - along});
        }
        return test::contour_in(Plane{}, points);
    };
    ContourSet touching;
    touching.contours = {square(0), square(20)};
    for (const double quality : {1.0, 0.4})
        for (const BoundaryPoint& point : prepare(touching, {.quality = quality}).points)
            EXPECT_FALSE(std::abs(point.position.x - 20) < 0.1 && std::abs(point.position.y - 10) < 8)
                << "quality " << quality << ", y = " << point.position.y;
}

TEST(Prepare, FindsBoundsUnlessToldNotTo) {
    EXPECT_FALSE(prepare(test::three_circles()).bounds.empty());
    EXPECT_TRUE(prepare(test::three_circles(), {.bounds = false}).bounds.empty());
}

}  // namespace
}  // namespace kontur
