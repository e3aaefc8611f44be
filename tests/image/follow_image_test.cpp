// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/follow_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kontur/segment.h"
#include "support/drum.h"

namespace kontur {
namespace {

using namespace test;

TEST(FollowImage, MovesTheSurfaceBetweenContoursToTheBorderInTheImage) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    const FollowedImage r = follow_image_of(contours, image_of(cube_grid(1.5), body_look, 8));
    EXPECT_EQ(r.with_image.report.verdict, ImageVerdict::used);
    EXPECT_EQ(r.with_image.report.planes_left_out, 4U);
    EXPECT_LT(r.with_image.report.error_with_mm, 0.5 * r.with_image.report.error_without_mm);
    const double without = surface_error(r.plain.function, contours),
                 with = surface_error(r.with_image.fitted.function, contours);
    EXPECT_LT(with, 0.5 * without) << without << " mm without the image";
    EXPECT_LT(with, 0.45) << "a third of a voxel";
}

TEST(FollowImage, LeavesTheDrawnContoursWhereTheyAre) {
    const double voxel = 1.5;
    ContourSet contradictory = drawn_on(orthogonal_planes());
    for (Vec3& p : contradictory.contours[2].points) p += Vec3{0, 2, 0.5};  // within its plane
    for (const ContourSet& contours : {drawn_on(orthogonal_planes()), drawn_on(stacked_planes()), contradictory}) {
        const FollowedImage r = follow_image_of(contours, image_of(cube_grid(voxel), body_look, 8));
        ASSERT_EQ(r.with_image.report.verdict, ImageVerdict::used);
        double largest = 0;
        for (const Contour& contour : contours.contours)
            for (const Vec3& p : contour.points)
                largest = std::max(largest, std::abs(r.with_image.fitted.function.value(p) - r.plain.function.value(p)));
        EXPECT_LE(largest, 0.05 * voxel);
        EXPECT_NEAR(largest, r.with_image.report.on_contours_mm, 1e-9);
    }
}

TEST(FollowImage, IsNegativeFarFromTheDrawing) {
    const Image image = image_of(cube_grid(1.5), drum_look, 8);
    for (const std::vector<double>& heights : {std::vector{-21.0, -10.0, 0.0, 10.0, 21.0}, {-21.5, -7.0, 7.0, 21.5}}) {
        const FollowedImage r = follow_image_of(drawn_on(planes_across_z(heights), drum_depth), image);
        ASSERT_EQ(r.with_image.report.verdict, ImageVerdict::used);
        EXPECT_LT(highest_outside(r.with_image.fitted.function, drum_depth), 0) << heights.size() << " planes";
    }
}

TEST(FollowImage, GivesTheSameBytesForAnyNumberOfThreads) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    const Image image = image_of(cube_grid(2), body_look, 8);
    const FollowedImage one = follow_image_of(contours, image, 1), five = follow_image_of(contours, image, 5);
    const auto same = [](std::span<const double> a, std::span<const double> b) { return std::ranges::equal(a, b); };
    EXPECT_TRUE(same(one.with_image.fitted.function.weights(), five.with_image.fitted.function.weights()));
    EXPECT_EQ(one.with_image.report.error_with_mm, five.with_image.report.error_with_mm);
}

/// Begun at another point, turned round, and in another order, each contour in its own way.
ContourSet stored_otherwise(ContourSet set, std::size_t way) {
    for (std::size_t c = 0; c < set.contours.size(); ++c) {
        std::vector<Vec3>& points = set.contours[c].points;
        std::ranges::rotate(points, points.begin() + static_cast<std::ptrdiff_t>((1 + 17 * way + 31 * c) % points.size()));
        if ((way + c) % 2 == 0) std::ranges::reverse(points);
    }
    std::ranges::rotate(set.contours, set.contours.begin() + static_cast<std::ptrdiff_t>(way % set.contours.size()));
    if (way % 2 == 1) std::ranges::reverse(set.contours);
    return set;
}

TEST(FollowImage, GivesTheSameSurfaceHoweverADrawingIsStored) {
    const Image image = image_of(cube_grid(2), body_look, 8);
    for (const std::vector<Plane>& planes : {orthogonal_planes(), stacked_planes()}) {
        const ContourSet contours = drawn_on(planes);
        const FollowedImage first = follow_image_of(contours, image);
        ASSERT_EQ(first.with_image.report.verdict, ImageVerdict::used);
        const std::vector<Vec3> places = surface_points(first.with_image.fitted.function, contours);
        for (const std::size_t way : {0, 1, 2}) {
            const FollowedImage other = follow_image_of(stored_otherwise(contours, way), image);
            double most = 0;
            for (const Vec3& p : places)
                most = std::max(
                    most, std::abs(other.with_image.fitted.function.value(p) - first.with_image.fitted.function.value(p)));
            EXPECT_LT(most, 0.002) << "mm; way " << way << " of " << planes.size() << " planes";
            EXPECT_NEAR(other.with_image.report.weight, first.with_image.report.weight, 1e-4);
        }
    }
}

TEST(FollowImage, ReadsAsManyIntensitiesFromAnImageOfAnySize) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    const auto small = follow_image_of(contours, image_of(cube_grid(2), body_look)).with_image.report;
    const auto large = follow_image_of(contours, image_of(cube_grid(2, 96), body_look)).with_image.report;
    EXPECT_GT(small.intensities, 10'000);
    EXPECT_LT(small.intensities, 1'000'000);
    EXPECT_EQ(small.intensities, large.intensities);
}

TEST(FollowImage, SaysThatTooLittleIsDrawnToTell) {
    std::vector<Plane> planes = orthogonal_planes();
    planes.resize(2);
    const FollowedImage r = follow_image_of(drawn_on(planes), image_of(cube_grid(3), body_look));
    EXPECT_EQ(r.with_image.report.verdict, ImageVerdict::unknown);
    EXPECT_TRUE(std::ranges::equal(r.with_image.fitted.function.weights(), r.plain.function.weights()));
    EXPECT_NE(sentence(r.with_image.report).find("not used"), std::string::npos);
}

TEST(FollowImage, SegmentUsesTheImageUnlessToldNotTo) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    const Image image = image_of(cube_grid(2), body_look, 8);
    const Segmentation without = segment(contours, image.grid);
    const Segmentation off = segment(contours, image.grid, &image, {.use_image = UseImage::off});
    const Segmentation with = segment(contours, image.grid, &image);
    EXPECT_EQ(without.mask.values, off.mask.values);
    EXPECT_EQ(off.report.image.verdict, ImageVerdict::none);
    EXPECT_EQ(with.report.image.verdict, ImageVerdict::used);
    EXPECT_TRUE(off.report.image.shares.empty());
    EXPECT_GT(with.report.image.shares.size(), 100u);
    for (const ImageShare& place : with.report.image.shares) {
        EXPECT_NEAR(with.function.value(place.position), 0, 2.0) << "within a voxel";
        EXPECT_GE(place.share, 0);
        EXPECT_LE(place.share, 1);
    }
    EXPECT_GT(with.report.uncertainty.dice.value, without.report.uncertainty.dice.value);
    EXPECT_NE(without.mask.values, with.mask.values);
    const Image labels = image_of(image.grid, [](const Vec3& p) { return lobed_depth(p) > 0 ? 1.0 : 0.0; });
    const Segmentation alone = segment(contours, image.grid, &labels);
    EXPECT_EQ(alone.report.image.verdict, ImageVerdict::labels);
    EXPECT_EQ(alone.mask.values, without.mask.values);
    std::int64_t wrong_without = 0, wrong_with = 0;
    for (std::int64_t k = 0; k < image.grid.size.k; ++k)
        for (std::int64_t j = 0; j < image.grid.size.j; ++j)
            for (std::int64_t i = 0; i < image.grid.size.i; ++i) {
                const std::size_t at = image.grid.offset(i, j, k);
                const bool is_inside = lobed_depth(image.grid.center_mm(i, j, k)) > 0;
                wrong_without += is_inside != (without.mask.values[at] != 0);
                wrong_with += is_inside != (with.mask.values[at] != 0);
            }
    EXPECT_LT(wrong_with, wrong_without / 2);
}

}  // namespace
}  // namespace kontur
