// SPDX-License-Identifier: Apache-2.0
#include "kontur/refine/wrong_cells.h"

#include <gtest/gtest.h>

#include <cmath>

#include "refine/horned_body.h"

namespace kontur {
namespace {

using namespace test;

std::vector<WrongCells> planes(const std::vector<double>& alone, const std::vector<double>& moved,
                               const std::vector<double>& walked) {
    std::vector<WrongCells> wrong;
    for (std::size_t n = 0; n < alone.size(); ++n) wrong.push_back({alone[n], moved[n], walked[n], 100});
    return wrong;
}

TEST(WalkHelps, WhereItHasFewerWrongCellsThanChanceMakes) {
    EXPECT_TRUE(walk_helps(planes({40, 50, 60}, {40, 50, 60}, {20, 28, 40}), false));
    EXPECT_FALSE(walk_helps(planes({40, 50, 60}, {40, 50, 60}, {18, 51, 61}), false)) << "one plane of three says so";
    EXPECT_FALSE(walk_helps(planes({40, 50, 60}, {40, 50, 60}, {40, 50, 60}), false)) << "it does nothing";
    EXPECT_FALSE(walk_helps(planes({40, 50, 60}, {40, 50, 60}, {44, 55, 60}), false));
    EXPECT_FALSE(walk_helps(planes({40, 50, 60}, {40, 50, 60}, {38, 48, 57}), false)) << "surely, but hardly fewer";
}

TEST(WalkHelps, BesideTheMovedSurfaceWhereThatIsUsed) {
    const std::vector<WrongCells> wrong = planes({40, 50, 60}, {10, 12, 14}, {20, 28, 40});
    EXPECT_TRUE(walk_helps(wrong, false));
    EXPECT_FALSE(walk_helps(wrong, true));
    EXPECT_TRUE(walk_helps(planes({40, 50, 60}, {40, 48, 58}, {38, 47, 57}), true)) << "a little is enough there";
}

TEST(WalkHelps, OnlyWhereThreePlanesTell) {
    std::vector<WrongCells> wrong = planes({40, 50, 60}, {40, 50, 60}, {20, 28, 40});
    wrong[1] = {};
    EXPECT_FALSE(walk_helps(wrong, false));
    EXPECT_FALSE(walk_helps({}, false));
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
    const double layers = wrong.drawn / (M_PI * (25 * 25 - 1));
    EXPECT_NEAR(layers, std::round(layers), 0.02 * std::round(layers));
    const double layer = wrong.drawn / std::round(layers);
    EXPECT_NEAR(wrong.alone / std::round(layers), layer - M_PI * 20 * 20, 0.03 * layer);
    EXPECT_NEAR(wrong.walked / std::round(layers), M_PI * 28 * 28 - layer, 0.03 * layer);
    EXPECT_LT(wrong.moved, 0.03 * wrong.drawn);
    ContourSet open = plane;
    open.contours.front().closed = false;
    EXPECT_EQ(count_wrong(open, cells, alone, moved, walk).drawn, 0);
}

}  // namespace
}  // namespace kontur
