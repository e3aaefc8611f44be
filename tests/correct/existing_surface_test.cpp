// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/existing_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "kontur/base/distance_transform.h"
#include "kontur/correct/existing_mesh.h"
#include "kontur/extract/mesh_mask.h"
#include "support/mask_of.h"
#include "support/random.h"

namespace kontur {
namespace {

Mask ball(const Grid& grid, const Vec3& center, double radius) {
    return test::mask_of(grid, [&](const Vec3& p) { return distance(p, center) < radius; });
}

/// Axes of the given lengths, turned, and sheared along y by `shear` of z.
Grid turned(const Vec3& spacing, double shear) {
    const double c = std::cos(0.4), s = std::sin(0.4);
    Grid grid{{48, 52, 30}, {}};
    grid.index_to_mm.set_column(0, {spacing.x * c, spacing.x * s, 0});
    grid.index_to_mm.set_column(1, {-spacing.y * s, spacing.y * c, 0});
    grid.index_to_mm.set_column(2, {0, shear * spacing.z, spacing.z});
    grid.index_to_mm.translation = {-10, 20, 5};
    return grid;
}

TEST(ExistingSurface, IsTheDistanceOfABallOnAnyGrid) {
    for (const double shear : {0.0, 0.2})
        for (const Vec3& spacing : {Vec3{1, 1, 1}, Vec3{0.8, 1.1, 2.5}}) {
            const Grid grid = turned(spacing, shear);
            const Vec3 center = grid.center_mm(24, 26, 15);
            const ExistingSurface surface(ball(grid, center, 14));
            EXPECT_NEAR(surface.inscribed_radius_mm(), 14, 1.2);
            EXPECT_NEAR(surface.radius_mm(), 14, 0.6);
            for (const double radius : {4.0, 9.0, 12.0, 14.0, 16.0, 20.0})
                for (int n = 0; n < 40; ++n) {
                    const Vec3 to = normalized({std::cos(n * 1.3), std::sin(n * 0.7), std::cos(n * 2.1 + 1)});
                    EXPECT_NEAR(surface.value(center + radius * to), 14 - radius, 0.45 * spacing.z + 0.4) << radius;
                }
        }
}

TEST(ExistingSurface, HasTheMasksSignAtEveryVoxel) {
    const Mask mask = ball(turned({1, 1, 2}, 0.2), turned({1, 1, 2}, 0.2).center_mm(24, 26, 15), 3.1);
    const ExistingSurface surface(mask);
    for (std::int64_t k = 0; k < mask.grid.size.k; ++k)
        for (std::int64_t j = 0; j < mask.grid.size.j; ++j)
            for (std::int64_t i = 0; i < mask.grid.size.i; ++i)
                EXPECT_EQ(surface.value_at_voxel({i, j, k}) > 0, mask.values[mask.grid.offset(i, j, k)] != 0);
}

TEST(ExistingSurface, EndsWithTheImageHalfAVoxelBeyondIt) {
    Grid grid = turned({1, 1, 1}, 0);
    Mask mask{grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()), 1)};
    const ExistingSurface surface(mask);
    EXPECT_NEAR(surface.value(grid.index_to_mm.apply({-0.5, 26, 15})), 0, 0.15);
    EXPECT_LT(surface.value(grid.index_to_mm.apply({-9, 26, 15})), -8);
}

TriangleMesh mesh_of(const Mask& mask) {
    const ExistingSurface surface(mask);
    return ExistingMesh(surface).mesh();
}

TEST(ExistingMesh, IsAsLargeAsTheMask) {
    const Grid grid = turned({1, 1, 1}, 0);
    for (const double radius : {5.0, 7.0, 12.0}) {
        const Mask mask = ball(grid, grid.center_mm(24, 26, 15) + Vec3{0.2, 0.3, 0.1}, radius);
        double mask_mm3 = 0;
        for (const std::uint8_t inside : mask.values) mask_mm3 += inside;
        EXPECT_NEAR(signed_volume_mm3(mesh_of(mask)) / mask_mm3, 1, radius < 6 ? 0.03 : 0.02) << radius;
    }
}

TEST(ExistingMesh, IsASolidWithEachVoxelOnItsSide) {
    for (const double mirror : {1.0, -1.0}) {
        Grid grid = turned({1, 1.2, 2}, 0.2);
        grid.index_to_mm.set_column(0, mirror * grid.index_to_mm.column(0));
        const Vec3 center = grid.center_mm(24, 26, 15);
        const Mask mask = ball(grid, center, 12);
        const TriangleMesh mesh = mesh_of(mask);
        const MeshTopology solid = topology(mesh);
        EXPECT_TRUE(solid.closed && solid.oriented);
        EXPECT_EQ(solid.euler, 2);
        const double ball_mm3 = 4 * 3.14159265 / 3 * 12 * 12 * 12;
        EXPECT_NEAR(signed_volume_mm3(mesh), ball_mm3, 0.06 * ball_mm3) << "outward, on left-handed axes, too";
        EXPECT_EQ(voxelize_mesh(mesh, grid).mask.values, mask.values);
        for (std::size_t n = 0; n < mesh.points.size(); ++n)
            EXPECT_GT(dot(mesh.normals[n], normalized(mesh.points[n] - center)), 0.7);
    }
    const Grid whole = turned({1, 1, 1}, 0);
    const TriangleMesh cut = mesh_of({whole, std::vector<std::uint8_t>(static_cast<std::size_t>(whole.voxel_count()), 1)});
    EXPECT_TRUE(topology(cut).closed) << "half a voxel beyond the image";
}

TEST(ExistingMesh, HasEachVoxelOnItsSideWhereverSomeChange) {
    std::mt19937 random = test::random_of_this_test();
    const Grid grid = turned({1, 1.2, 2}, 0.2);
    const Mask before = ball(grid, grid.center_mm(24, 26, 15), 9);
    const ExistingSurface surface(before);
    const ExistingMesh existing(surface);
    const TriangleMesh plain = existing.mesh();
    // Beside each other, at the grid's corner and near the ball.
    std::vector<std::size_t> changed{0, 1, before.values.size() - 1};
    for (int n = 0; n < 300; ++n) changed.push_back(random() % before.values.size());
    std::ranges::sort(changed);
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    Mask after = before;
    std::vector<MadeVoxel> made;
    for (const std::size_t n : changed) {
        made.push_back({n, before.values[n] ? CorrectedVoxel::removed_drawn : CorrectedVoxel::added_drawn});
        after.values[n] ^= 1;
    }
    const CorrectedMesh corrected = existing.corrected(nullptr, made);
    EXPECT_TRUE(topology(corrected.mesh).closed && topology(corrected.mesh).oriented);
    EXPECT_EQ(voxelize_mesh(corrected.mesh, grid).mask.values, after.values);
    ASSERT_EQ(corrected.made_by.size(), corrected.mesh.points.size());
    EXPECT_GT(std::ranges::count(corrected.made_by, CorrectedVoxel::added_drawn), 500);
    EXPECT_GT(std::ranges::count(corrected.made_by, CorrectedVoxel::inside), 500);
    std::size_t same = 0;
    for (const Vec3& p : plain.points) same += std::ranges::find(corrected.mesh.points, p) != corrected.mesh.points.end();
    EXPECT_GT(same, plain.points.size() / 2) << "nothing moves where nothing changes";
}

TEST(DistanceTransform, KnowsSpacing) {
    const Index3 size{9, 7, 6};
    const Vec3 spacing{0.7, 1.3, 3};
    std::vector<std::uint8_t> marked(static_cast<std::size_t>(size.i * size.j * size.k));
    for (const std::size_t n : {3U, 77U, 200U, 301U}) marked[n] = 1;
    const DistanceTransform found = distance_transform(size, spacing, marked);
    const auto place = [&](std::size_t n) {
        const auto at = static_cast<std::int64_t>(n);
        return Vec3{static_cast<double>(at % size.i) * spacing.x, static_cast<double>(at / size.i % size.j) * spacing.y,
                    static_cast<double>(at / size.i / size.j) * spacing.z};
    };
    for (std::size_t n = 0; n < marked.size(); ++n) {
        double least = 1e9;
        for (std::size_t m = 0; m < marked.size(); ++m)
            if (marked[m]) least = std::min(least, distance(place(n), place(m)));
        EXPECT_NEAR(found.distances[n], least, 1e-5);
        EXPECT_NEAR(distance(place(n), place(found.nearest[n])), least, 1e-5);
    }
}

}  // namespace
}  // namespace kontur
