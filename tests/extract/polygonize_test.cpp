// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/polygonize.h"

#include <gtest/gtest.h>

#include "support/functions.h"
#include "support/random.h"

namespace kontur {
namespace {

const Vec3 kCenter{20, -30, 100};

TriangleMesh surface_of(const ImplicitFunction& function, const Grid& grid, int threads = 2) {
    return polygonize(sample_everywhere(function, grid, {.threads = threads}), function, {.threads = threads});
}

void expect_solid(const TriangleMesh& mesh, std::int64_t euler) {
    const MeshTopology found = topology(mesh);
    EXPECT_TRUE(found.closed);
    EXPECT_TRUE(found.oriented);
    EXPECT_EQ(found.euler, euler);
    EXPECT_GT(signed_volume_mm3(mesh), 0);
}

Vec3 area_vector(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
    return cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]);
}

TEST(Polygonize, BallIsASphereOnEveryKindOfGrid) {
    const double radius = 9;
    for (const Affine3& change : {Affine3{}, test::kOblique, test::kSheared, test::kMirrored}) {
        const Grid grid = test::changed(test::grid_about(kCenter, {30, 32, 40}, 1), change);
        const TriangleMesh mesh = surface_of(test::ball_function(kCenter, radius), grid);
        expect_solid(mesh, 2);
        EXPECT_EQ(topology(mesh).components, 1);
        EXPECT_NEAR(signed_volume_mm3(mesh), 4.0 / 3 * M_PI * std::pow(radius, 3),
                    0.015 * 4.0 / 3 * M_PI * std::pow(radius, 3));
        ASSERT_EQ(mesh.normals.size(), mesh.points.size());
        for (std::size_t i = 0; i < mesh.points.size(); ++i) {
            const Vec3 radial = mesh.points[i] - kCenter;
            EXPECT_NEAR(norm(radial), radius, 6e-3);
            EXPECT_GT(dot(mesh.normals[i], normalized(radial)), std::cos(0.01 * M_PI / 180));
        }
        for (const auto& t : mesh.triangles) EXPECT_GT(dot(area_vector(mesh, t), mesh.points[t[0]] - kCenter), 0);
    }
}

TEST(Polygonize, VolumeConvergesWithTheSquareOfTheSpacing) {
    const double exact = 4.0 / 3 * M_PI * std::pow(9, 3);
    const auto error = [&](double spacing) {
        const auto n = static_cast<std::int64_t>(22 / spacing);
        const ImplicitFunction ball = test::ball_function(kCenter, 9);
        return std::abs(signed_volume_mm3(surface_of(ball, test::grid_about(kCenter, {n, n, n}, spacing))) / exact - 1);
    };
    EXPECT_LT(error(1), 0.012);
    EXPECT_LT(error(0.5), error(1) / 3.5);
}

TEST(Polygonize, PointsLieOnTheSurfaceHoweverCoarseTheGrid) {
    for (const double slices : {2.0, 5.0}) {
        Grid grid = test::grid_about(kCenter, {22, 23, 14}, 1);
        grid.index_to_mm.linear[2][2] = slices;
        grid.index_to_mm.translation.z = kCenter.z - 6.4 * slices;
        for (const Vec3& p : surface_of(test::ball_function(kCenter, 9), grid).points)
            EXPECT_NEAR(distance(p, kCenter), 9, 6e-3);
    }
}

TEST(Polygonize, TorusHasAHole) {
    const double major = 8, minor = 3;
    const ImplicitFunction torus = test::function_through(test::torus({}, major, minor, 24));
    const TriangleMesh mesh = surface_of(torus, test::grid_about({}, {34, 34, 14}, 0.7));
    expect_solid(mesh, 0);
    const double exact = 2 * M_PI * M_PI * major * minor * minor;
    EXPECT_NEAR(signed_volume_mm3(mesh), exact, 0.02 * exact);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const Vec3& p = mesh.points[i];
        const Vec3 ring = major * normalized({p.x, p.y, 0});
        EXPECT_NEAR(distance(p, ring), minor, 0.07);
        EXPECT_GT(dot(mesh.normals[i], normalized(p - ring)), std::cos(3 * M_PI / 180));
    }
}

TEST(Polygonize, TwoObjectsAreTwoComponents) {
    TriangleMesh both = test::ball({-8, 0, 0}, 4, 2);
    const TriangleMesh second = test::ball({8, 1, 0}, 5, 2);
    both.points.insert(both.points.end(), second.points.begin(), second.points.end());
    both.normals.insert(both.normals.end(), second.normals.begin(), second.normals.end());
    const ImplicitFunction function = test::function_through(both);
    const std::vector<Vec3> starts{{-12, 0, 0}, {13, 1, 0}};
    const TriangleMesh mesh =
        polygonize(track_surface(function, test::grid_about({}, {32, 15, 15}, 1), starts, {.threads = 1}), function);
    expect_solid(mesh, 4);
    EXPECT_EQ(topology(mesh).components, 2);
}

/// The grid's face on which a point lies, half a voxel beyond the last centres: 2 * axis + (1 at the high end), or -1.
int border_face(const Grid& grid, const Vec3& p) {
    const Vec3 at = grid.index_to_mm.inverse().apply(p);
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(at[axis] + 0.5) < 1e-9) return 2 * axis;
        if (std::abs(at[axis] - static_cast<double>(grid.size[axis]) + 0.5) < 1e-9) return 2 * axis + 1;
    }
    return -1;
}

TEST(Polygonize, ObjectCutOffAtTheBorderIsClosedHalfAVoxelBeyondTheLastCentres) {
    for (const Affine3& change : {Affine3{}, test::kSheared, test::kMirrored}) {
        const Grid grid = test::changed(test::grid_about({}, {12, 13, 14}, 1), change);
        for (const Vec3& center : {Vec3{}, Vec3{9, 0, 0}, Vec3{0, -9, 4}}) {
            const TriangleMesh mesh = surface_of(test::ball_function(center, 7), grid);
            expect_solid(mesh, 2);
            int on_border = 0;
            for (const auto& t : mesh.triangles) {
                const std::array<int, 3> faces{border_face(grid, mesh.points[t[0]]), border_face(grid, mesh.points[t[1]]),
                                               border_face(grid, mesh.points[t[2]])};
                if (faces[0] != faces[1] || faces[1] != faces[2]) continue;  // across the rim of the cut
                on_border += faces[0] >= 0;
                for (const std::uint32_t corner : t)
                    EXPECT_GT(dot(normalized(area_vector(mesh, t)), mesh.normals[corner]), faces[0] >= 0 ? 0.999 : 0.9);
            }
            EXPECT_TRUE(on_border > 20 || center == Vec3{});
        }
        const double whole = static_cast<double>(grid.voxel_count()) * grid.voxel_volume_mm3();
        EXPECT_GT(signed_volume_mm3(surface_of(test::ball_function({}, 40), grid)), 0.9 * whole);
    }
}

TEST(Polygonize, RandomFieldsGiveClosedOrientedManifolds) {
    std::mt19937 random = test::random_of_this_test();
    std::normal_distribution<double> value;
    const Grid grid = test::grid_about({}, {6, 6, 6}, 1);
    for (int round = 0; round < 500; ++round) {
        SurfaceLattice surface{Lattice(grid), {}, 0};
        for (std::int64_t n = 0; n < 216; ++n) {
            const double v = value(random) + (round % 5 - 2) * 0.4;
            surface.lattice.set_value({n % 6, n / 6 % 6, n / 36}, v);
        }
        for (std::int64_t k = -1; k < 6; ++k)
            for (std::int64_t j = -1; j < 6; ++j)
                for (std::int64_t i = -1; i < 6; ++i) surface.cells.push_back({i, j, k});
        const TriangleMesh mesh = polygonize(surface, ImplicitFunction());
        const MeshTopology found = topology(mesh);
        ASSERT_TRUE(found.closed && found.oriented) << round;
        ASSERT_GT(signed_volume_mm3(mesh), 0) << round;
    }
}

TEST(Polygonize, SameBytesForAnyNumberOfThreads) {
    const ImplicitFunction function = test::spheroid_function(kCenter, {3, 2, 1}, 8);
    const Grid grid = test::grid_about(kCenter, {25, 25, 25}, 1);
    const TriangleMesh one = surface_of(function, grid, 1);
    for (const int threads : {2, 3, 8}) {
        const TriangleMesh many = surface_of(function, grid, threads);
        EXPECT_EQ(many.points, one.points);
        EXPECT_EQ(many.normals, one.normals);
        EXPECT_EQ(many.triangles, one.triangles);
    }
}

}  // namespace
}  // namespace kontur
