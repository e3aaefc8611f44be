// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/shape_interpolation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "kontur/labels/strands.h"
#include "support/label_maps.h"

namespace kontur {
namespace {

using test::index_grid;
using test::label_map;

PaintedSlice section_where(const Grid& grid, std::int64_t index, const std::function<bool(const Index3&)>& painted) {
    const Image map = label_map(index_grid({grid.size.i, grid.size.j, 1}), painted);
    return {.axis = 2, .index = index, .whole = true, .section = test::bytes_of_labels(map)};
}

TEST(SectionDistances, AreThoseOfALookAtAllVoxels) {
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        const Grid grid = index_grid({17, 13, 1}, {0.8, 1.5, 3});
        std::uint32_t state = seed;
        const PaintedSlice slice = section_where(grid, 0, [&](const Index3&) {
            state = state * 1664525U + 1013904223U;
            return state >> 24 < 30 * seed;
        });
        const std::vector<double> distances = section_distances(grid, slice);
        for (std::int64_t n = 0; n < 17 * 13; ++n) {
            double nearest = std::numeric_limits<double>::infinity();
            for (std::int64_t m = 0; m < 17 * 13; ++m)
                if (slice.section[static_cast<std::size_t>(m)] != slice.section[static_cast<std::size_t>(n)])
                    nearest = std::min(nearest, std::hypot(0.8 * double(n % 17 - m % 17), 1.5 * double(n / 17 - m / 17)));
            const double expected = slice.section[static_cast<std::size_t>(n)] ? nearest - 0.4 : 0.4 - nearest;
            EXPECT_NEAR(distances[static_cast<std::size_t>(n)], expected, 1e-9) << n;
        }
    }
}

TEST(SectionDistances, NothingPaintedIsInfinitelyFar) {
    const Grid grid = index_grid({4, 4, 1});
    for (const double distance : section_distances(grid, section_where(grid, 0, [](const Index3&) { return false; })))
        EXPECT_EQ(distance, -std::numeric_limits<double>::infinity());
}

TEST(ShapeInterpolation, AConeBetweenTwoCircles) {
    const Grid grid = index_grid({61, 61, 11}, {1, 1, 2});
    const auto disc = [](double radius) {
        return [radius](const Index3& at) { return std::hypot(double(at.i) - 30, double(at.j) - 30) < radius; };
    };
    const ShapeInterpolation shape(grid, section_where(grid, 0, disc(20)), section_where(grid, 10, disc(10)));
    const double slant = std::sqrt(1 + 0.25);  // 10 mm narrower over 20 mm of height
    EXPECT_NEAR(shape.depth({30 + 15, 30, 5}).mm, 0, 0.6);
    EXPECT_NEAR(shape.depth({30 + 12, 30, 5}).mm, 3 / slant, 0.6);
    EXPECT_NEAR(shape.depth({30 + 18, 30, 5}).mm, -3 / slant, 0.6);
}

/// Discs of 10 voxels across around (u, v).
PaintedSlice discs(const Grid& grid, std::int64_t slice, const std::vector<std::pair<double, double>>& middles) {
    return section_where(grid, slice, [&](const Index3& at) {
        return std::any_of(middles.begin(), middles.end(), [&](const auto& middle) {
            return std::hypot(double(at.i) - middle.first, double(at.j) - middle.second) < 5;
        });
    });
}

TEST(ShapeInterpolation, SectionsThatDoNotOverlapAreMovedOverEachOther) {
    const Grid grid = index_grid({61, 41, 11}, {1, 1, 2});
    const ShapeInterpolation steep(grid, discs(grid, 0, {{15, 15}}), discs(grid, 10, {{27, 20}}));
    for (std::int64_t k = 1; k < 10; ++k) {
        const std::int64_t u = 15 + std::lround(1.2 * double(k)), v = 15 + std::lround(0.5 * double(k));
        EXPECT_NEAR(steep.depth({u, v, k}).mm, 4.5, 0.8) << "its middle in slice " << k;
        EXPECT_EQ(steep.depth({u, v, k}).belief, 1);
        EXPECT_LT(steep.depth({u, v - 7, k}).mm, 0);
        EXPECT_LT(steep.depth({u - 7, v, k}).mm, 0);
    }
}

TEST(Strands, AreWhatLiesBesideEachOtherAndNear) {
    const Grid grid = index_grid({61, 41, 11}, {1, 1, 2});
    const PaintedSlice low = discs(grid, 0, {{10, 15}});
    const auto beliefs = [&](const PaintedSlice& high) {
        std::vector<double> found;
        for (const Strand& strand : find_strands(grid, low, high).strands) found.push_back(strand.belief);
        return found;
    };
    EXPECT_EQ(beliefs(discs(grid, 10, {{22, 15}})), std::vector<double>{1});
    EXPECT_TRUE(beliefs(discs(grid, 10, {{45, 15}})).empty()) << "two bodies";
    EXPECT_TRUE(beliefs(discs(grid, 10, {{13, 15}})).empty()) << "they overlap";
    const std::vector<double> little = beliefs(discs(grid, 10, {{18, 15}}));
    ASSERT_EQ(little.size(), 1U);
    EXPECT_GT(little[0], 0);
    EXPECT_LT(little[0], 1);
}

TEST(Strands, PartsOfSectionsAreMovedEachByItself) {
    const Grid grid = index_grid({101, 41, 11}, {1, 1, 2});
    const PaintedSlice low = discs(grid, 0, {{15, 15}, {70, 20}}), high = discs(grid, 10, {{27, 15}, {70, 20}});
    const Strands found = find_strands(grid, low, high);
    ASSERT_EQ(found.strands.size(), 1U) << "the upright one is none";
    EXPECT_EQ(found.strands[0].way_u, 12);
    EXPECT_EQ(found.strands[0].way_v, 0);
    const ShapeInterpolation shape(grid, low, high);
    EXPECT_GT(shape.depth({21, 15, 5}).mm, 4);
    EXPECT_GT(shape.depth({70, 20, 5}).mm, 4) << "stays where it is";
    EXPECT_EQ(shape.depth({70, 20, 5}).belief, 1) << "in both sections";
    EXPECT_LT(shape.depth({76, 20, 5}).mm, 0);
    EXPECT_EQ(shape.depth({76, 20, 5}).belief, 0);
    EXPECT_LT(shape.depth({64, 20, 5}).mm, 0);
}

TEST(Strands, OfSeveralPartsTheNearestOnesBelongTogether) {
    const Grid grid = index_grid({101, 41, 11}, {1, 1, 2});
    const Strands found = find_strands(grid, discs(grid, 0, {{15, 15}, {40, 15}}), discs(grid, 10, {{27, 15}, {52, 15}}));
    ASSERT_EQ(found.strands.size(), 2U);
    for (const Strand& strand : found.strands) EXPECT_EQ(strand.way_u, 12);
    EXPECT_TRUE(std::none_of(found.low_rest.begin(), found.low_rest.end(), [](std::uint8_t value) { return value; }));
}

TEST(ShapeInterpolation, IsTrustedLessTheFartherApartTheSlicesAre) {
    const Grid grid = index_grid({41, 41, 100});
    const auto disc = [](const Index3& at) { return std::hypot(double(at.i) - 20, double(at.j) - 20) < 10; };
    double last = 1;
    for (const std::int64_t gap : {2, 5, 10, 40}) {
        const double trust = ShapeInterpolation(grid, section_where(grid, 0, disc), section_where(grid, gap, disc)).trust();
        EXPECT_LT(trust, last);
        EXPECT_GT(trust, 0);
        last = trust;
    }
}

}  // namespace
}  // namespace kontur
