// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/shape_interpolation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

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
    EXPECT_NEAR(shape.depth_mm({30 + 15, 30, 5}), 0, 0.6);
    EXPECT_NEAR(shape.depth_mm({30 + 12, 30, 5}), 3 / slant, 0.6);
    EXPECT_NEAR(shape.depth_mm({30 + 18, 30, 5}), -3 / slant, 0.6);
}

TEST(ShapeInterpolation, SectionsThatDoNotOverlapAreMovedOverEachOther) {
    const Grid grid = index_grid({61, 41, 11}, {1, 1, 2});
    const auto disc = [&](std::int64_t slice, double u, double v) {
        return section_where(grid, slice,
                             [=](const Index3& at) { return std::hypot(double(at.i) - u, double(at.j) - v) < 5; });
    };
    const ShapeInterpolation steep(grid, disc(0, 15, 15), disc(10, 27, 20));
    EXPECT_EQ(steep.apartness(), 1);
    for (std::int64_t k = 0; k <= 10; ++k) {
        const std::int64_t u = 15 + std::lround(1.2 * double(k)), v = 15 + std::lround(0.5 * double(k));
        EXPECT_NEAR(steep.depth_mm({u, v, k}), 4.5, 0.8) << "its middle in slice " << k;
        EXPECT_LT(steep.depth_mm({u, v - 7, k}), 0);
        EXPECT_LT(steep.depth_mm({u - 7, v, k}), 0);
    }
    EXPECT_EQ(ShapeInterpolation(grid, disc(0, 10, 15), disc(10, 45, 15)).apartness(), 0) << "two bodies";
    const PaintedSlice wide = section_where(grid, 10, [](const Index3& at) { return at.i > 3 && at.i < 50; });
    EXPECT_EQ(ShapeInterpolation(grid, disc(0, 10, 15), wide).apartness(), 0) << "one within the other";
    const double half = ShapeInterpolation(grid, disc(0, 15, 15), disc(10, 20, 15)).apartness();
    EXPECT_GT(half, 0.4);
    EXPECT_LT(half, 0.8);
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
