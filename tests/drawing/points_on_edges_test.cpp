// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/points_on_edges.h"

#include <gtest/gtest.h>

#include "support/contour_sets.h"

namespace kontur {
namespace {

Contour path(std::vector<Vec3> points, bool closed) {
    Contour contour;
    contour.plane = make_plane({}, {0, 0, 1});
    contour.points = std::move(points);
    contour.closed = closed;
    return contour;
}

TEST(PointsOnEdges, LeavesTheCornersOfASquare) {
    const std::vector<Vec3> corners{{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}};
    std::vector<Vec3> points;
    for (std::size_t c = 0; c < 4; ++c)
        for (const double part : {0.0, 0.25, 0.3, 0.9})
            points.push_back(corners[c] + part * (corners[(c + 1) % 4] - corners[c]));
    EXPECT_EQ(without_points_on_edges(path(points, true), 1e-6).points, corners);
    points.push_back(corners[0]);
    std::vector<Vec3> way = corners;
    way.push_back(corners[0]);
    EXPECT_EQ(without_points_on_edges(path(points, false), 1e-6).points, way);
}

TEST(PointsOnEdges, StayWhereTheLineTurnsOrRunsBack) {
    for (const std::vector<Vec3>& points :
         {std::vector<Vec3>{{0, 0, 0}, {4, 0.01, 0}, {8, 0, 0}, {4, 8, 0}}, {{0, 0, 0}, {8, 0, 0}, {5, 0, 0}, {5, 8, 0}}})
        EXPECT_EQ(without_points_on_edges(path(points, true), 1e-3).points, points);
    const Contour line = path({{0, 0, 0}, {4, 0, 0}, {8, 0, 0}}, true);
    EXPECT_EQ(without_points_on_edges(line, 1e-3).points, line.points) << "a ring has three points";
}

/// Walked for each of its points, an edge would take hours.
TEST(PointsOnEdges, AMillionOnOneEdgeAreLeftOut) {
    std::vector<Vec3> points{{0, 0, 0}};
    for (int n = 1; n <= 1'000'000; ++n) points.push_back({8e-6 * n, 0, 0});
    const std::vector<Vec3> corners{{0, 0, 0}, points.back(), {8, 8, 0}};
    points.push_back(corners.back());
    EXPECT_EQ(without_points_on_edges(path(points, true), 1e-6).points, corners);
}

TEST(PointsOnEdges, AManySidedCircleKeepsItsShape) {
    const Contour circle = test::circle(make_plane({}, {0, 0, 1}), 50, 100'000);
    const Contour kept = without_points_on_edges(circle, 1e-3);
    EXPECT_LT(kept.points.size(), 2000u);
    for (std::size_t i = 0; i < kept.points.size(); ++i) {
        const Vec3 middle = 0.5 * (kept.points[i] + kept.points[(i + 1) % kept.points.size()]);
        EXPECT_NEAR(norm(middle), 50, 2.1e-3);
    }
}

}  // namespace
}  // namespace kontur
