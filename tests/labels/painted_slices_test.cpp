// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/painted_slices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "kontur/labels/label_boxes.h"
#include "support/label_maps.h"

namespace kontur {
namespace {

using test::index_grid;
using test::is_in_ball;
using test::label_map;

using Place = std::pair<int, std::int64_t>;  // axis, index

constexpr Vec3 kCenter{20, 20, 20};

Mask mask_where(const std::function<bool(const Index3&)>& painted, const Index3& size = {41, 41, 41}) {
    return select_nonzero(label_map(index_grid(size), painted));
}

/// A ball of which slices are painted.
Mask ball_where(const std::function<bool(const Index3&)>& painted) {
    return mask_where([&](const Index3& at) { return is_in_ball(at, kCenter, 15.3) && painted(at); });
}

std::set<Place> places(const std::vector<PaintedSlice>& slices) {
    std::set<Place> found;
    for (const PaintedSlice& slice : slices) found.insert({slice.axis, slice.index});
    return found;
}

std::int64_t area(const PaintedSlice& slice) { return std::count(slice.section.begin(), slice.section.end(), 1); }

const PaintedSlice& slice_at(const std::vector<PaintedSlice>& slices, const Place& place) {
    return *std::find_if(slices.begin(), slices.end(), [&](const PaintedSlice& slice) {
        return Place{slice.axis, slice.index} == place;
    });
}

TEST(PaintedSlices, EverySliceAcrossEachAxisIsFound) {
    for (int axis = 0; axis < 3; ++axis)
        for (const std::int64_t step : {2, 3, 5, 8}) {
            const auto slices = find_painted_slices(ball_where([&](const Index3& at) { return at[axis] % step == 0; }));
            std::set<Place> expected;
            for (std::int64_t n = 0; n < 41; ++n)
                if (n % step == 0 && std::abs(n - 20) <= 15) expected.insert({axis, n});
            EXPECT_EQ(places(slices), expected) << "axis " << axis << ", every " << step;
            for (const PaintedSlice& slice : slices) EXPECT_TRUE(slice.whole);
        }
}

TEST(PaintedSlices, SingleSlicesOfThreeDirections) {
    const Mask mask = ball_where([](const Index3& at) { return at.i == 17 || at.j == 22 || at.k == 20; });
    const auto slices = find_painted_slices(mask);
    EXPECT_EQ(places(slices), (std::set<Place>{{0, 17}, {1, 22}, {2, 20}}));
    const Mask whole = ball_where([](const Index3&) { return true; });
    for (const PaintedSlice& slice : slices) {
        EXPECT_TRUE(slice.whole);
        std::int64_t expected = 0;
        for (std::size_t n = 0, count = whole.values.size(); n < count; ++n) {
            const auto m = static_cast<std::int64_t>(n);
            const Index3 at{m % 41, m / 41 % 41, m / (41 * 41)};
            expected += whole.values[n] && at[slice.axis] == slice.index;
        }
        EXPECT_EQ(area(slice), expected);
    }
}

TEST(PaintedSlices, SlicesSideBySideAreAllFound) {
    const auto slices = find_painted_slices(ball_where([](const Index3& at) { return at.k % 10 < 3; }));
    std::set<Place> expected;
    for (std::int64_t k = 5; k <= 35; ++k)
        if (k % 10 < 3) expected.insert({2, k});
    EXPECT_EQ(places(slices), expected);
}

TEST(PaintedSlices, TracesOfOtherSlicesAreNoSections) {
    // Across k only the left half was painted; the slice across j shows the right one, too.
    const auto slices = find_painted_slices(
        ball_where([](const Index3& at) { return at.j == 20 || ((at.k == 14 || at.k == 26) && at.i <= 20); }));
    EXPECT_EQ(places(slices), (std::set<Place>{{1, 20}, {2, 14}, {2, 26}}));
    const PaintedSlice& half = slice_at(slices, {2, 14});
    EXPECT_FALSE(half.whole);
    for (std::int64_t i = 23; i < 41; ++i) EXPECT_EQ(half.section[static_cast<std::size_t>(i + 41 * 20)], 0) << i;
    EXPECT_EQ(half.section[static_cast<std::size_t>(15 + 41 * 20)], 1);
    EXPECT_TRUE(slice_at(slices, {1, 20}).whole);
}

TEST(PaintedSlices, HolesAndBranchesStay) {
    // A shell beside a ball.
    const auto is_painted = [](const Index3& at) {
        const bool shell = is_in_ball(at, {14, 20, 20}, 11) && !is_in_ball(at, {14, 20, 20}, 6);
        return (shell || is_in_ball(at, {33, 20, 20}, 6)) && at.k % 4 == 0;
    };
    const auto slices = find_painted_slices(mask_where(is_painted));
    std::int64_t painted = 0;
    for (const PaintedSlice& slice : slices) {
        EXPECT_EQ(slice.axis, 2);
        for (std::int64_t n = 0; n < 41 * 41; ++n)
            EXPECT_EQ(slice.section[static_cast<std::size_t>(n)], is_painted({n % 41, n / 41, slice.index}));
        painted += area(slice);
    }
    const Mask mask = mask_where(is_painted);
    EXPECT_EQ(painted, std::count(mask.values.begin(), mask.values.end(), 1));
}

TEST(PaintedSlices, AThinTubeAlongTheStackIsCutAcross) {
    // The slice along the tube would hold more voxels than any across it.
    const auto slices = find_painted_slices(mask_where(
        [](const Index3& at) {
            return is_in_ball({at.i, at.j, 0}, {4, 4, 0}, 2.6) && at.k % 4 == 1;
        },
        {9, 9, 121}));
    ASSERT_EQ(slices.size(), 30U);
    for (const PaintedSlice& slice : slices) EXPECT_EQ(slice.axis, 2);
}

TEST(PaintedSlices, ASolidIsCutAcrossOneAxis) {
    const auto slices = find_painted_slices(ball_where([](const Index3&) { return true; }));
    std::set<int> axes;
    for (const PaintedSlice& slice : slices) {
        axes.insert(slice.axis);
        EXPECT_TRUE(slice.whole);
    }
    EXPECT_EQ(axes.size(), 1U);
    EXPECT_EQ(slices.size(), 31U);
}

TEST(PaintedSlices, ASolidAmongSlicesIsCutAsTheyAre) {
    const auto slices =
        find_painted_slices(ball_where([](const Index3& at) { return at.j % 6 == 0 || (at.j > 14 && at.j < 20); }));
    for (const PaintedSlice& slice : slices) EXPECT_EQ(slice.axis, 1);
    EXPECT_EQ(slices.size(), 9U);
}

TEST(PaintedSlices, EveryPaintedVoxelLiesInASection) {
    for (const std::uint32_t seed : {1U, 2U, 3U, 4U, 5U}) {
        std::uint32_t state = seed * 2654435761U;
        const Mask mask = mask_where(
            [&](const Index3& at) {
                state = state * 1664525U + 1013904223U;
                return (at.k % 3 == 0 && state >> 28 < 12) || state >> 24 == 7;
            },
            {13, 11, 9});
        std::vector<std::uint8_t> covered(mask.values.size());
        for (const PaintedSlice& slice : find_painted_slices(mask)) {
            const auto [u, v] = slice_axes(slice.axis);
            for (std::int64_t b = 0; b < mask.grid.size[v]; ++b)
                for (std::int64_t a = 0; a < mask.grid.size[u]; ++a) {
                    Index3 at;
                    at[slice.axis] = slice.index, at[u] = a, at[v] = b;
                    if (slice.section[static_cast<std::size_t>(a + mask.grid.size[u] * b)])
                        covered[mask.grid.offset(at.i, at.j, at.k)] = 1;
                }
        }
        EXPECT_EQ(covered, mask.values) << "seed " << seed;
    }
}

TEST(PaintedSlices, NothingPaintedGivesNone) {
    EXPECT_TRUE(find_painted_slices(mask_where([](const Index3&) { return false; })).empty());
}

}  // namespace
}  // namespace kontur
