// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/subdivide.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/contour_sets.h"
#include "support/polygons.h"
#include "support/random.h"
#include "support/subsequence.h"

namespace kontur {
namespace {

using test::is_subsequence;
using test::Point2;

const Plane kTilted = make_plane({30, -20, 100}, {0.3, -0.5, 0.8});

double average_segment(const std::vector<Vec3>& points) {
    double total = 0;
    for (std::size_t i = 0; i < points.size(); ++i) total += distance(points[i], points[(i + 1) % points.size()]);
    return total / static_cast<double>(points.size());
}

TEST(Subdivide, LeavesNoSegmentLongerThanTwiceTheAverage) {
    std::mt19937 random = test::random_of_this_test();
    for (int round = 0; round < 40; ++round) {
        Contour uneven = test::contour_in(kTilted, test::random_star(60, random));
        uneven.points.erase(uneven.points.begin() + 2, uneven.points.begin() + 20);
        const double average = average_segment(uneven.points);
        const Contour subdivided = subdivide(uneven);
        EXPECT_TRUE(is_subsequence(uneven.points, subdivided.points));
        EXPECT_GT(subdivided.points.size(), uneven.points.size());
        for (std::size_t i = 0; i < subdivided.points.size(); ++i)
            EXPECT_LE(distance(subdivided.points[i], subdivided.points[(i + 1) % subdivided.points.size()]), 2 * average);
    }
}

TEST(Subdivide, DividesALongSideIntoEqualPieces) {
    // Nine sides of 1 and one of 9: the average is 1.8.
    std::vector<Point2> points{{0, 0}, {9, 0}};
    for (int i = 1; i < 9; ++i) points.push_back({9.0 - i, i % 2 ? 1e-3 : -1e-3});
    const Contour subdivided = subdivide(test::contour_in(Plane{}, points));
    ASSERT_EQ(subdivided.points.size(), 10u + 4u);
    for (std::size_t i = 0; i < 5; ++i)
        EXPECT_LT(distance(subdivided.points[i], {1.8 * static_cast<double>(i), 0, 0}), 1e-12);
}

TEST(Subdivide, SquareOfFourCornersIsSubdividedOnlyWhereThatIsAskedFor) {
    const Contour square = test::contour_in(kTilted, std::vector<Point2>{{0, 0}, {10, 0}, {10, 10}, {0, 10}});
    EXPECT_EQ(subdivide(square).points, square.points) << "all its sides are average";
    const Contour subdivided = subdivide(square, 48);
    ASSERT_EQ(subdivided.points.size(), 48u);
    EXPECT_TRUE(is_subsequence(square.points, subdivided.points));
    for (std::size_t i = 0; i < 48; ++i)
        EXPECT_NEAR(distance(subdivided.points[i], subdivided.points[(i + 1) % 48]), 10.0 / 12, 1e-12);
    const Contour circle = test::circle(kTilted, 10, 60);
    EXPECT_EQ(subdivide(circle, 48).points, circle.points) << "it has more segments already";
}

}  // namespace
}  // namespace kontur
