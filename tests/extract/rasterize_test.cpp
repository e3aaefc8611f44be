// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/rasterize.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <random>

#include "kontur/base/error.h"

namespace kontur {
namespace {

Grid oblique_sheared_grid(const Index3& size) {
    Grid grid;
    grid.size = size;
    grid.index_to_mm.linear = {{{0.8, -0.3, 0.1}, {0.4, 0.7, -0.2}, {0.05, 0.1, -3}}};
    grid.index_to_mm.translation = {-40, 12, 300};
    return grid;
}

/// A contour on slice k through points given in index coordinates (i, j).
Contour contour_on_slice(const Grid& grid, double k, const std::vector<std::array<double, 2>>& points) {
    Contour contour;
    for (const auto& [i, j] : points) contour.points.push_back(grid.index_to_mm.apply({i, j, k}));
    return contour;
}

std::int64_t count_inside(const Mask& mask) {
    return std::accumulate(mask.values.begin(), mask.values.end(), std::int64_t{0});
}

/// The definition: crossings of the ray from (i, j) to the left, edge by edge.
bool inside_by_definition(const std::vector<std::array<double, 2>>& polygon, double i, double j) {
    bool inside = false;
    for (std::size_t n = 0; n < polygon.size(); ++n) {
        const auto [ax, ay] = polygon[n];
        const auto [bx, by] = polygon[(n + 1) % polygon.size()];
        if ((ay <= j) != (by <= j) && ax + (bx - ax) * (j - ay) / (by - ay) <= i) inside = !inside;
    }
    return inside;
}

std::vector<std::array<double, 2>> random_polygon(std::mt19937& random, int points, double size) {
    std::uniform_real_distribution<double> coordinate(-3, size + 3);
    std::vector<std::array<double, 2>> polygon;
    for (int n = 0; n < points; ++n) polygon.push_back({coordinate(random), coordinate(random)});
    return polygon;
}

TEST(Rasterize, AgreesWithTheDefinitionOnSelfIntersectingPolygonsBeyondTheGrid) {
    std::mt19937 random(11);
    const Grid grid = oblique_sheared_grid({23, 19, 3});
    for (int repeat = 0; repeat < 50; ++repeat) {
        const auto polygon = random_polygon(random, 3 + repeat % 9, 20);
        const Mask mask = rasterize({"", {contour_on_slice(grid, 1, polygon)}, {}, {}}, grid);
        for (std::int64_t k = 0; k < grid.size.k; ++k)
            for (std::int64_t j = 0; j < grid.size.j; ++j)
                for (std::int64_t i = 0; i < grid.size.i; ++i)
                    ASSERT_EQ(mask.values[grid.offset(i, j, k)] != 0,
                              k == 1 && inside_by_definition(polygon, static_cast<double>(i), static_cast<double>(j)))
                        << repeat << ": " << i << ", " << j << ", " << k;
    }
}

TEST(Rasterize, PolygonsThatShareEdgesThroughVoxelCentresTileThePlane) {
    const Grid grid{{12, 12, 1}, {}};
    const std::vector<std::vector<std::array<double, 2>>> tiles = {
        {{2, 2}, {8, 2}, {5, 5}}, {{8, 2}, {8, 8}, {5, 5}}, {{8, 8}, {2, 8}, {5, 5}}, {{2, 8}, {2, 2}, {5, 5}}};
    std::vector<int> covered(static_cast<std::size_t>(grid.voxel_count()), 0);
    for (const auto& tile : tiles) {
        const Mask mask = rasterize({"", {contour_on_slice(grid, 0, tile)}, {}, {}}, grid);
        for (std::size_t n = 0; n < covered.size(); ++n) covered[n] += mask.values[n];
    }
    EXPECT_EQ(*std::max_element(covered.begin(), covered.end()), 1) << "no voxel belongs to two tiles";
    EXPECT_EQ(std::accumulate(covered.begin(), covered.end(), 0), 36) << "and none of the square's 6 x 6 to none";
}

TEST(Rasterize, FillsEvenOddWhateverTheOrientationAndTheHoleFlag) {
    const Grid grid = oblique_sheared_grid({20, 20, 2});
    const Contour outer = contour_on_slice(grid, 0, {{0.5, 0.5}, {18.5, 0.5}, {18.5, 18.5}, {0.5, 18.5}});
    Contour inner = contour_on_slice(grid, 0, {{5.5, 5.5}, {9.5, 5.5}, {9.5, 9.5}, {5.5, 9.5}});
    const std::int64_t expected = 18 * 18 - 4 * 4;
    EXPECT_EQ(count_inside(rasterize({"", {outer, inner}, {}, {}}, grid)), expected);
    std::reverse(inner.points.begin(), inner.points.end());
    inner.hole = true;
    EXPECT_EQ(count_inside(rasterize({"", {inner, outer}, {}, {}}, grid)), expected);
}

TEST(Rasterize, ARetracedChannelLeavesNoTrace) {
    const Grid grid{{20, 20, 1}, {}};
    const Contour keyhole = contour_on_slice(grid, 0,
                                             {{0.1, 0.2},
                                              {5.3, 5.7},
                                              {5.3, 9.7},
                                              {9.3, 9.7},
                                              {9.3, 5.7},
                                              {5.3, 5.7},
                                              {0.1, 0.2},
                                              {18.5, 0.2},
                                              {18.5, 18.5},
                                              {0.1, 18.5}});
    EXPECT_EQ(count_inside(rasterize({"", {keyhole}, {}, {}}, grid)), 18 * 18 - 4 * 4);
}

TEST(Rasterize, AreaOfADiscIsRightToATenthOfAPercent) {
    Grid grid{{400, 400, 1}, {}};
    for (int axis : {0, 1}) grid.index_to_mm.linear[axis][axis] = 0.05;
    Contour disc;
    for (int n = 0; n < 1000; ++n) {
        const double angle = 2 * std::numbers::pi * n / 1000;
        disc.points.push_back({10 + 8 * std::cos(angle), 10 + 8 * std::sin(angle), 0});
    }
    const double area = static_cast<double>(count_inside(rasterize({"", {disc}, {}, {}}, grid))) * 0.05 * 0.05;
    EXPECT_NEAR(area, std::numbers::pi * 64, 0.2);
}

TEST(Rasterize, AcceptsPointsUpToHalfASliceOffAndRefusesMore) {
    const Grid grid = oblique_sheared_grid({20, 20, 4});
    const auto at = [&](double k) {
        return ContourSet{"", {contour_on_slice(grid, k, {{2.5, 2.5}, {8.5, 2.5}, {8.5, 8.5}, {2.5, 8.5}})}, {}, {}};
    };
    EXPECT_EQ(rasterize(at(1.4), grid).values, rasterize(at(1), grid).values) << "projected along the slice axis";
    EXPECT_EQ(count_inside(rasterize(at(7), grid)), 0) << "beyond the last slice";
    ContourSet leaning = at(1);
    leaning.contours[0].points[2] += 0.6 * grid.index_to_mm.column(2);
    try {
        rasterize(leaning, grid);
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
        EXPECT_STREQ(error.what(),
                     "contour 1 is not drawn on a slice of the grid: a point lies 0.6 slices off slice 1; the limit is 0.5");
    }
}

TEST(Rasterize, RefusesOpenEmptyAndInfiniteContours) {
    const Grid grid{{4, 4, 1}, {}};
    const auto refused = [&](const Contour& contour) { EXPECT_THROW(rasterize({"", {contour}, {}, {}}, grid), Error); };
    Contour contour = contour_on_slice(grid, 0, {{0, 0}, {2, 0}, {0, 2}});
    contour.closed = false;
    refused(contour);
    contour.closed = true;
    contour.points[1].x = std::numeric_limits<double>::infinity();
    refused(contour);
    refused(Contour{});
}

TEST(Rasterize, TellsWhichSlicesAreFilled) {
    Mask mask{oblique_sheared_grid({4, 3, 6}), std::vector<std::uint8_t>(72)};
    EXPECT_EQ(filled_slices(mask).extent, 0);
    mask.values[15] = mask.values[50] = 1;  // of slices 1 and 4
    EXPECT_EQ(filled_slices(mask).filled, 2);
    EXPECT_EQ(filled_slices(mask).extent, 4);
}

}  // namespace
}  // namespace kontur
