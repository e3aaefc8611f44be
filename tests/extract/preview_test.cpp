// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/preview.h"

#include <gtest/gtest.h>

#include "kontur/extract/adaptive.h"
#include "kontur/extract/polygonize.h"
#include "support/expect_error.h"
#include "support/functions.h"

namespace kontur {
namespace {

const Vec3 kCenter{20, -30, 1000};
constexpr double kRadius = 15;

/// A circle about the ball's centre in a plane of constant z.
std::vector<Vec3> points_on_ball() {
    std::vector<Vec3> points;
    for (int i = 0; i < 40; ++i)
        points.push_back(kCenter + kRadius * Vec3{std::cos(i * M_PI / 20), std::sin(i * M_PI / 20), 0});
    return points;
}

/// Largest first-order distance of the points from where f vanishes, and largest angle of the normals to its gradient.
std::pair<double, double> worst(const TriangleMesh& mesh, const ImplicitFunction& function) {
    double mm = 0, radians = 0;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const Vec3 gradient = function.gradient(mesh.points[i]);
        mm = std::max(mm, std::abs(function.value(mesh.points[i])) / norm(gradient));
        radians = std::max(radians, std::acos(std::min(1.0, -dot(mesh.normals[i], normalized(gradient)))));
    }
    return {mm, radians};
}

TEST(Preview, PointsLieOnTheSurfaceHoweverCoarseTheLattice) {
    for (const double spacing : {9.0, 5.0, 2.0}) {
        const ImplicitFunction ball = test::ball_function(kCenter, kRadius);
        const auto [mm, radians] = worst(preview_surface(ball, points_on_ball(), {.spacing_mm = spacing}), ball);
        EXPECT_LT(mm, spacing / 50) << spacing;
        EXPECT_LT(radians, 0.1) << spacing;
    }
}

TEST(Preview, IsAClosedSphereWithOutwardNormalsWhateverTheSpacing) {
    for (const double spacing : {4.0, 2.0, 0.7}) {
        const TriangleMesh mesh =
            preview_surface(test::ball_function(kCenter, kRadius), points_on_ball(), {.spacing_mm = spacing});
        const MeshTopology found = topology(mesh);
        EXPECT_TRUE(found.closed && found.oriented);
        EXPECT_EQ(found.euler, 2);
        const double triangles = static_cast<double>(mesh.triangles.size());
        EXPECT_NEAR(triangles, 3 * 4 * M_PI * kRadius * kRadius / (spacing * spacing), 0.15 * triangles);
        ASSERT_EQ(mesh.normals.size(), mesh.points.size());
        for (std::size_t i = 0; i < mesh.points.size(); ++i) {
            const Vec3 radial = mesh.points[i] - kCenter;
            EXPECT_NEAR(norm(radial), kRadius, spacing / 50);
            EXPECT_NEAR(norm(mesh.normals[i]), 1, 1e-12);
            EXPECT_GT(dot(mesh.normals[i], normalized(radial)), 0.9995);
        }
    }
}

/// A plate of 1.6 lattice steps and balls of 2.6 steps: what the lattice's differences cannot show is computed.
TEST(Preview, ThinSheetsAndSmallBallsHaveTheirNormals) {
    TriangleMesh plate = test::unit_sphere(4);
    for (std::size_t i = 0; i < plate.points.size(); ++i) {
        const Vec3 d = plate.points[i];
        plate.points[i] = {30 * d.x, 30 * d.y, 0.8 * d.z};
        plate.normals[i] = normalized({d.x / 30, d.y / 30, d.z / 0.8});
    }
    TriangleMesh balls;
    for (const Vec3& center : {Vec3{-30, 1, 2}, {30, 0, 0}, {0, 33, -5}, {3, -30, 20}}) {
        const TriangleMesh ball = test::ball(center, 1.3, 2);
        balls.points.insert(balls.points.end(), ball.points.begin(), ball.points.end());
        balls.normals.insert(balls.normals.end(), ball.normals.begin(), ball.normals.end());
    }
    for (const TriangleMesh* surface : {&plate, &balls}) {
        const ImplicitFunction function = test::function_through(*surface, 0.2);
        const auto [mm, radians] = worst(preview_surface(function, surface->points, {.spacing_mm = 1}), function);
        EXPECT_LT(mm, 0.05);
        EXPECT_LT(radians, 0.15);
    }
}

TEST(Preview, TakesASmoothSurfaceFromTheLattice) {
    const ImplicitFunction ball = test::ball_function(kCenter, kRadius);
    const Grid grid = *preview_lattice(points_on_ball(), 1, {});
    std::vector<std::int64_t> values;
    for (const MeshAccuracy accuracy : {MeshAccuracy::of_a_screen, MeshAccuracy::of_a_file}) {
        FastFunction fast(ball, {.tolerance_mm = 0.02, .expected_points = 1'000'000});
        const SurfaceLattice surface = track_surface_adaptively(fast, grid, points_on_ball());
        const std::int64_t before = fast.kernel_values();
        polygonize(surface, fast, {}, accuracy);
        values.push_back(fast.kernel_values() - before);
    }
    EXPECT_LT(20 * values[0], values[1]);
}

TEST(Preview, ShowsTheBulgeBeyondTheContours) {
    const std::vector<Vec3> flat = points_on_ball();
    const TriangleMesh mesh = preview_surface(test::ball_function(kCenter, kRadius), flat, {.spacing_mm = 1});
    const Box3 box = bounding_box(mesh.points);
    EXPECT_NEAR(box.min.z, kCenter.z - kRadius, 0.1);
    EXPECT_NEAR(box.max.z, kCenter.z + kRadius, 0.1);
}

TEST(Preview, CutsALeakOff) {
    // A half space: the surface through the starts has no end.
    const ImplicitFunction half_space(Kernel::triharmonic, {{}, 1}, {}, {}, {0, 0, 0, 1});
    const std::vector<Vec3> starts{{0, 0, 0}, {10, 0, 0}, {0, 10, 0}};
    const TriangleMesh mesh = preview_surface(half_space, starts, {.spacing_mm = 1});
    EXPECT_TRUE(topology(mesh).closed);
    const Box3 box = bounding_box(mesh.points);
    EXPECT_LT(box.diagonal(), 60);
    EXPECT_GT(box.size().x, 20);
}

TEST(Preview, WithoutFiniteStartsIsEmpty) {
    const ImplicitFunction ball = test::ball_function({}, 5);
    EXPECT_TRUE(preview_surface(ball, {}).triangles.empty());
    EXPECT_TRUE(preview_surface(ball, std::vector<Vec3>{{std::nan(""), 0, 0}}).triangles.empty());
}

TEST(Preview, RefusesSpacingsThatMakeNoSense) {
    const ImplicitFunction ball = test::ball_function({}, 5);
    const std::vector<Vec3> starts{{5, 0, 0}, {-5, 0, 0}, {0, 5, 0}};
    for (const double spacing : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
        EXPECT_KONTUR_ERROR(preview_surface(ball, starts, {.spacing_mm = spacing}), ErrorKind::invalid_input, "spacing");
    EXPECT_KONTUR_ERROR(preview_surface(ball, starts, {.spacing_mm = 1e-3}), ErrorKind::too_large, "points");
}

TEST(Preview, StopsWhenAskedTo) {
    StopSource source;
    source.request_stop();
    EXPECT_KONTUR_ERROR(
        preview_surface(test::ball_function({}, 5), std::vector<Vec3>{{5, 0, 0}}, {}, {.stop = source.token()}),
        ErrorKind::cancelled, "");
}

TEST(Preview, SameBytesForAnyNumberOfThreads) {
    const ImplicitFunction ball = test::ball_function(kCenter, kRadius);
    const TriangleMesh one = preview_surface(ball, points_on_ball(), {.spacing_mm = 1}, {.threads = 1});
    for (const int threads : {2, 5}) {
        const TriangleMesh many = preview_surface(ball, points_on_ball(), {.spacing_mm = 1}, {.threads = threads});
        EXPECT_EQ(many.points, one.points);
        EXPECT_EQ(many.normals, one.normals);
        EXPECT_EQ(many.triangles, one.triangles);
    }
}

}  // namespace
}  // namespace kontur
