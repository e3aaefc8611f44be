// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/painted_object.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/label_maps.h"

namespace kontur {
namespace {

using test::index_grid;
using test::label_map;

TEST(TouchingLabels, AreJoinedFaceToFace) {
    // 1 and 2 touch along i, 2 and 3 along k, 5 and 6 along j; 4 only meets 3 at an edge.
    const Image map = label_map(index_grid({4, 4, 4}), [](const Index3& at) {
        const auto is = [&](std::int64_t i, std::int64_t j, std::int64_t k) { return at == Index3{i, j, k}; };
        return is(0, 0, 0) ? 1 : is(1, 0, 0) ? 2 : is(1, 0, 1) ? 3 : is(2, 1, 1) ? 4 : is(0, 2, 3) ? 5 : is(0, 3, 3) ? 6 : 0;
    });
    EXPECT_EQ(touching_labels(map), (std::vector<std::vector<std::int64_t>>{{1, 2, 3}, {5, 6}}));
}

/// Two boxes side by side; the second was painted on every second slice of the first alone, and reaches farther.
Image two_boxes() {
    return label_map(index_grid({24, 12, 33}), [](const Index3& at) {
        if (at.j < 3 || at.j > 8) return 0;
        if (at.i >= 3 && at.i < 10 && at.k % 4 == 0 && at.k <= 24) return 1;
        return at.i >= 10 && at.i < 18 && at.k % 8 == 0 ? 2 : 0;
    });
}

TEST(United, HoldsTheSlicesOnWhichAllWerePainted) {
    const Image map = two_boxes();
    const auto boxes = label_boxes(map);
    const PaintedObject one = painted_object(map, 1, boxes.at(1), 3), two = painted_object(map, 2, boxes.at(2), 3);
    EXPECT_EQ(one.indices(2), (std::vector<std::int64_t>{0, 4, 8, 12, 16, 20, 24}));
    const std::array objects{&one, &two};
    const PaintedObject all = united(objects, map.grid);
    EXPECT_EQ(all.indices(2), (std::vector<std::int64_t>{0, 8, 16, 24, 32}));
    EXPECT_EQ(all.only_axis(), 2);
    for (const PaintedSlice& slice : all.slices) {
        const std::int64_t k = slice.index + all.box.low.k;
        EXPECT_EQ(std::count(slice.section.begin(), slice.section.end(), 1), 6 * (k <= 24 ? 15 : 8)) << k;
    }
}

TEST(PaintedObject, KnowsWhatWholeSlicesSay) {
    const Image map = two_boxes();
    const PaintedObject object = painted_object(map, 1, label_boxes(map).at(1), 3);
    EXPECT_TRUE(object.is_known({0, 0, 8}));
    EXPECT_FALSE(object.is_known({5, 5, 9}));
    EXPECT_FALSE(object.is_known({5, 5, 32}));
}

}  // namespace
}  // namespace kontur
