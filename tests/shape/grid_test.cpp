// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/grid.h"

#include <gtest/gtest.h>

#include <limits>

#include "kontur/base/error.h"
#include "support/expect_error.h"

namespace kontur {
namespace {

/// 4 x 3 x 2 voxels with axes that are neither orthogonal nor right-handed.
Grid sheared_grid() {
    Grid grid{{4, 3, 2}, {}};
    grid.index_to_mm.set_column(0, {0, 2, 0});
    grid.index_to_mm.set_column(1, {3, 0, 0});
    grid.index_to_mm.set_column(2, {0, 3, 4});
    grid.index_to_mm.translation = {10, 20, 30};
    return grid;
}

ErrorKind kind_of_check(const Grid& grid) {
    try {
        check_grid(grid);
    } catch (const Error& error) {
        return error.kind();
    }
    ADD_FAILURE() << "no Error";
    return ErrorKind::io;
}

TEST(Grid, SpacingIsTheLengthOfOneStepAlongEachAxis) { EXPECT_EQ(sheared_grid().spacing_mm(), (Vec3{2, 3, 5})); }

TEST(Grid, VoxelVolumeOfShearedAxesIsTheDeterminant) { EXPECT_DOUBLE_EQ(sheared_grid().voxel_volume_mm3(), 24); }

TEST(Grid, OffsetRunsFastestAlongI) {
    const Grid grid = sheared_grid();
    std::size_t expected = 0;
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 4; ++i) EXPECT_EQ(grid.offset(i, j, k), expected++);
}

TEST(Grid, BoundsContainAllVoxelsAndTouchTheOuterFaces) {
    const Box3 box = sheared_grid().bounds_mm();
    EXPECT_EQ(box.min, (Vec3{10 - 1.5, 20 - 1 - 1.5, 30 - 2}));
    EXPECT_EQ(box.max, (Vec3{10 + 6 + 1.5, 20 + 6 + 1 + 3 + 1.5, 30 + 4 + 2}));
}

TEST(CheckGrid, AcceptsShearedLeftHandedAxes) { EXPECT_NO_THROW(check_grid(sheared_grid())); }

TEST(CheckGrid, RefusesEmptyHugeAndFlatGrids) {
    for (const std::int64_t size : {std::int64_t{0}, std::int64_t{-1}, std::numeric_limits<std::int64_t>::min()}) {
        Grid grid = sheared_grid();
        grid.size.j = size;
        EXPECT_EQ(kind_of_check(grid), ErrorKind::invalid_input);
    }
    Grid huge = sheared_grid();
    huge.size = {std::int64_t{1} << 32, std::int64_t{1} << 32, 1};
    EXPECT_EQ(kind_of_check(huge), ErrorKind::too_large);
    Grid flat = sheared_grid();
    flat.index_to_mm.set_column(2, {});
    EXPECT_EQ(kind_of_check(flat), ErrorKind::invalid_input);
    flat.index_to_mm.set_column(2, {0, 0, std::numeric_limits<double>::quiet_NaN()});
    EXPECT_EQ(kind_of_check(flat), ErrorKind::invalid_input);
}

TEST(GridAround, CoversTheBoxWithMarginByLessThanOneSurplusVoxel) {
    const Box3 box{{-3, 5, 100}, {4.2, 5, 131}};
    const Vec3 spacing{0.7, 1.3, 2};
    const Grid grid = grid_around(box, spacing, 2.5);
    const Box3 bounds = grid.bounds_mm(), needed = box.padded(2.5);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(bounds.min[axis], needed.min[axis] + 1e-8);
        EXPECT_GE(bounds.max[axis], needed.max[axis] - 1e-8);
        EXPECT_LT(bounds.size()[axis] - needed.size()[axis], spacing[axis]);
    }
    EXPECT_LT(norm(grid.spacing_mm() - spacing), 1e-15);
}

TEST(GridAround, RoundingNoiseAddsNoVoxel) {
    const Grid grid = grid_around({{0, 0, 0}, {0.3, 3, 30}}, {0.1, 0.1, 0.1}, 0);
    EXPECT_EQ(grid.size, (Index3{3, 30, 300}));
}

TEST(GridAround, RefusesBadSpacingAndBoxes) {
    const Box3 box{{0, 0, 0}, {1, 1, 1}};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(grid_around(box, {1, 0, 1}, 0), Error);
    EXPECT_THROW(grid_around(box, {1, 1, -1}, 0), Error);
    EXPECT_THROW(grid_around(box, {nan, 1, 1}, 0), Error);
    EXPECT_THROW(grid_around(Box3{}, {1, 1, 1}, 0), Error);
    EXPECT_THROW(grid_around(box, {1e-9, 1e-9, 1e-9}, 0), Error);
    EXPECT_THROW(grid_around(box, {1, 1, 1}, nan), Error);
    EXPECT_KONTUR_ERROR(grid_around(box, {1e-9, 1, 1}, 1e300), ErrorKind::too_large, "spacing of 1e-09 mm over 2e+300 mm");
}

TEST(CornerDistance, SeesARotationThatTheOriginDoesNotShow) {
    const Grid a = sheared_grid();
    Grid b = a;
    b.index_to_mm.set_column(2, {0, 3, 4.5});
    EXPECT_DOUBLE_EQ(corner_distance_mm(a, b), 0.5);
    EXPECT_EQ(corner_distance_mm(a, a), 0);
    b.size.k = 3;
    EXPECT_EQ(corner_distance_mm(a, b), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace kontur
