// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/inside_box.h"

#include <gtest/gtest.h>

namespace kontur {
namespace {

Mask speckled() {
    Mask mask{{{5, 4, 3}, {}}, std::vector<std::uint8_t>(60)};
    for (const std::size_t n : {7, 12, 33, 48}) mask.values[n] = 1;
    return mask;
}

bool is_inside(const Mask& mask, const Index3& at) {
    for (int axis = 0; axis < 3; ++axis)
        if (at[axis] < 0 || at[axis] >= mask.grid.size[axis]) return false;
    return mask.values[mask.grid.offset(at.i, at.j, at.k)] != 0;
}

TEST(InsideBox, IsTheSmallestAroundTheObject) {
    const std::optional<IndexBox> box = inside_box(speckled());
    ASSERT_TRUE(box);
    EXPECT_EQ(box->low, (Index3{2, 1, 0}));
    EXPECT_EQ(box->high, (Index3{3, 2, 2}));
    EXPECT_FALSE(inside_box(Mask{{{5, 4, 3}, {}}, std::vector<std::uint8_t>(60)}));
}

TEST(ObjectVoxels, AreThoseOfTheMaskAndNoneBeyondItsGrid) {
    const Mask mask = speckled();
    for (const IndexBox& box :
         {IndexBox{{0, 0, 0}, {4, 3, 2}}, IndexBox{{1, 1, 0}, {3, 2, 1}}, IndexBox{{-2, -1, -3}, {6, 5, 4}},
          IndexBox{{5, 0, 0}, {7, 3, 2}}, IndexBox{{-3, 0, 0}, {-1, 3, 2}}}) {
        const std::vector<std::uint8_t> inside = object_voxels(mask, box);
        std::size_t n = 0;
        for (std::int64_t k = box.low.k; k <= box.high.k; ++k)
            for (std::int64_t j = box.low.j; j <= box.high.j; ++j)
                for (std::int64_t i = box.low.i; i <= box.high.i; ++i)
                    EXPECT_EQ(inside.at(n++) != 0, is_inside(mask, {i, j, k})) << i << ' ' << j << ' ' << k;
        EXPECT_EQ(n, inside.size());
    }
}

}  // namespace
}  // namespace kontur
