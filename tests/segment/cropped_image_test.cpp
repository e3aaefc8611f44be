// SPDX-License-Identifier: Apache-2.0
// Images that hold a part of what was drawn, and voxels that are coarse beside it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kontur/memory_estimate.h"
#include "kontur/segment.h"
#include "support/contour_sets.h"
#include "support/expect_error.h"

namespace kontur {
namespace {

Contour circle_at(const Vec3& center, double radius, const Vec3& normal = {0, 0, 1}) {
    return test::circle(make_plane(center, normal), radius, 40);
}

Grid image(const Index3& size, const Vec3& first, const Vec3& spacing = {1, 1, 1}) {
    Grid grid{size, {}};
    for (int axis = 0; axis < 3; ++axis)
        grid.index_to_mm.linear[static_cast<std::size_t>(axis)][static_cast<std::size_t>(axis)] = spacing[axis];
    grid.index_to_mm.translation = first;
    return grid;
}

ContourSet tube(double x = 0) {
    ContourSet set;
    for (const double z : {0.0, 30.0, 60.0}) set.contours.push_back(circle_at({x, 0, z}, 18));
    return set;
}

Segmentation segmented(const ContourSet& set, const Grid& grid, Voxelizer voxelizer, bool mesh = false) {
    SegmentOptions options;
    options.voxelizer = voxelizer;
    options.mesh = mesh;
    return segment(set, grid, options);
}

constexpr Voxelizer kFollowing[] = {Voxelizer::adaptive, Voxelizer::tracked};

TEST(CroppedImage, BetweenTwoDrawnPlanesHoldsThePartOfTheObjectThere) {
    for (const Grid& grid : {image({60, 60, 11}, {-30, -30, 10}), image({11, 11, 60}, {-5, -5, 2}),
                             image({11, 11, 11}, {-5, -5, 25}), image({30, 11, 11}, {0, -5, 33})}) {
        const Segmentation all = segmented(tube(), grid, Voxelizer::exhaustive);
        EXPECT_GT(all.report.mask_voxels, 1000);
        for (const Voxelizer voxelizer : kFollowing) {
            const Segmentation found = segmented(tube(), grid, voxelizer, true);
            EXPECT_EQ(found.mask.values, all.mask.values) << name(voxelizer);
            const double mesh_ml = signed_volume_mm3(*found.mesh) / 1000;
            EXPECT_NEAR(mesh_ml, all.report.mask_volume_ml, 0.05 * all.report.mask_volume_ml);
            EXPECT_TRUE(topology(*found.mesh).closed);
        }
    }
}

TEST(CroppedImage, HoldsPartsOfWhichAllPointsLieOutside) {
    ContourSet two = tube(-40);
    for (const Contour& contour : tube(40).contours) two.contours.push_back(contour);
    ContourSet sagittal = two;
    Contour& along = sagittal.contours.emplace_back(circle_at({40, 0, 30}, 18, {1, 0, 0}));
    for (Vec3& p : along.points) p.z = 30 + 2.1 * (p.z - 30);
    for (const ContourSet& set : {two, sagittal}) {
        const Grid grid = image({130, 50, 11}, {-65, -25, 10});
        const Segmentation all = segmented(set, grid, Voxelizer::exhaustive);
        EXPECT_EQ(all.report.mask_components, 2);
        for (const Voxelizer voxelizer : kFollowing) EXPECT_EQ(segmented(set, grid, voxelizer).mask.values, all.mask.values);
    }
}

TEST(CroppedImage, OfVoxelsFarSmallerThanTheObjectCostsNoMore) {
    for (const double spacing : {1e-2, 1e-7}) {
        const Grid grid = image({10, 10, 10}, {1, 2, 40}, {spacing, spacing, spacing});
        const Segmentation found = segmented(tube(), grid, Voxelizer::adaptive);
        EXPECT_EQ(found.report.mask_voxels, 1000);
        EXPECT_LT(found.report.evaluations, 300'000);
    }
}

TEST(CroppedImage, BesideTheContoursIsRefused) {
    EXPECT_KONTUR_ERROR(segmented(tube(), image({20, 20, 20}, {100, 0, 0}), Voxelizer::adaptive), ErrorKind::invalid_input,
                        "lie outside of the image");
}

TEST(CroppedImage, OfTinyVoxelsHasAnEstimateOfMemoryThatIsPositiveAndSmall) {
    const Drawing drawing(tube());
    const PreparedContours prepared = prepare(drawing);
    for (const double spacing : {1.0, 1e-3, 1e-7, 1e-8}) {
        const double mb = estimated_memory_mb(drawing, prepared,
                                              image({10, 10, 10}, {18, 0, 0}, {spacing, spacing, spacing}), {.mesh = true});
        EXPECT_GT(mb, 0);
        EXPECT_LT(mb, 1000);
    }
}

TEST(CoarseImage, FindsAThinWallBetweenItsSlices) {
    ContourSet shell;
    for (double z = -28; z < 29; z += 4)
        for (const double radius : {30.0, 28.0})
            if (radius * radius - z * z > 1)
                shell.contours.push_back(circle_at({0, 0, z}, std::sqrt(radius * radius - z * z)));
    const Grid grid = grid_around(bounding_box(shell), {0.5, 0.5, 4}, 4);
    const Segmentation all = segmented(shell, grid, Voxelizer::exhaustive);
    for (const Voxelizer voxelizer : kFollowing) {
        const Segmentation found = segmented(shell, grid, voxelizer);
        EXPECT_NEAR(static_cast<double>(found.report.mask_voxels), static_cast<double>(all.report.mask_voxels), 2);
    }
}

TEST(CoarseImage, MeshHasTheObjectsVolume) {
    for (const auto& [radius, spacing] : {std::pair{5.0, Vec3{1, 1, 5}},
                                          {5.0, Vec3{3, 3, 3}},
                                          {5.0, Vec3{1, 1, 1}},
                                          {10.0, Vec3{5, 5, 5}},
                                          {20.0, Vec3{0.8, 0.8, 5}}}) {
        ContourSet ball;
        for (const Vec3& normal : {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}})
            ball.contours.push_back(circle_at({0.3, 0.1, 0.2}, radius, normal));
        const Grid grid = grid_around(bounding_box(ball), spacing, 2 * spacing.z);
        const Segmentation made = segmented(ball, grid, Voxelizer::adaptive, true);
        const double exact = 4.0 / 3 * std::numbers::pi * std::pow(radius, 3);
        EXPECT_NEAR(signed_volume_mm3(*made.mesh), exact, 0.01 * exact) << radius << " at " << spacing.z;
        EXPECT_TRUE(topology(*made.mesh).closed && topology(*made.mesh).oriented);
        EXPECT_LT(made.mesh->triangles.size(), 60'000u);
    }
}

}  // namespace
}  // namespace kontur
