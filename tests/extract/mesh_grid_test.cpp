// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/mesh_grid.h"

#include <gtest/gtest.h>

#include "support/functions.h"

namespace kontur {
namespace {

SurfaceLattice ball_on(const Grid& grid, double radius) {
    return sample_everywhere(test::ball_function({}, radius), grid, {.threads = 1});
}

/// How far a place of the grid in mm lies from the nearest centre of the other, in voxels of that.
double off_centre(const Grid& grid, const Vec3& p) {
    const Vec3 at = grid.index_to_mm.inverse().apply(p);
    double worst = 0;
    for (int axis = 0; axis < 3; ++axis) worst = std::max(worst, std::abs(at[axis] - std::round(at[axis])));
    return worst;
}

TEST(MeshGrid, SplitsWideVoxelsAboutTheirCentresAndEndsOnTheirFaces) {
    for (const Affine3& change : {Affine3{}, test::kOblique, test::kSheared, test::kMirrored}) {
        const Grid grid = test::changed(test::grid_about({}, {9, 8, 7}, 5), change);
        const Grid fine = mesh_grid(ball_on(grid, 15), {}, 0.8);
        const Vec3 spacing = fine.spacing_mm();
        for (int axis = 0; axis < 3; ++axis) EXPECT_LE(spacing[axis], 0.8 + 1e-9);
        for (std::int64_t i = 0; i < 3; ++i) EXPECT_LT(off_centre(fine, grid.center_mm(4 + i, 4 - i, 3)), 1e-9);
        EXPECT_NEAR(distance(fine.bounds_mm().min, grid.bounds_mm().min), 0, 1e-9) << "the ball fills the grid";
        EXPECT_NEAR(distance(fine.bounds_mm().max, grid.bounds_mm().max), 0, 1e-9);
    }
}

TEST(MeshGrid, IsTheGridWhereItsVoxelsAreNarrowEnough) {
    const Grid grid = test::grid_about({}, {50, 50, 50}, 1);
    EXPECT_EQ(mesh_grid(ball_on(grid, 15), {}, 1), grid);
    EXPECT_NE(mesh_grid(ball_on(grid, 15), {}, 0.99), grid);
}

TEST(MeshGrid, CoversTheObjectAndTheStartsAlone) {
    const Grid grid = test::grid_about({}, {100, 100, 100}, 4);
    const Grid fine = mesh_grid(ball_on(grid, 10), std::vector<Vec3>{{60, 0, 0}, {0, 1e9, 0}}, 0.3);
    EXPECT_EQ(fine.spacing_mm().x, fine.spacing_mm().y);
    EXPECT_TRUE(fine.bounds_mm().contains({60, 10, 10}) && fine.bounds_mm().contains({-11, -11, -11}));
    EXPECT_LT(fine.bounds_mm().max.z, 10 + 4 * 4);
    EXPECT_LT(fine.voxel_count(), std::int64_t{1} << 33);
}

TEST(MeshGrid, OfNothingIsTheGrid) {
    const Grid grid = test::grid_about({}, {10, 10, 10}, 4);
    EXPECT_EQ(mesh_grid({Lattice(grid), {}, 0}, {}, 1), grid);
}

}  // namespace
}  // namespace kontur
