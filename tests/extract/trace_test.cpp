// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/trace.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "kontur/io/contours/contour_json.h"
#include "kontur/io/image.h"
#include "support/expect_error.h"
#include "support/mask_of.h"
#include "support/random_masks.h"
#include "support/test_data.h"

namespace kontur {
namespace {

/// A grid of 1 mm steps around the origin whose axes are turned, mirrored or sheared.
struct NamedGrid {
    const char* name;
    Grid grid;
};

Grid grid_with_axes(const Vec3& i, const Vec3& j, const Vec3& k) {
    Grid grid{{64, 64, 64}, {}};
    grid.index_to_mm.set_column(0, i);
    grid.index_to_mm.set_column(1, j);
    grid.index_to_mm.set_column(2, k);
    grid.index_to_mm.translation = -grid.index_to_mm.apply_linear({31.3, 31.6, 31.1});
    return grid;
}

std::vector<NamedGrid> grids() {
    const Plane turned = make_plane({0, 0, 0}, {0.3, -0.2, 0.9});
    return {{"axis-aligned", grid_with_axes({1, 0, 0}, {0, 1, 0}, {0, 0, 1})},
            {"oblique", grid_with_axes(turned.u, turned.v, turned.normal)},
            {"left-handed", grid_with_axes(turned.v, turned.u, turned.normal)},
            {"sheared", grid_with_axes({1, 0, 0}, {0, 1, 0}, {0, 0.3, 0.95})}};
}

/// Area enclosed by a contour, positive when it runs counter-clockwise about its plane's normal.
double signed_area(const Contour& contour) {
    Vec3 twice;
    const Vec3 o = contour.points.front();
    for (std::size_t i = 0; i < contour.points.size(); ++i)
        twice += cross(contour.points[i] - o, contour.points[(i + 1) % contour.points.size()] - o);
    return 0.5 * dot(twice, contour.plane.normal);
}

Plane random_plane(std::mt19937& random, double reach_mm) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> offset(-reach_mm, reach_mm);
    const Vec3 direction = normalized({normal(random), normal(random), normal(random)});
    return make_plane(offset(random) * direction, direction);
}

/// First-order distance of a point from an ellipsoid about the origin.
double distance_from_ellipsoid(const Vec3& p, const Vec3& radii) {
    const Vec3 q{p.x / radii.x, p.y / radii.y, p.z / radii.z};
    return std::abs(norm(q) * (norm(q) - 1) / norm({q.x / radii.x, q.y / radii.y, q.z / radii.z}));
}

double section_area(const Vec3& radii, const Plane& plane) {
    const Vec3 n{radii.x * plane.normal.x, radii.y * plane.normal.y, radii.z * plane.normal.z};
    const double width2 = dot(n, n), d = dot(plane.normal, plane.origin);
    return std::numbers::pi * radii.x * radii.y * radii.z * (1 - d * d / width2) / std::sqrt(width2);
}

TEST(Trace, FollowsBallsAndEllipsoidsCutByRandomPlanesOnAnyGrid) {
    std::mt19937 random = test::random_of_this_test();
    for (const auto& [name, grid] : grids())
        for (const Vec3& radii : {Vec3{20, 20, 20}, Vec3{24, 15, 19}}) {
            const Mask mask = test::mask_of(grid, [&](const Vec3& p) {
                return norm({p.x / radii.x, p.y / radii.y, p.z / radii.z}) < 1;
            });
            for (int run = 0; run < 12; ++run) {
                const Plane plane = random_plane(random, 9);
                const ContourSet set = trace(mask, std::span(&plane, 1));
                ASSERT_EQ(set.contours.size(), 1u) << name;
                const Contour& contour = set.contours[0];
                EXPECT_FALSE(contour.hole);
                EXPECT_NEAR(signed_area(contour) / section_area(radii, plane), 1, 0.01) << name << " " << run;
                for (const Vec3& p : contour.points) {
                    ASSERT_LT(distance_from_ellipsoid(p, radii), 0.5) << name << " " << run;
                    ASSERT_LT(std::abs(plane.distance_to(p)), 1e-9);
                }
            }
        }
}

TEST(Trace, MarksTheWallOfACavityAsAHole) {
    const Mask shell = test::mask_of(grids()[1].grid, [](const Vec3& p) { return norm(p) < 24 && norm(p) > 12; });
    std::mt19937 random = test::random_of_this_test();
    for (int run = 0; run < 10; ++run) {
        const Plane plane = random_plane(random, 6);
        const ContourSet set = trace(shell, std::span(&plane, 1));
        ASSERT_EQ(set.contours.size(), 2u);
        for (const Contour& contour : set.contours) {
            const double radius = contour.hole ? 12 : 24;
            for (const Vec3& p : contour.points) ASSERT_NEAR(norm(p), radius, 0.5);
            EXPECT_EQ(signed_area(contour) < 0, contour.hole);
        }
        EXPECT_NE(set.contours[0].hole, set.contours[1].hole);
    }
}

TEST(Trace, CutsATorusIntoTwoLoopsOrARing) {
    const Mask torus =
        test::mask_of(grids()[3].grid, [](const Vec3& p) { return std::hypot(std::hypot(p.x, p.y) - 17, p.z) < 7; });
    const std::vector<Plane> planes{make_plane({0, 0, 0}, {1, 0.4, 0}), make_plane({0, 0, 1}, {0, 0, 1})};
    const ContourSet set = trace(torus, planes);
    ASSERT_EQ(set.contours.size(), 4u);
    EXPECT_FALSE(set.contours[0].hole || set.contours[1].hole);
    EXPECT_NEAR(signed_area(set.contours[0]), std::numbers::pi * 49, 2);
    EXPECT_NEAR(signed_area(set.contours[1]), std::numbers::pi * 49, 2);
    EXPECT_EQ(set.contours[0].plane, set.contours[1].plane);
    EXPECT_EQ(set.contours[2].hole + set.contours[3].hole, 1);
    EXPECT_NEAR(signed_area(set.contours[2]) + signed_area(set.contours[3]), std::numbers::pi * 4 * 17 * std::sqrt(48.0),
                15);
}

TEST(Trace, ClosesHalfAVoxelBeyondTheOutermostCentresWhereTheGridCutsTheObject) {
    Mask full{{{10, 6, 4}, {}}, std::vector<std::uint8_t>(240, 1)};
    full.grid.index_to_mm.set_column(0, {2, 0, 0});
    const Plane axial = make_plane({0, 0, 1.5}, {0, 0, 1});
    const ContourSet set = trace(full, std::span(&axial, 1));
    ASSERT_EQ(set.contours.size(), 1u);
    const Box3 box = bounding_box(set);
    EXPECT_NEAR(box.min.x, -1, 1e-9);
    EXPECT_NEAR(box.max.x, 19, 1e-9);
    EXPECT_NEAR(box.min.y, -0.5, 1e-9);
    EXPECT_NEAR(box.max.y, 5.5, 1e-9);
    EXPECT_NEAR(signed_area(set.contours[0]), 120, 1) << "but for the rounded corners";
}

TEST(Trace, DropsOnlyPointsWithinTheTolerance) {
    const Mask ball = test::ball_mask(grids()[1].grid, {0, 0, 0}, 20);
    const Plane plane = make_plane({1, 2, 3}, {3, 1, 2});
    const ContourSet fine = trace(ball, std::span(&plane, 1));
    for (const double tolerance_mm : {0.05, 0.5}) {
        const ContourSet coarse = trace(ball, std::span(&plane, 1), {.tolerance_mm = tolerance_mm});
        EXPECT_LT(point_count(coarse), point_count(fine) / 2);
        const auto& polygon = coarse.contours.at(0).points;
        for (const Vec3& p : fine.contours.at(0).points) {
            double nearest = 1e9;
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                const Vec3 &a = polygon[i], ab = polygon[(i + 1) % polygon.size()] - a;
                nearest = std::min(nearest, distance(p, a + std::clamp(dot(p - a, ab) / dot(ab, ab), 0.0, 1.0) * ab));
            }
            EXPECT_LE(nearest, tolerance_mm * 1.001);
        }
    }
}

TEST(Trace, KeepsOnlyCornersOfStraightSides) {
    Mask block{{{12, 12, 12}, {}}, std::vector<std::uint8_t>(12 * 12 * 12)};
    for (std::int64_t k = 3; k < 9; ++k)
        for (std::int64_t j = 3; j < 9; ++j)
            for (std::int64_t i = 3; i < 9; ++i) block.values[block.grid.offset(i, j, k)] = 1;
    const Plane plane = make_plane({0, 0, 5}, {0, 0, 1});
    const ContourSet set = trace(block, std::span(&plane, 1));
    const auto& points = set.contours.at(0).points;
    EXPECT_LE(points.size(), 16u);
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_GT(distance(points[i], points[(i + 1) % points.size()]), 1e-6);
}

TEST(Trace, DropsSmallContours) {
    const Mask two = test::mask_of(grids()[0].grid, [](const Vec3& p) {
        return norm(p - Vec3{-12, 0, 0}) < 10 || norm(p - Vec3{15, 0, 0}) < 3;
    });
    const Plane plane = make_plane({0, 0, 0}, {0, 0.1, 1});
    EXPECT_EQ(trace(two, std::span(&plane, 1)).contours.size(), 2u);
    EXPECT_EQ(trace(two, std::span(&plane, 1), {.min_area_mm2 = 50}).contours.size(), 1u);
    EXPECT_EQ(trace(two, std::span(&plane, 1), {.min_area_mm2 = 500}).contours.size(), 0u);
}

TEST(Trace, FindsNothingInEmptyMasksAndOnPlanesThatMiss) {
    const Grid grid = grids()[2].grid;
    const std::vector<Plane> planes{make_plane({0, 0, 0}, {1, 2, 3}), make_plane({0, 0, 25}, {0, 0, 1})};
    EXPECT_TRUE(
        trace({grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()))}, planes).contours.empty());
    EXPECT_EQ(trace(test::ball_mask(grid, {0, 0, 0}, 20), planes).contours.size(), 1u);
    EXPECT_TRUE(trace(test::ball_mask(grid, {0, 0, 0}, 20), {}).contours.empty());
}

TEST(Trace, GivesTheSamePointsForAnyNumberOfThreads) {
    std::mt19937 random = test::random_of_this_test();
    const Mask mask = test::ball_mask(grids()[3].grid, {1, 2, 3}, 17);
    const Plane plane = random_plane(random, 5);
    const ContourSet one = trace(mask, std::span(&plane, 1), {}, {.threads = 1});
    for (const int threads : {2, 3, 8})
        EXPECT_EQ(trace(mask, std::span(&plane, 1), {}, {.threads = threads}).contours.at(0).points,
                  one.contours.at(0).points);
}

TEST(Trace, RefusesWhatMakesNoSense) {
    const Grid grid = grids()[0].grid;
    const Mask mask = test::ball_mask(grid, {0, 0, 0}, 20);
    std::vector<Plane> planes(3);
    planes[1].u = {1, 0.1, 0};
    EXPECT_KONTUR_ERROR(trace(mask, planes), ErrorKind::invalid_input, "plane 2 of 3");
    planes[1] = {};
    planes[2].normal = {0, 0, std::numeric_limits<double>::quiet_NaN()};
    EXPECT_KONTUR_ERROR(trace(mask, planes), ErrorKind::invalid_input, "plane 3 of 3");
    planes[2] = {};
    EXPECT_KONTUR_ERROR(trace({grid, {}}, planes), ErrorKind::invalid_input, "0 values");
    EXPECT_KONTUR_ERROR(trace(mask, planes, {.step_mm = -1}), ErrorKind::invalid_input, "step_mm");
    EXPECT_KONTUR_ERROR(trace(mask, planes, {.step_mm = 1e-5}), ErrorKind::too_large, "step");
}

TEST(Trace, StopsWhenAsked) {
    StopSource source;
    source.request_stop();
    const Work work{.stop = source.token()};
    const std::vector<Plane> planes(2);
    EXPECT_KONTUR_ERROR(trace(test::ball_mask(grids()[0].grid, {0, 0, 0}, 20), planes, {}, work), ErrorKind::cancelled, "");
}

double distance_to_contours(const Vec3& p, std::span<const Contour> contours) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Contour& contour : contours)
        for (std::size_t i = 0; i < contour.points.size(); ++i) {
            const Vec3 &a = contour.points[i], ab = contour.points[(i + 1) % contour.points.size()] - a;
            nearest = std::min(nearest, distance(p, a + std::clamp(dot(p - a, ab) / dot(ab, ab), 0.0, 1.0) * ab));
        }
    return nearest;
}

double mean_distance(std::span<const Contour> of, std::span<const Contour> to) {
    double sum = 0, count = 0;
    for (const Contour& contour : of)
        for (const Vec3& p : contour.points) sum += distance_to_contours(p, to), ++count;
    return sum / count;
}

double net_area(std::span<const Contour> contours) {
    double sum = 0;
    for (const Contour& contour : contours) sum += (contour.hole ? -1 : 1) * std::abs(signed_area(contour));
    return sum;
}

class RealSetTest : public testing::TestWithParam<std::string> {};

TEST_P(RealSetTest, IsTracedFromItsTruth) {
    const std::filesystem::path folder = std::filesystem::path("derived_nonparallel") / GetParam();
    KONTUR_REQUIRE_DATA(folder / "truth.nii.gz");
    const Mask truth = read_mask(test::data_dir() / folder / "truth.nii.gz");
    const Vec3 spacing = truth.grid.spacing_mm();
    const double voxel_mm = std::max({spacing.x, spacing.y, spacing.z});
    for (const char* set : {"ortho3x3", "radial6", "oblique10", "tilted_parallel7"}) {
        const auto file = test::data_dir() / folder / (std::string(set) + ".json");
        const std::vector<Contour> drawn = read_contour_json(file).contours;
        const std::vector<Contour> traced = trace(truth, read_planes_json(file)).contours;
        ASSERT_FALSE(drawn.empty());
        // The files' contours were smoothed and their smallest loops left out, so ours stray farther from them than they
        // from ours.
        EXPECT_LT(mean_distance(drawn, traced), 0.1 * voxel_mm) << set;
        EXPECT_LT(mean_distance(traced, drawn), 0.2 * voxel_mm) << set;
        EXPECT_NEAR(net_area(traced) / net_area(drawn), 1, 0.005) << set;
    }
}

INSTANTIATE_TEST_SUITE_P(Trace, RealSetTest,
                         testing::Values("hippocampus_label5", "kidney_right_5mm", "lateral_ventricles", "liver_5mm",
                                         "sarcoma_STS_040_CT", "vertebral_body_L5label"),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace kontur
