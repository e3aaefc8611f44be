// SPDX-License-Identifier: Apache-2.0
#include "viewer/edits/carried_borders.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "viewer/drawn_contours.h"
#include "viewer/edits/contour_edits.h"

namespace kontur::viewer {
namespace {

/// A rectangle by hand, of which straight sides have no points between their ends.
DrawnContour rectangle(double left, double right, Id id) {
    std::vector<Vec3> points;
    for (const auto& [u, v] : {std::pair{left, -10.}, {right, -10.}, {right, 10.}, {left, 10.}})
        points.push_back(test::kPlane.from_uv(u, v));
    DrawnContour contour = as_drawn({test::kPlane, points, true, false});
    contour.id = contour.structure = id;
    return contour;
}

/// Where the line is farthest left (-1) or right (1) at this height over the plane's origin, from there.
double reach(const DrawnContour& contour, double v, int side) {
    double most = -1e9;
    for (std::size_t n = 0; n < contour.points.size(); ++n) {
        const auto [u, w] = contour.plane.to_uv(contour.points[n]);
        const auto [next_u, next_w] = contour.plane.to_uv(contour.points[(n + 1) % contour.points.size()]);
        if ((w < v) == (next_w < v)) continue;
        most = std::max(most, side * (u + (v - w) / (next_w - w) * (next_u - u)));
    }
    return side * most;
}

TEST(CarriedBorders, ANeighboursLineGoesWithTheBorderThatIsPulledOrRedrawn) {
    SliceEdges edges(test::flat_image());
    const DrawnContour left = rectangle(-12, 0, 1), right = rectangle(0.5, 12, 2);
    const Vec3 from = test::kPlane.from_uv(0, 0);
    for (const double by : {4.0, -4.0, 1.0}) {
        const DrawnContour pulled = pull(left, from, test::kPlane.from_uv(by, 0), 8, edges);
        const auto carried = carried_along(right, left, pulled, 1, edges);
        ASSERT_TRUE(carried) << by;
        EXPECT_NEAR(reach(pulled, 0.01, 1), by, 0.1);
        EXPECT_NEAR(reach(*carried, 0.01, -1), by + 0.5, 0.2) << by;
        EXPECT_NEAR(reach(*carried, 9, -1), 0.5, 1e-9) << "beyond the pull";
        EXPECT_NEAR(reach(*carried, 0.01, 1), 12, 1e-9) << "the other side";
        EXPECT_EQ(carried->id, 2);
    }
    std::vector<Vec3> path;
    for (const auto& [u, v] : {std::pair{0., -6.}, {3., -5.}, {3., 5.}, {0., 6.}})
        path.push_back(test::kPlane.from_uv(u, v));
    for (const bool turned : {false, true}) {
        if (turned) std::reverse(path.begin(), path.end());
        const auto carried = carried_along(right, left, redraw(left, path, edges), 1, edges);
        ASSERT_TRUE(carried);
        for (const double v : {-4.9, 0.0, 4.9}) EXPECT_NEAR(reach(*carried, v, -1), 3.5, 0.2) << v;
        EXPECT_NEAR(reach(*carried, 8, -1), 0.5, 1e-9);
    }
}

TEST(CarriedBorders, WhatIsFarFromTheLineStays) {
    SliceEdges edges(test::flat_image());
    const DrawnContour left = rectangle(-12, 0, 1);
    const DrawnContour pulled = pull(left, test::kPlane.from_uv(0, 0), test::kPlane.from_uv(4, 0), 8, edges);
    EXPECT_FALSE(carried_along(rectangle(2.1, 12, 2), left, pulled, 1, edges));
    EXPECT_FALSE(carried_along(rectangle(-14, -12.2, 2), left, pulled, 1, edges)) << "beside what has not changed";
    const auto half = carried_along(rectangle(1.5, 12, 2), left, pulled, 1, edges);
    ASSERT_TRUE(half);
    EXPECT_NEAR(reach(*half, 0.01, -1), 1.5 + 2, 0.2) << "half as far at one and a half times the distance";
}

TEST(CarriedBorders, AWholeContourThatIsMovedTakesTheLinesBesideItAlong) {
    SliceEdges edges(test::flat_image());
    const DrawnContour left = rectangle(-12, 0, 1), right = rectangle(0.5, 12, 2);
    const auto carried =
        carried_along(right, left, translate(left, test::kPlane.from_uv(2, 0) - test::kPlane.origin), 1, edges);
    ASSERT_TRUE(carried);
    EXPECT_NEAR(reach(*carried, 0, -1), 2.5, 0.1);
    EXPECT_NEAR(reach(*carried, 0, 1), 12, 1e-9);
}

TEST(CarriedBorders, PointsToDragStayWhereTheLineStays) {
    SliceEdges edges(test::flat_image());
    const DrawnContour left = rectangle(-12, 0, 1);
    std::vector<SketchPoint> sketch;
    for (const auto& [u, v] : {std::pair{0.5, -10.}, {12., -10.}, {12., 10.}, {0.5, 10.}})
        sketch.push_back({test::kPlane.from_uv(u, v), Stretch::line, {}});
    DrawnContour right = draw_contour(sketch, test::kPlane, edges, {.snap = false});
    const DrawnContour pulled = pull(left, test::kPlane.from_uv(0, 0), test::kPlane.from_uv(4, 0), 5, edges);
    const auto carried = carried_along(right, left, pulled, 1, edges);
    ASSERT_TRUE(carried);
    ASSERT_EQ(carried->control.size(), 4u);
    for (std::size_t n = 0; n < 4; ++n) EXPECT_EQ(carried->control[n].at, right.control[n].at);
    for (std::size_t n = 0; n < 3; ++n) EXPECT_EQ(carried->control[n].kind, Stretch::line);
    EXPECT_EQ(carried->control[3].kind, Stretch::free);
}

}  // namespace
}  // namespace kontur::viewer
