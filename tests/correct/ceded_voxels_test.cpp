// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/ceded_voxels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "support/mask_of.h"

namespace kontur {
namespace {

Grid thick_slices() { return grid_around({{-12, -12, -12}, {12, 12, 12}}, {1, 1.5, 3}, 0); }

double squared_mm(const Grid& grid, std::size_t a, std::size_t b) {
    const Index3 p = index_at(a, grid.size), q = index_at(b, grid.size);
    const Vec3 way = grid.center_mm(p.i, p.j, p.k) - grid.center_mm(q.i, q.j, q.k);
    return dot(way, way);
}

TEST(CededVoxels, EachGoesToTheNearestVoxelThatWasLeftOut) {
    const Grid grid = thick_slices();
    const Mask before = test::mask_of(grid, [](const Vec3& p) { return norm(p) < 8; });
    const Mask after = test::mask_of(grid, [](const Vec3& p) { return norm(p) < 8 && p.x < 3; });
    const std::vector<CededVoxel> ceded = ceded_voxels(before, after);
    std::size_t next = 0;
    for (std::size_t n = 0; n < before.values.size(); ++n) {
        if (before.values[n] == 0 || after.values[n] != 0) continue;
        ASSERT_LT(next, ceded.size());
        const CededVoxel& voxel = ceded[next++];
        EXPECT_EQ(voxel.offset, n);
        EXPECT_EQ(before.values[voxel.neighbor], 0);
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t m = 0; m < before.values.size(); ++m)
            if (before.values[m] == 0) nearest = std::min(nearest, squared_mm(grid, n, m));
        EXPECT_NEAR(squared_mm(grid, n, voxel.neighbor), nearest, 1e-3);
    }
    EXPECT_EQ(next, ceded.size());
    EXPECT_GT(next, 100U);
}

TEST(CededVoxels, NoneOfAMaskThatFillsItsGridOrLosesNothing) {
    const Grid grid = thick_slices();
    const Mask whole = test::mask_of(grid, [](const Vec3&) { return true; });
    const Mask none = test::mask_of(grid, [](const Vec3&) { return false; });
    const Mask ball = test::mask_of(grid, [](const Vec3& p) { return norm(p) < 8; });
    EXPECT_TRUE(ceded_voxels(whole, ball).empty());
    EXPECT_TRUE(ceded_voxels(none, ball).empty());
    EXPECT_TRUE(ceded_voxels(ball, whole).empty());
    EXPECT_EQ(ceded_voxels(ball, ball).size(), 0U);
}

}  // namespace
}  // namespace kontur
