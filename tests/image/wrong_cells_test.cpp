// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/wrong_cells.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/horned_body.h"

namespace kontur {
namespace {

using namespace test;

std::vector<WrongCells> planes(const std::vector<double>& alone, const std::vector<double>& moved,
                               const std::vector<double>& walked) {
    std::vector<WrongCells> wrong;
    for (std::size_t n = 0; n < alone.size(); ++n) wrong.push_back({alone[n], moved[n], walked[n], 100});
    return wrong;
}

TEST(WalkWeight, IsMoreThanNothingWhereItHasFewerWrongCellsThanChanceMakes) {
    EXPECT_EQ(walk_weight(planes({40, 50, 60}, {40, 50, 60}, {20, 28, 40}), 0), 1);
    EXPECT_EQ(walk_weight(planes({40, 50, 60}, {40, 50, 60}, {18, 51, 61}), 0), 0) << "one plane of three says so";
    for (const double walked : {7, 11, 18, 23, 29, 31})
        EXPECT_EQ(walk_weight(planes({40, 50, 60}, {40, 50, 60}, {walked, 50, 60}), 0), 0) << "and two nothing";
    EXPECT_EQ(walk_weight(planes({40, 50, 60}, {40, 50, 60}, {40, 50, 60}), 0), 0) << "it does nothing";
    EXPECT_EQ(walk_weight(planes({40, 50, 60}, {40, 50, 60}, {44, 55, 60}), 0), 0);
    EXPECT_EQ(walk_weight(planes({40, 50, 60}, {40, 50, 60}, {38, 48, 57}), 0), 0) << "surely, but hardly fewer";
}

TEST(WalkWeight, IsThatBesideTheSurfaceAsFarAsItMoves) {
    const std::vector<WrongCells> wrong = planes({40, 50, 60}, {10, 12, 14}, {20, 28, 40});
    EXPECT_EQ(walk_weight(wrong, 0), 1);
    EXPECT_EQ(walk_weight(wrong, 1), 0);
    double less = 1;
    for (const double moving : {0.5, 0.6, 0.7, 0.8}) {
        const double weight = walk_weight(wrong, moving);
        EXPECT_LE(weight, less);
        less = weight;
    }
    EXPECT_EQ(walk_weight(planes({40, 50, 60}, {40, 48, 58}, {38, 47, 57}), 1), 1) << "a little is enough there";
    EXPECT_NEAR(walk_weight(planes({40, 50, 60}, {40, 50, 60}, {45, 45, 60}), 1), 0.25, 1e-9) << "as often more as fewer";
}

TEST(WalkWeight, IsLessWhereTheContoursAloneAreAsGood) {
    const std::vector<double> alone{185, 248, 142, 139}, moved{182, 290, 122, 121};  // a sarcoma
    const double weight = walk_weight(planes(alone, moved, {194, 267, 143, 108}), 1);
    EXPECT_GT(weight, 0.2);
    EXPECT_LT(weight, 0.3) << "as often worse as better than the one, and than the other";
    EXPECT_GT(walk_weight(planes(alone, moved, {174, 247, 123, 88}), 1), 2 * weight);
    EXPECT_EQ(walk_weight(planes({40, 50, 60}, {60, 75, 90}, {50, 62, 75}), 1), 0) << "better than the moved surface alone";
}

TEST(WalkWeight, FlipsNowhere) {
    for (const double moving : {0.0, 0.4, 1.0}) {
        double before = 0;
        for (double fewer = -60; fewer <= 150; fewer += 1) {
            const double weight =
                walk_weight(planes({400, 500, 600}, {400, 500, 600}, {420 - fewer, 475 - fewer, 605 - fewer}), moving);
            EXPECT_GE(weight, before) << fewer;
            EXPECT_LT(weight - before, 0.05) << fewer;
            before = weight;
        }
        EXPECT_EQ(before, 1);
    }
}

TEST(WalkWeight, IsNothingUnlessThreePlanesTell) {
    std::vector<WrongCells> wrong = planes({40, 50, 60}, {40, 50, 60}, {20, 28, 40});
    wrong[1] = {};
    EXPECT_EQ(walk_weight(wrong, 0), 0);
    EXPECT_EQ(walk_weight({}, 1), 0);
}

TEST(CountWrong, IsTheAreaBetweenOutlines) {
    const ContourSet plane = drawn_on({make_plane({0, 0, 1}, {0, 0, 1})}, [](const Vec3& p) { return 25 - norm(p); });
    const ImageCells cells = image_cells(image_of(cube_grid(1), body_look), drawn_on(orthogonal_planes()), 1'000'000);
    CellDepths alone, moved;
    VoxelWalk walk;
    for (std::size_t n = 0; n < cells.looks.size(); ++n) {
        const double r = norm(cells.center(n));
        alone.depth_mm.push_back(static_cast<float>(20 - r));
        moved.depth_mm.push_back(static_cast<float>(25 - r));
        walk.inside.push_back(r < 28 ? 1 : 0);
    }
    const WrongCells wrong = count_wrong(plane, cells, alone, moved, walk);
    // The plane lies between two layers of cells, or in one.
    const double layers = wrong.inside / (M_PI * (25 * 25 - 1));
    EXPECT_NEAR(layers, std::round(layers), 0.02 * std::round(layers));
    const double layer = wrong.inside / std::round(layers);
    EXPECT_NEAR(wrong.by_contours / std::round(layers), layer - M_PI * 20 * 20, 0.03 * layer);
    EXPECT_NEAR(wrong.by_walk / std::round(layers), M_PI * 28 * 28 - layer, 0.03 * layer);
    EXPECT_LT(wrong.by_movement, 0.03 * wrong.inside);
    ContourSet open = plane;
    open.contours.front().closed = false;
    EXPECT_EQ(count_wrong(open, cells, alone, moved, walk).inside, 0);
}

}  // namespace
}  // namespace kontur
