// SPDX-License-Identifier: Apache-2.0
// The surface of a walk on the image's voxels, as one function through the contours.
#include <gtest/gtest.h>

#include <cmath>

#include "support/horned_body.h"

namespace kontur {
namespace {

using namespace test;

TEST(WalkSurface, GrowsAHornOfWhichContoursShowTheFoot) {
    const ContourSet contours = drawn_horns();
    const Grid grid = cube_grid(1.5);
    const FollowedImage r = follow_image_of(contours, image_of(grid, horned_look, 8));
    ASSERT_EQ(r.with_image.report.verdict, ImageVerdict::used);
    EXPECT_TRUE(r.with_image.report.walked);
    EXPECT_LT(r.with_image.report.wrong_with, 0.7 * r.with_image.report.wrong_without);
    const double without = wrong_share(r.plain.function, grid, horned_depth),
                 with = wrong_share(r.with_image.fitted.function, grid, horned_depth);
    EXPECT_LT(with, 0.7 * without) << without << " without the image";
    EXPECT_GT(r.with_image.report.largest_move_mm, 5) << "along the horns";
    EXPECT_NE(sentence(r.with_image.report).find("voxel by voxel"), std::string::npos) << sentence(r.with_image.report);
}

TEST(WalkSurface, LeavesDrawnPlanesAsTheyWere) {
    const double voxel = 1.5;
    const ContourSet contours = drawn_horns();
    const FollowedImage r = follow_image_of(contours, image_of(cube_grid(voxel), horned_look, 8));
    ASSERT_TRUE(r.with_image.report.walked);
    EXPECT_LE(r.with_image.report.on_contours_mm, 0.05 * voxel);
    for (const Plane& plane : planes_of_horns())
        for (int s = -30; s <= 30; ++s)
            for (int t = -30; t <= 30; ++t) {
                const Vec3 p = plane.from_uv(voxel * s, voxel * t);
                const double before = r.plain.function.value(p), after = r.with_image.fitted.function.value(p);
                if (surface_distance(horned_depth, p) < 1.5 * voxel) continue;
                EXPECT_EQ(before > 0, after > 0) << p.x << ' ' << p.y << ' ' << p.z;
            }
}

/// A wavy tube of 4 mm that bends, along z.
double tube_depth(const Vec3& p) {
    const double t = p.z / 40;
    const Vec3 axis{10 * std::sin(2.5 * t), 10 * std::cos(2 * t) - 10, p.z};
    return std::abs(p.z) > 45 ? -5.0 : 4 + std::sin(p.z / 6) - norm(p - axis);
}

// Lines that waver contradict the image beside them. The contours would change then, were they not kept.
TEST(WalkSurface, IsFollowedBesideAnUnsteadyHand) {
    ContourSet contours = cut({make_plane({0, 0, -40.25}, {0, 0, 1}), make_plane({0, 0, -0.25}, {0, 0, 1}),
                               make_plane({0, 0, 39.75}, {0, 0, 1}), make_plane({0.3, 0, 0}, {1, 0, 0})},
                              tube_depth);
    for (Contour& contour : contours.contours)
        for (std::size_t i = 0; i < contour.points.size(); ++i)
            contour.points[i] += 0.7 * std::sin(0.9 * static_cast<double>(i)) * contour.plane.u;
    const double voxel = 1.5;
    const Grid grid = cube_grid(voxel);
    const FollowedImage r =
        follow_image_of(contours, image_of(
                                      grid, [](const Vec3& p) { return two_tissues(tube_depth(p)); }, 8));
    EXPECT_TRUE(r.with_image.report.walked);
    EXPECT_LE(r.with_image.report.on_contours_mm, 0.05 * voxel);
    const double without = wrong_share(r.plain.function, grid, tube_depth),
                 with = wrong_share(r.with_image.fitted.function, grid, tube_depth);
    EXPECT_LT(with, 0.75 * without) << without << " without the image";
}

TEST(WalkSurface, IsTheSameForAnyNumberOfThreads) {
    const ContourSet contours = drawn_horns();
    const Image image = image_of(cube_grid(2), horned_look, 8);
    const FollowedImage one = follow_image_of(contours, image, 1), four = follow_image_of(contours, image, 4);
    ASSERT_TRUE(one.with_image.report.walked);
    EXPECT_TRUE(std::ranges::equal(one.with_image.fitted.function.weights(), four.with_image.fitted.function.weights()));
    EXPECT_EQ(one.with_image.report.wrong_with, four.with_image.report.wrong_with);
}

TEST(WalkSurface, IsNotFollowedWhereTheImageLiesBesideTheDrawing) {
    const ContourSet contours = drawn_horns();
    for (const Vec3 shift : {Vec3{12, 8, 0}, Vec3{0, -10, 9}}) {
        const FollowedImage r =
            follow_image_of(contours, image_of(
                                          cube_grid(2), [&](const Vec3& p) { return horned_look(p + shift); }, 8));
        EXPECT_FALSE(r.with_image.report.walked);
    }
}

}  // namespace
}  // namespace kontur
