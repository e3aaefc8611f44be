// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/slice_contours.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kontur/extract/rasterize.h"
#include "kontur/extract/track.h"
#include "kontur/extract/voxelize.h"
#include "support/expect_error.h"
#include "support/functions.h"
#include "support/random.h"

namespace kontur {
namespace {

Mask mask_of(const ImplicitFunction& function, const Grid& grid) {
    return fill(sample_everywhere(function, grid, {.threads = 0}));
}

/// Largest |f| over the points: how far off the surface they are in mm, up to the slope.
double worst_value(const ContourSet& set, const ImplicitFunction& function) {
    double worst = 0;
    for (const Contour& contour : set.contours)
        for (const Vec3& p : contour.points) worst = std::max(worst, std::abs(function.value(p)));
    return worst;
}

class SliceContours : public testing::TestWithParam<Affine3> {};

TEST_P(SliceContours, OfABallAreCirclesOnEverySliceItMeets) {
    const Vec3 center{12, -7, 5};
    const ImplicitFunction ball = test::ball_function(center, 10);
    const Grid grid = test::changed(test::grid_about(center, {31, 30, 29}, 1.1), GetParam());
    const Mask mask = mask_of(ball, grid);
    const ContourSet set = slice_contours(mask, ball);
    ASSERT_GT(set.contours.size(), 10u);
    for (const Contour& contour : set.contours) {
        EXPECT_FALSE(contour.hole);
        for (const Vec3& p : contour.points) {
            EXPECT_NEAR(distance(p, center), 10, 1e-6);
            EXPECT_NEAR(contour.plane.distance_to(p), 0, 1e-9);
        }
    }
    EXPECT_NO_THROW(check_contours(set));
}

TEST_P(SliceContours, EncloseExactlyTheVoxelsOfTheMask) {
    std::mt19937 random = test::random_of_this_test();
    std::ptrdiff_t holes = 0;
    for (int round = 0; round < 6; ++round) {
        const ImplicitFunction rough = test::rough_function(20, random);
        const Grid grid = test::changed(test::grid_about({10, 10, 10}, {24, 22, 9}, 0.7), GetParam());
        const Mask mask = mask_of(rough, grid);
        const ContourSet set = slice_contours(mask, rough);
        holes += std::count_if(set.contours.begin(), set.contours.end(), [](const Contour& c) { return c.hole; });
        const std::vector<std::uint8_t> again = rasterize(set, grid).values;
        EXPECT_TRUE(again == mask.values) << "also where the grid cuts the object off";
    }
    EXPECT_GT(holes, 0);
}

INSTANTIATE_TEST_SUITE_P(Grids, SliceContours, testing::Values(Affine3{}, test::kOblique, test::kSheared, test::kMirrored));

TEST(SliceContours, LieOnTheSurfaceOfASolvedFunction) {
    const ImplicitFunction torus = test::function_through(test::torus({}, 12, 5, 16));
    const Mask mask = mask_of(torus, test::grid_about({}, {50, 50, 16}, 0.8));
    const ContourSet set = slice_contours(mask, torus);
    EXPECT_EQ(std::count_if(set.contours.begin(), set.contours.end(), [](const Contour& c) { return c.hole; }),
              static_cast<std::ptrdiff_t>(set.contours.size() / 2))
        << "a ring has one outer and one inner line on each slice";
    EXPECT_LT(worst_value(set, torus), 1e-5);
}

TEST(SliceContours, EndHalfAVoxelBeyondTheGridsBorderWithoutRepeatedPoints) {
    const Grid grid = test::grid_about({}, {12, 13, 5}, 1);
    for (const double x : {0.0, 45.4}) {  // the grid within the ball; the grid's last column alone in it
        const ImplicitFunction ball = test::ball_function({x, 0, 0}, 40);
        const Mask mask = mask_of(ball, grid);
        ContourSet set = slice_contours(mask, ball);
        ASSERT_EQ(set.contours.size(), 5u);
        EXPECT_EQ(drop_duplicate_points(set), 0u);
        EXPECT_DOUBLE_EQ(bounding_box(set).max.x, 6);
        EXPECT_EQ(rasterize(set, grid).values, mask.values);
    }
}

TEST(SliceContours, AreTheSameForAnyNumberOfThreads) {
    const ImplicitFunction ball = test::ball_function({}, 10);
    const Mask mask = mask_of(ball, test::grid_about({}, {30, 30, 70}, 0.9));
    const ContourSet one = slice_contours(mask, ball, {.threads = 1}), three = slice_contours(mask, ball, {.threads = 3});
    ASSERT_EQ(one.contours.size(), three.contours.size());
    for (std::size_t n = 0; n < one.contours.size(); ++n) EXPECT_EQ(one.contours[n].points, three.contours[n].points);
}

TEST(SliceContours, RefuseAMaskThatContradictsItsGrid) {
    Mask mask{test::grid_about({}, {3, 3, 3}, 1), std::vector<std::uint8_t>(26)};
    EXPECT_KONTUR_ERROR(slice_contours(mask, {}), ErrorKind::invalid_input, "26 values for a grid of 27 voxels");
}

}  // namespace
}  // namespace kontur
