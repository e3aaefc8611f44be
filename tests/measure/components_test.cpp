// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/components.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "kontur/base/error.h"
#include "support/random_masks.h"

namespace kontur {
namespace {

/// Flood fill, voxel by voxel.
std::vector<std::int64_t> flooded_sizes(Mask mask) {
    const Index3 size = mask.grid.size;
    const auto is_inside = [&](const Index3& v) {
        for (int axis = 0; axis < 3; ++axis)
            if (v[axis] < 0 || v[axis] >= size[axis]) return false;
        return mask.values[mask.grid.offset(v.i, v.j, v.k)] != 0;
    };
    std::vector<std::int64_t> sizes;
    for (std::size_t start = 0; start < mask.values.size(); ++start) {
        if (mask.values[start] == 0) continue;
        const auto at = static_cast<std::int64_t>(start);
        std::vector<Index3> open{{at % size.i, at / size.i % size.j, at / size.i / size.j}};
        std::int64_t count = 0;
        while (!open.empty()) {
            const Index3 v = open.back();
            open.pop_back();
            if (!is_inside(v)) continue;
            mask.values[mask.grid.offset(v.i, v.j, v.k)] = 0;
            ++count;
            for (int axis = 0; axis < 3; ++axis)
                for (const int step : {-1, 1}) {
                    Index3 next = v;
                    next[axis] += step;
                    open.push_back(next);
                }
        }
        sizes.push_back(count);
    }
    std::sort(sizes.begin(), sizes.end(), std::greater<>{});
    return sizes;
}

TEST(ComponentSizes, AgreesWithFloodFillOnRandomMasks) {
    std::mt19937 random = test::random_of_this_test();
    for (const Index3& size : {Index3{1, 1, 1}, {9, 1, 1}, {1, 9, 1}, {1, 1, 9}, {8, 9, 1}, {11, 7, 13}, {30, 20, 10}})
        for (const double probability : {0.0, 0.1, 0.3, 0.5, 0.7, 1.0}) {
            const Mask mask = test::random_mask({size, {}}, probability, random);
            ASSERT_EQ(component_sizes(mask), flooded_sizes(mask))
                << size.i << " " << size.j << " " << size.k << " " << probability;
        }
}

TEST(ComponentSizes, EveryMaskOfTwoByTwoByThreeVoxels) {
    Mask mask{{{2, 2, 3}, {}}, std::vector<std::uint8_t>(12)};
    for (int bits = 0; bits < 1 << 12; ++bits) {
        for (int v = 0; v < 12; ++v) mask.values[v] = bits >> v & 1;
        ASSERT_EQ(component_sizes(mask), flooded_sizes(mask)) << bits;
    }
}

TEST(ComponentSizes, EdgesAndCornersDoNotConnect) {
    Mask mask{{{6, 6, 6}, {}}, std::vector<std::uint8_t>(216)};
    for (int v = 0; v < 216; ++v) mask.values[v] = (v % 6 + v / 6 % 6 + v / 36) % 2 == 1;
    EXPECT_EQ(component_sizes(mask), std::vector<std::int64_t>(108, 1));
}

TEST(ComponentSizes, AnyValueButZeroIsInside) {
    const Mask mask{{{5, 1, 1}, {}}, {7, 255, 0, 1, 0}};
    EXPECT_EQ(component_sizes(mask), (std::vector<std::int64_t>{2, 1}));
}

TEST(ComponentSizes, RefusesAMaskWithoutItsVoxels) { EXPECT_THROW(component_sizes({{{2, 2, 2}, {}}, {1, 1}}), Error); }

}  // namespace
}  // namespace kontur
