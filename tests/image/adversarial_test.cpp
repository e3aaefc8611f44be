// SPDX-License-Identifier: Apache-2.0
// Images that mislead, or that lie oddly: what they have to say is used where it holds, and nothing else.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "support/lobed_body.h"
#include "support/moved.h"

namespace kontur {
namespace {

using namespace test;

/// Largest difference of two functions on a lattice about the body.
double largest_difference(const ImplicitFunction& a, const ImplicitFunction& b) {
    double largest = 0;
    for (int x = -3; x <= 3; ++x)
        for (int y = -3; y <= 3; ++y)
            for (int z = -3; z <= 3; ++z) {
                const Vec3 p{11.0 * x, 11.0 * y, 11.0 * z};
                largest = std::max(largest, std::abs(a.value(p) - b.value(p)));
            }
    return largest;
}

TEST(FollowImageAdversarial, AnImageOfOneValueChangesNothing) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    const Image image = image_of(cube_grid(2), [](const Vec3&) { return 7.0; });
    const FollowedImage r = follow_image_of(contours, image);
    EXPECT_EQ(r.with_image.report.verdict, ImageVerdict::labels) << "as a grid that was written as an image is";
    EXPECT_EQ(largest_difference(r.with_image.fitted.function, r.plain.function), 0);
}

TEST(FollowImageAdversarial, NoiseAloneIsNotFollowed) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    const FollowedImage r = follow_image_of(contours, image_of(
                                                          cube_grid(2), [](const Vec3&) { return 0.0; }, 10));
    EXPECT_EQ(r.with_image.report.verdict, ImageVerdict::no_help);
    EXPECT_TRUE(std::ranges::equal(r.with_image.fitted.function.weights(), r.plain.function.weights()));
}

TEST(FollowImageAdversarial, ImageShiftedDifferentlyAtEachPlaneIsNotFollowed) {
    const ContourSet contours = drawn_on(stacked_planes());
    // Every drawn plane's neighbourhood is shifted by another 6 mm.
    const Look shifted = [](const Vec3& p) {
        const double slab = std::floor((p.z + 26) / 10.3);
        return body_look(p + 6.0 * Vec3{std::cos(2.4 * slab), std::sin(2.4 * slab), 0});
    };
    const FollowedImage r = follow_image_of(contours, image_of(cube_grid(1.5), shifted, 8));
    EXPECT_EQ(r.with_image.report.verdict, ImageVerdict::no_help);
    EXPECT_TRUE(std::ranges::equal(r.with_image.fitted.function.weights(), r.plain.function.weights()));
    // The same image, not shifted, helps: it is the shifts that are seen.
    const FollowedImage straight = follow_image_of(contours, image_of(cube_grid(1.5), body_look, 8));
    EXPECT_EQ(straight.with_image.report.verdict, ImageVerdict::used);
}

TEST(FollowImageAdversarial, InvertedAndScaledIntensitiesSayTheSame) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    const Image image = image_of(cube_grid(2), body_look, 8);
    const auto changed = [&](double factor, double offset) {
        Image other = image;
        for (float& v : std::get<std::vector<float>>(other.samples)) v = static_cast<float>(factor * v + offset);
        return follow_image_of(contours, other);
    };
    const FollowedImage as_is = follow_image_of(contours, image);
    ASSERT_EQ(as_is.with_image.report.verdict, ImageVerdict::used);
    for (const auto& [factor, offset] : {std::pair{-1.0, 0.0}, {1000.0, 0.0}, {0.5, -300.0}}) {
        const FollowedImage other = changed(factor, offset);
        EXPECT_NEAR(other.with_image.report.error_with_mm, as_is.with_image.report.error_with_mm, 1e-3);
        EXPECT_LT(largest_difference(other.with_image.fitted.function, as_is.with_image.fitted.function), 0.02) << factor;
    }
}

TEST(FollowImageAdversarial, ImageThatEndsInsideTheObjectHelpsAsFarAsItGoes) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    constexpr double kEnd = 4;
    const Grid half = grid_around({{-48, -48, -48}, {48, 48, kEnd}}, {1.5, 1.5, 1.5}, 0);
    const FollowedImage r = follow_image_of(contours, image_of(half, body_look, 8));
    ASSERT_EQ(r.with_image.report.verdict, ImageVerdict::used);
    const auto errors = [&](const ImplicitFunction& function) {
        double within = 0, beyond = 0, count_within = 0, count_beyond = 0;
        for (const Vec3& p : surface_points(function, contours)) {
            if (std::abs(p.z - kEnd) < 6) continue;
            (p.z < kEnd ? within : beyond) += surface_distance(lobed_depth, p);
            (p.z < kEnd ? count_within : count_beyond) += 1;
        }
        return std::pair{within / count_within, beyond / count_beyond};
    };
    const auto [within_without, beyond_without] = errors(r.plain.function);
    const auto [within, beyond] = errors(r.with_image.fitted.function);
    EXPECT_LT(within, 0.7 * within_without) << "where there is an image";
    EXPECT_LT(beyond, 1.02 * beyond_without) << "where there is none, nothing is made up";
}

TEST(FollowImageAdversarial, VoxelsThatHoldNoNumberSayNothing) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    const Look holes = [](const Vec3& p) {
        return p.x > 20       ? std::numeric_limits<double>::quiet_NaN()
               : norm(p) > 44 ? std::numeric_limits<double>::infinity()
                              : body_look(p);
    };
    const FollowedImage r = follow_image_of(contours, image_of(cube_grid(1.5), holes, 8));
    ASSERT_EQ(r.with_image.report.verdict, ImageVerdict::used);
    EXPECT_TRUE(std::isfinite(r.with_image.fitted.function.value({0, 0, 0})));
    EXPECT_LT(surface_error(r.with_image.fitted.function, contours), 0.8 * surface_error(r.plain.function, contours));
}

TEST(FollowImageAdversarial, StreaksDoNotPullTheSurfaceAway) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    const Look streaks = [](const Vec3& p) {
        const double angle = std::atan2(p.y - 3, p.x + 5);
        return body_look(p) + 150 * std::pow(std::max(std::cos(6 * angle), 0.0), 20);
    };
    const FollowedImage r = follow_image_of(contours, image_of(cube_grid(1.5), streaks, 8));
    ASSERT_EQ(r.with_image.report.verdict, ImageVerdict::used);
    // Within 5 degrees of a streak, where it is brighter than the body.
    const auto error_along = [&](const ImplicitFunction& function) {
        double sum = 0, count = 0;
        for (const Vec3& p : surface_points(function, contours)) {
            if (std::cos(6 * std::atan2(p.y - 3, p.x + 5)) < 0.9) continue;
            sum += surface_distance(lobed_depth, p);
            count += 1;
        }
        return sum / count;
    };
    const double along_without = error_along(r.plain.function);
    const double along_with = error_along(r.with_image.fitted.function);
    EXPECT_LT(along_with, along_without);
    EXPECT_LT(surface_error(r.with_image.fitted.function, contours), 0.8 * surface_error(r.plain.function, contours));
}

TEST(FollowImageAdversarial, VoxelsTenTimesAsThickAsWideStillHelp) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    const Grid thick = grid_around({{-48, -48, -48}, {48, 48, 48}}, {0.8, 0.8, 8}, 0);
    const FollowedImage r = follow_image_of(contours, image_of(thick, body_look, 8));
    ASSERT_EQ(r.with_image.report.verdict, ImageVerdict::used);
    EXPECT_LT(surface_error(r.with_image.fitted.function, contours), 0.9 * surface_error(r.plain.function, contours));
    EXPECT_LE(r.with_image.report.on_contours_mm, 0.05 * 0.8);
}

/// Mean distance of the surface of one function from that of another, and the largest, to first order, mm.
struct Apart {
    double mean_mm = 0, largest_mm = 0;
};
Apart apart(const ImplicitFunction& a, const ContourSet& contours, const ImplicitFunction& b, const Affine3& to_b = {}) {
    std::vector<Vec3> starts;
    for (const Contour& contour : contours.contours)
        starts.insert(starts.end(), contour.points.begin(), contour.points.end());
    const TriangleMesh mesh = preview_surface(a, starts, {.spacing_mm = 2});
    Apart result;
    for (const Vec3& p : mesh.points) {
        const Vec3 there = to_b.apply(p);
        const double distance = std::abs(b.value(there) / norm(b.gradient(there)) - a.value(p) / norm(a.gradient(p)));
        result.mean_mm += distance / static_cast<double>(mesh.points.size());
        result.largest_mm = std::max(result.largest_mm, distance);
    }
    return result;
}

/// What moving image and drawing changes, and what the image did where they were.
std::pair<Apart, Apart> changed_by(const Affine3& motion) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    const Image image = image_of(cube_grid(1.5), body_look, 8);
    Image moved_image = image;
    moved_image.grid.index_to_mm = compose(motion, image.grid.index_to_mm);
    const FollowedImage here = follow_image_of(contours, image),
                        there = follow_image_of(moved(contours, motion), moved_image);
    EXPECT_EQ(here.with_image.report.verdict, ImageVerdict::used);
    EXPECT_EQ(there.with_image.report.verdict, ImageVerdict::used);
    EXPECT_NEAR(there.with_image.report.error_with_mm, here.with_image.report.error_with_mm,
                0.05 * here.with_image.report.error_with_mm);
    const ImplicitFunction& function = here.with_image.fitted.function;
    return {apart(function, contours, there.with_image.fitted.function, motion),
            apart(function, contours, here.plain.function)};
}

TEST(FollowImageAdversarial, IsShiftedWithImageAndDrawing) {
    Affine3 shift;
    shift.translation = {140, -230, 710};
    EXPECT_LT(changed_by(shift).first.largest_mm, 1e-3);
}

TEST(FollowImageAdversarial, TurnsWithImageAndDrawing) {
    const auto [turned, moved_by_image] = changed_by(rigid_motion());
    EXPECT_GT(moved_by_image.mean_mm, 0.5);
    EXPECT_LT(turned.mean_mm, 0.005);
    EXPECT_LT(turned.largest_mm, 0.4) << "where f is flattest";
}

TEST(FollowImageAdversarial, ObliqueVoxelsSayAsMuch) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    Affine3 turn = rigid_motion();
    turn.translation = {};
    Grid grid = cube_grid(1.5, 60);
    grid.index_to_mm = compose(turn, grid.index_to_mm);
    const FollowedImage r = follow_image_of(contours, image_of(grid, body_look, 8));
    ASSERT_EQ(r.with_image.report.verdict, ImageVerdict::used);
    EXPECT_LT(surface_error(r.with_image.fitted.function, contours), 0.6 * surface_error(r.plain.function, contours));
}

TEST(FollowImageAdversarial, ShearedVoxelsSayAsMuch) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    Grid grid = cube_grid(1.5, 60);
    grid.index_to_mm.set_column(2, {0.5, -0.3, 1.4});
    grid.index_to_mm.translation -= 40.0 * Vec3{0.5, -0.3, 0};
    const FollowedImage r = follow_image_of(contours, image_of(grid, body_look, 8));
    ASSERT_EQ(r.with_image.report.verdict, ImageVerdict::used);
    EXPECT_LT(surface_error(r.with_image.fitted.function, contours), 0.6 * surface_error(r.plain.function, contours));
}

}  // namespace
}  // namespace kontur
