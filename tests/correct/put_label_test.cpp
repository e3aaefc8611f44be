// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/put_label.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/expect_error.h"
#include "support/mask_of.h"

namespace kontur {
namespace {

const Grid kGrid = grid_around({{-10, -10, -4}, {10, 10, 4}}, {1, 1, 2}, 0);

/// 3 where x < 0, else 7, within 8 of the middle line.
Image halves() {
    Image labels{kGrid, std::vector<std::int16_t>(static_cast<std::size_t>(kGrid.voxel_count()))};
    auto& values = std::get<std::vector<std::int16_t>>(labels.samples);
    for (std::size_t n = 0; n < values.size(); ++n) {
        const Index3 v = index_at(n, kGrid.size);
        const Vec3 p = kGrid.center_mm(v.i, v.j, v.k);
        if (p.x * p.x + p.y * p.y < 64) values[n] = p.x < 0 ? 3 : 7;
    }
    return labels;
}

Mask of_label(double from, double to) {
    return test::mask_of(kGrid, [=](const Vec3& p) { return p.x * p.x + p.y * p.y < 64 && p.x >= from && p.x < to; });
}

std::int64_t count(const Image& labels, std::int64_t label) {
    const auto& values = std::get<std::vector<std::int16_t>>(labels.samples);
    return std::ranges::count(values, label);
}

TEST(PutLabel, WhatItLeavesIsNobodysOrTheNeighbors) {
    const Mask before = of_label(-20, 0), after = of_label(-20, -2);
    const Image labels = halves();
    const std::int64_t left = std::ranges::count(before.values, 1) - std::ranges::count(after.values, 1);
    const PutLabel alone = put_label(labels, {3, before, after});
    EXPECT_EQ(count(alone.labels, 3), std::ranges::count(after.values, 1));
    EXPECT_EQ(count(alone.labels, 7), count(labels, 7));
    EXPECT_TRUE(alone.passed.empty());
    const PutLabel shared = put_label(labels, {3, before, after}, true);
    ASSERT_EQ(shared.passed.size(), 1U);
    EXPECT_EQ(shared.passed.front().from, 3);
    EXPECT_EQ(shared.passed.front().to, 7);
    EXPECT_GT(shared.passed.front().count, 0U);
    EXPECT_LE(static_cast<std::int64_t>(shared.passed.front().count), left) << "the rest touched nothing";
    EXPECT_EQ(count(shared.labels, 7), count(labels, 7) + static_cast<std::int64_t>(shared.passed.front().count));
    EXPECT_EQ(count(shared.labels, 3), count(alone.labels, 3));
}

TEST(PutLabel, WhatItTakesIsTheNeighborsNoMore) {
    const Mask before = of_label(-20, 0), after = of_label(-20, 3);
    const PutLabel put = put_label(halves(), {3, before, after}, true);
    const auto taken = static_cast<std::size_t>(std::ranges::count(after.values, 1) - std::ranges::count(before.values, 1));
    EXPECT_EQ(put.passed, (std::vector<PassedVoxels>{{7, 3, taken}}));
    EXPECT_EQ(count(put.labels, 3), std::ranges::count(after.values, 1));
    EXPECT_EQ(put_label(halves(), {3, before, before}, true).labels.samples, halves().samples) << "nothing was corrected";
}

TEST(PutLabel, RefusesOtherGridsAndLabelsWithoutRoom) {
    const Mask before = of_label(-20, 0);
    Mask other = before;
    other.grid.index_to_mm.translation.x += 1;
    EXPECT_KONTUR_ERROR(put_label(halves(), {3, before, other}), ErrorKind::invalid_input, "1 is needed");
    EXPECT_KONTUR_ERROR(put_label(halves(), {70000, before, before}), ErrorKind::invalid_input,
                        "have no room for the label 70000");
}

}  // namespace
}  // namespace kontur
