// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/boxed_mask.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/label_maps.h"

namespace kontur {
namespace {

/// What of an object in a grid of 20 x 20 x 20 voxels lies in a box.
BoxedMask boxed(const IndexBox& box, const std::function<bool(const Index3&)>& is_inside) {
    const Grid grid = test::index_grid({20, 20, 20});
    BoxedMask object{box, {grid_of(grid, box), {}}};
    object.mask.values.resize(static_cast<std::size_t>(object.mask.grid.voxel_count()));
    for (std::int64_t k = box.low.k; k <= box.high.k; ++k)
        for (std::int64_t j = box.low.j; j <= box.high.j; ++j)
            for (std::int64_t i = box.low.i; i <= box.high.i; ++i) object.set({i, j, k}, is_inside({i, j, k}));
    return object;
}

bool in_a(const Index3& at) { return test::is_in_ball(at, {8, 9, 10}, 4.2); }
bool in_b(const Index3& at) { return test::is_in_ball(at, {13, 9, 10}, 3.4); }

TEST(BoxedMask, ATrimmedAndWidenedObjectIsTheSame) {
    const Grid grid = test::index_grid({20, 20, 20});
    const BoxedMask loose = boxed({{1, 0, 3}, {19, 18, 17}}, in_a), tight = trimmed(loose, grid);
    EXPECT_EQ(tight.box.low, (Index3{4, 5, 6}));
    EXPECT_EQ(tight.box.high, (Index3{12, 13, 14}));
    EXPECT_EQ(tight.mask.grid.center_mm(0, 0, 0), (Vec3{4, 5, 6}));
    EXPECT_EQ(box_of_part(grid, tight.mask.grid).high, tight.box.high);
    EXPECT_EQ(widened(tight, loose.box, grid).mask.values, loose.mask.values);
}

TEST(BoxedMask, NothingIsTrimmedToOneVoxel) {
    const BoxedMask nothing =
        trimmed(boxed({{2, 3, 4}, {9, 9, 9}}, [](const Index3&) { return false; }), test::index_grid({20, 20, 20}));
    EXPECT_EQ(nothing.mask.values, std::vector<std::uint8_t>{0});
}

TEST(BoxedMask, SharedVoxelsAreThoseOfALookAtAll) {
    const BoxedMask a = boxed({{4, 5, 6}, {12, 13, 14}}, in_a), b = boxed({{9, 5, 6}, {17, 13, 14}}, in_b);
    std::size_t both = 0;
    for (std::int64_t n = 0; n < 8000; ++n) {
        const Index3 at{n % 20, n / 20 % 20, n / 400};
        both += in_a(at) && in_b(at);
    }
    const std::vector<Index3> shared = shared_voxels(a, b);
    EXPECT_EQ(shared.size(), both);
    EXPECT_GT(both, 5U);
    EXPECT_TRUE(std::all_of(shared.begin(), shared.end(), [](const Index3& at) { return in_a(at) && in_b(at); }));
}

TEST(BoxedMask, CommonFacesAreSeenOnAllSidesAndCornersAreNone) {
    const auto cube = [](const Index3& low) {
        return boxed({low, {low.i + 1, low.j + 1, low.k + 1}}, [](const Index3&) { return true; });
    };
    const BoxedMask middle = cube({8, 8, 8});
    for (std::int64_t n = 0; n < 27; ++n) {
        const Index3 step{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
        const bool beside = std::abs(step.i) + std::abs(step.j) + std::abs(step.k) == 1;
        if (n == 13) continue;
        const Index3 low{8 + 2 * step.i, 8 + 2 * step.j, 8 + 2 * step.k},
            off{8 + 3 * step.i, 8 + 3 * step.j, 8 + 3 * step.k};
        EXPECT_EQ(have_common_face(middle, cube(low)), beside) << n;
        EXPECT_FALSE(have_common_face(middle, cube(off))) << n;
    }
}

TEST(BoxedMask, ABoxInMmIsFoundInTheGridOrBesideIt) {
    const Grid grid = test::index_grid({20, 20, 20}, {2, 2, 2});
    const auto box = index_box(grid, {{3, 4.5, -10}, {7, 100, 5}});
    ASSERT_TRUE(box);
    EXPECT_EQ(box->low, (Index3{1, 2, 0}));
    EXPECT_EQ(box->high, (Index3{4, 19, 3}));
    EXPECT_FALSE(index_box(grid, {{3, 4, 50}, {7, 8, 60}}));
}

}  // namespace
}  // namespace kontur
