// SPDX-License-Identifier: Apache-2.0
#include "kontur/sampling/spread_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/lobed_body.h"
#include "support/moved.h"

namespace kontur {
namespace {

using namespace test;

ImplicitFunction fitted_to(const ContourSet& contours) {
    const Drawing drawing = read_drawing(contours, FillRule::even_odd);
    const StageOptions stages = stage_options({}, drawing.diameter_mm());
    return fit(prepare(drawing, stages.prepare), stages.fit).function;
}

TEST(PointsOfSurface, LieBesideItByAFewPercentOfTheSpacingAndOnItAfterOneStep) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    const ImplicitFunction function = fitted_to(contours);
    constexpr double kSpacing = 3;
    std::vector<Vec3> points = points_of_surface(function, contours, kSpacing, {});
    EXPECT_GT(points.size(), 1000u);
    const auto farthest = [&] {
        double most = 0;
        for (const Vec3& p : points) most = std::max(most, std::abs(function.value(p)) / norm(function.gradient(p)));
        return most;
    };
    EXPECT_LT(farthest(), 0.1 * kSpacing);
    slide_to_surface(function, points, {.reach_mm = kSpacing}, {});
    EXPECT_LT(farthest(), 0.005 * kSpacing);
}

TEST(PointsOfSurface, TurnWithTheDrawing) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    const Affine3 motion = rigid_motion();
    const ContourSet there = moved(contours, motion);
    const std::vector<Vec3> points = points_of_surface(fitted_to(contours), contours, 3, {}),
                            turned = points_of_surface(fitted_to(there), there, 3, {});
    ASSERT_NEAR(static_cast<double>(turned.size()), static_cast<double>(points.size()), 3);
    for (const Vec3& p : turned) EXPECT_LT(nearest_distance(motion.inverse().apply(p), points), 0.1);
    const std::vector<Vec3> some = spread(points, 200, frame_of(contours)),
                            some_turned = spread(turned, 200, frame_of(there));
    std::size_t same = 0;
    for (const Vec3& p : some_turned) same += nearest_distance(motion.inverse().apply(p), some) < 0.1;
    EXPECT_GT(same, 190u);
}

TEST(PointsOfSurface, OfNothingAreNone) { EXPECT_TRUE(points_of_surface({}, {}, 3, {}).empty()); }

TEST(Spread, KeepsAboutAsManyAsAskedForAndLeavesNoPlaceOut) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    const std::vector<Vec3> points = points_of_surface(fitted_to(contours), contours, 2, {});
    const std::vector<Vec3> some = spread(points, 300, frame_of(contours));
    EXPECT_NEAR(static_cast<double>(some.size()), 300, 20);
    for (const Vec3& p : points) EXPECT_LT(nearest_distance(p, some), 14);
    EXPECT_EQ(spread(points, points.size(), {}), points);
}

TEST(Spread, EndsWherePointsAreInOnePlace) {
    std::vector<Vec3> points;
    for (int n = 0; n < 3000; ++n) points.push_back({1.0 * (n % 10), 1.0 * (n / 10 % 10), 0});
    EXPECT_EQ(spread(points, 450, {}).size(), 100u) << "each place once";
    EXPECT_GE(spread(points, 90, {}).size(), 50u);
    EXPECT_LE(spread(points, 90, {}).size(), 100u);
    EXPECT_GE(spread(points, 1, {}).size(), 1u);
    EXPECT_EQ(spread(std::vector<Vec3>(20, Vec3{1, 2, 3}), 7, {}).size(), 1u);
}

}  // namespace
}  // namespace kontur
