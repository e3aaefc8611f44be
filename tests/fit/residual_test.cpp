// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/residual.h"

#include <gtest/gtest.h>

#include "support/contour_sets.h"

namespace kontur {
namespace {

/// f(x) = slope * x, in mm, with the surface at x = 0.
ImplicitFunction plane_function(double slope) { return {Kernel::triharmonic, {}, {}, {}, {0, slope, 0, 0}}; }

TEST(Residual, IsTheDistanceInMillimetresWhateverTheSlope) {
    const ContourSet set = test::three_circles();
    double largest = 0, squares = 0;
    std::size_t worst = 0;
    for (std::size_t c = 0; c < 3; ++c)
        for (const Vec3& p : set.contours[c].points) {
            squares += p.x * p.x;
            if (std::abs(p.x) > largest) {
                largest = std::abs(p.x);
                worst = c;
            }
        }
    for (const double slope : {0.5, 1.0, 7.0}) {
        const Residual found = residual(plane_function(slope), set);
        EXPECT_NEAR(found.max_mm, largest, 1e-12);
        EXPECT_NEAR(found.rms_mm, std::sqrt(squares / 60), 1e-12);
        EXPECT_EQ(found.worst_contour, worst);
    }
}

TEST(Residual, BetweenPointsOnlyWhereTheyAreFarApart) {
    // A square and a triangle whose edges have their middles at known x; the surface is x = 0.
    const Plane plane = make_plane({}, {0, 0, 1}), other = make_plane({0, 0, 2}, {0, 0, 1});
    ContourSet set;
    set.contours = {{plane, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, true, false},
                    {other, {{0, 0, 2}, {6, 0, 2}, {6, 10, 2}}, true, false}};
    const Residual all = residual_between_points(plane_function(1), set, 0.1);
    EXPECT_NEAR(all.max_mm, 6, 1e-12);
    EXPECT_EQ(all.worst_contour, 1u);
    EXPECT_NEAR(all.rms_mm, std::sqrt((1 + 1 + 3 * 3 + 6 * 6 + 3 * 3) / 7.0), 1e-12)
        << "two edges of the square lie at 1, two at 0";
    EXPECT_NEAR(residual_between_points(plane_function(1), set, 11).max_mm, 3, 1e-12);
    EXPECT_EQ(residual_between_points(plane_function(1), set, 12).max_mm, 0);
    set.contours[1].closed = false;
    EXPECT_NEAR(residual_between_points(plane_function(1), set, 9).max_mm, 6, 1e-12) << "an open one has no edge back";
    EXPECT_EQ(residual_between_points(plane_function(1), set, 11).max_mm, 0);
}

TEST(Residual, LinesWithinTheObjectDoNotCount) {
    const Plane plane = make_plane({}, {0, 0, 1});
    ContourSet set;
    set.contours = {{plane, {{-1, -2, 0}, {1, -2, 0}, {3, -2, 0}, {3, 0, 0}, {3, 2, 0}, {-1, 2, 0}}, true, false},
                    {plane, {{3, -2, 0}, {7, -2, 0}, {7, 2, 0}, {3, 2, 0}, {3, 0, 0}}, true, false}};
    const double squares = 1 + 1 + 9 + 9 + 1 + 9 + 49 + 49 + 9;  // all but (3, 0), twice
    EXPECT_NEAR(residual(plane_function(1), set).rms_mm, std::sqrt(squares / 9), 1e-12);
    set.contours.resize(1);
    EXPECT_NEAR(residual(plane_function(1), set).rms_mm, std::sqrt(30.0 / 6), 1e-12) << "alone it is a border";
}

TEST(Residual, EdgesWithinTheObjectDoNotCount) {
    const Plane plane = make_plane({}, {0, 0, 1});
    ContourSet set;  // a channel that a keyhole's line follows to the hole and back
    set.contours = {{plane,
                     {{-9, -9, 0},
                      {0, -9, 0},
                      {0, -2, 0},
                      {-1, 0, 0},
                      {0, 1, 0},
                      {1, 0, 0},
                      {0, -2, 0},
                      {0, -9, 0},
                      {9, -9, 0},
                      {9, 9, 0},
                      {-9, 9, 0}},
                     true,
                     false}};
    const ImplicitFunction at_y = {Kernel::triharmonic, {}, {}, {}, {8, 0, 1, 0}};  // y = -8
    EXPECT_NEAR(residual_between_points(at_y, set, 6).max_mm, 17, 1e-12) << "the upper edge";
    set.contours[0].points[9].y = set.contours[0].points[10].y = -8.1;
    EXPECT_LT(residual_between_points(at_y, set, 6).max_mm, 2.4) << "the channel's middle is 2.5 off";
}

TEST(Residual, FlatFunctionIsNotInfinitelyFar) {
    const ContourSet set = test::three_circles();
    EXPECT_NEAR(residual(plane_function(0.01), set).max_mm, 0.1 * residual(plane_function(1), set).max_mm, 1e-12);
    EXPECT_EQ(residual(ImplicitFunction(), set).max_mm, 0);
    EXPECT_EQ(residual(plane_function(1), {}).rms_mm, 0);
}

}  // namespace
}  // namespace kontur
