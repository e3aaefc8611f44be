// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/edges_beside.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/random.h"

namespace kontur::viewer {
namespace {

constexpr double kRadius_mm = 20, kVoxel_mm = 1;

/// A bright ball around the origin, whose border is as wide as a voxel.
Image ball(double noise) {
    Grid grid{{60, 60, 20}, {}};
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 step;
        step[axis] = kVoxel_mm;
        grid.index_to_mm.set_column(axis, step);
    }
    grid.index_to_mm.translation = {-29.5, -29.5, -9.5};
    auto random = kontur::test::random_of_this_test();
    std::normal_distribution<double> normal;
    std::vector<float> values;
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i) {
                const double depth_mm = kRadius_mm - norm(grid.center_mm(i, j, k));
                values.push_back(static_cast<float>(100 / (1 + std::exp(-4 * depth_mm)) + noise * normal(random)));
            }
    return {grid, values};
}

Contour circle(double radius_mm, int count = 60) {
    Contour contour;
    contour.plane = make_plane({}, {0, 0, 1});
    for (int n = 0; n < count; ++n) {
        const double angle = 2 * std::numbers::pi * n / count;
        contour.points.push_back({radius_mm * std::cos(angle), radius_mm * std::sin(angle), 0});
    }
    return contour;
}

TEST(EdgesBeside, ALineOnTheBorderHasNone) {
    for (const double noise : {0.0, 10.0})
        for (const double off_mm : {-0.5, 0.0, 0.5})
            EXPECT_EQ(offset_of_edges(circle(kRadius_mm + off_mm), ball(noise)), std::nullopt) << noise << " " << off_mm;
}

TEST(EdgesBeside, TheBorderIsFoundOnBothSidesOfALineWhicheverWayItWasDrawn) {
    const Image image = ball(5);
    for (const double off_mm : {-4.0, -3.0, 3.0, 4.0}) {
        Contour line = circle(kRadius_mm + off_mm);
        for (int turns = 0; turns < 2; ++turns) {
            const auto offset = offset_of_edges(line, image);
            ASSERT_TRUE(offset) << off_mm;
            EXPECT_NEAR(*offset, -off_mm, 0.5 * kVoxel_mm);
            std::ranges::reverse(line.points);
        }
    }
}

TEST(EdgesBeside, NoiseAndAFlatImageHaveNone) {
    const Image image = ball(5);
    EXPECT_EQ(offset_of_edges(circle(8), image), std::nullopt) << "far from the border";
    Image flat = image;
    flat.samples = std::vector<float>(static_cast<std::size_t>(image.grid.voxel_count()), 7);
    EXPECT_EQ(offset_of_edges(circle(16), flat), std::nullopt);
}

TEST(EdgesBeside, OpenLinesAndLinesOutsideOfTheImageHaveNone) {
    Contour open = circle(kRadius_mm - 4);
    open.closed = false;
    EXPECT_EQ(offset_of_edges(open, ball(0)), std::nullopt);
    Contour far = circle(kRadius_mm - 4);
    for (Vec3& p : far.points) p.x += 100;
    EXPECT_EQ(offset_of_edges(far, ball(0)), std::nullopt);
}

TEST(EdgesBeside, TheFarthestOfASetComesFirstByItsId) {
    ContourSet set;
    set.contours = {circle(kRadius_mm), circle(kRadius_mm - 3), circle(kRadius_mm + 4)};
    const auto found = edges_beside(set, {7, 8, 9}, ball(0));
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].contour, 9);
    EXPECT_EQ(found[1].contour, 8);
    EXPECT_LT(found[0].offset_mm, 0);
    EXPECT_GT(found[1].offset_mm, 0);
}

}  // namespace
}  // namespace kontur::viewer
