// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/corners.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kontur/fit/prepare.h"
#include "kontur/segment.h"
#include "support/contour_sets.h"
#include "support/polygons.h"

namespace kontur {
namespace {

const Plane kAxial = make_plane({0, 0, 3}, {0, 0, 1});

Contour square() { return test::contour_in(kAxial, std::vector<test::Point2>{{-20, -20}, {20, -20}, {20, 20}, {-20, 20}}); }

/// Largest distance of points on the drawn line from the surface within the contour's plane, to first order.
double farthest_from_surface(const ImplicitFunction& function, const Contour& contour) {
    double farthest = 0;
    const std::size_t n = contour.points.size();
    for (std::size_t i = 0; i < n; ++i)
        for (int step = 0; step < 100; ++step) {
            const Vec3 p = contour.points[i] + (step + 0.5) / 100 * (contour.points[(i + 1) % n] - contour.points[i]);
            const Vec3 gradient = function.gradient(p);
            farthest = std::max(farthest, std::abs(function.value(p)) / std::max(std::hypot(gradient.x, gradient.y), 0.2));
        }
    return farthest;
}

TEST(Corners, AreWhereTheLineTurnsByThirtyDegrees) {
    EXPECT_EQ(find_corners(square()), std::vector<bool>(4, true));
    EXPECT_EQ(find_corners(test::circle(kAxial, 20, 60)), std::vector<bool>(60, false)) << "6 degrees each";
    Contour open = square();
    open.closed = false;
    EXPECT_EQ(find_corners(open), std::vector<bool>(4, false));
    const Contour bent = test::contour_in(kAxial, std::vector<test::Point2>{{0, 0}, {10, -1}, {20, 0}, {10, 30}});
    EXPECT_EQ(find_corners(bent), (std::vector<bool>{true, false, true, true})) << "11 degrees are no corner";
}

TEST(Corners, PointsGrowDenseTowardsThemAndStayOnTheEdges) {
    const Contour subdivided = subdivide_to_corners(square(), std::vector<bool>(4, true), 0.05, 4);
    const std::size_t n = subdivided.points.size();
    EXPECT_EQ(n % 4, 0u);
    for (std::size_t side = 0; side < 4; ++side) EXPECT_EQ(subdivided.points[side * n / 4], square().points[side]);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3& p = subdivided.points[i];
        EXPECT_NEAR(std::max(std::abs(p.x), std::abs(p.y)), 20, 1e-12);
        const double step = distance(p, subdivided.points[(i + 1) % n]);
        EXPECT_LE(step, 4 * 1.75);
        EXPECT_GE(step, 0.05 / 4);
        double to_corner = 100;
        for (const Vec3& corner : square().points) to_corner = std::min(to_corner, distance(p, corner));
        EXPECT_LE(step, std::max(0.05, 1.3 * to_corner) + 1e-12);
    }
    const Contour circle = test::circle(kAxial, 20, 60);
    EXPECT_EQ(subdivide_to_corners(circle, find_corners(circle), 0.05, 4).points, circle.points);
}

TEST(Corners, TheirPointsHaveNoNormalAndThoseBesideThemTheirEdges) {
    ContourSet set{"", {square()}, {}, {}};
    const PreparedContours prepared = prepare(set, {.corners = Corners::faithful, .corner_spacing_mm = 0.05});
    int without = 0;
    for (const BoundaryPoint& p : prepared.points) {
        if (p.inplane_normal == Vec3{}) {
            ++without;
            continue;
        }
        const Vec3 edge = std::abs(p.position.x) > std::abs(p.position.y) ? Vec3{std::copysign(1, p.position.x), 0, 0}
                                                                          : Vec3{0, std::copysign(1, p.position.y), 0};
        EXPECT_LT(distance(p.inplane_normal, edge), 1e-6);
    }
    EXPECT_EQ(without, 4);
}

TEST(Corners, ASquareStaysASquareAndANotchANotch) {
    const Contour notched =
        test::contour_in(kAxial, std::vector<test::Point2>{{-20, -20}, {20, -20}, {20, 0}, {0, 0}, {0, 20}, {-20, 20}});
    const Grid grid{{60, 60, 60}, {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {-30, -30, -27}}};
    for (const Contour& contour : {square(), notched}) {
        SegmentOptions options;
        const ContourSet set{"", {contour}, {}, {}};
        const double rounded = farthest_from_surface(segment(set, grid, options).function, contour);
        options.corners = Corners::faithful;
        const Segmentation result = segment(set, grid, options);
        EXPECT_LT(farthest_from_surface(result.function, contour), 0.1);
        EXPECT_GT(rounded, 0.3);
        EXPECT_EQ(result.report.corners, Corners::faithful);
        EXPECT_LT(result.report.iterations, 25 * result.report.solves);
    }
}

// Smoothed fits of such sharp tips have sheets that the last one does not have; nothing of them may stay.
TEST(Corners, StackedStarsKeepTheirTips) {
    std::vector<test::Point2> star;
    for (int i = 0; i < 10; ++i) {
        const double angle = std::numbers::pi * (0.5 + i / 5.0);
        const double radius = i % 2 == 0 ? 30 : 30 * std::sin(0.1 * std::numbers::pi) / std::sin(0.7 * std::numbers::pi);
        star.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    ContourSet set;
    for (int i = 0; i < 5; ++i) set.contours.push_back(test::contour_in(make_plane({0, 0, 5.0 * i}, {0, 0, 1}), star));
    SegmentOptions options;
    options.corners = Corners::faithful;
    const Segmentation result = segment(set, grid_around(bounding_box(set), {2, 2, 2}, 8), options);
    EXPECT_LT(result.report.residual.max_mm, 0.4);
    EXPECT_LT(result.report.bounded, 400u);
}

}  // namespace
}  // namespace kontur
