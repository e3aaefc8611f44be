// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/voxel_walk.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kontur/image/walk_data.h"
#include "kontur/sampling/spread_points.h"
#include "support/horned_body.h"

namespace kontur {
namespace {

using namespace test;

constexpr std::size_t kMany = 400'000;

double prior(double distance_mm) { return 0.25 * distance_mm; }

/// A walk that begins with a ball of 25 mm.
struct WalkAboutBall {
    WalkAboutBall(const Image& image, const ContourSet& contours, const CellSlab& near = {})
        : cells(image_cells(image, contours, kMany)) {
        const Surroundings surroundings(Drawing(contours), image);
        const std::vector<Vec3> along = along_contours(contours, 1);
        for (std::size_t n = 0; n < cells.looks.size(); ++n) {
            const Vec3 p = cells.center(n);
            depths.depth_mm.push_back(static_cast<float>(25 - norm(p)));
            depths.far_mm.push_back(static_cast<float>(nearest_distance(p, along)));
        }
        walk = walk_voxels(cells, depths, {surroundings.walls, prior, 50, near});
    }

    /// Of the cells at which `is_there` holds, the share inside.
    double share_inside(const std::function<bool(const Vec3&)>& is_there) const {
        double all = 0, inside = 0;
        for (std::size_t n = 0; n < cells.looks.size(); ++n) {
            if (!is_there(cells.center(n))) continue;
            ++all;
            inside += walk.is_inside(n);
        }
        return inside / all;
    }

    ImageCells cells;
    CellDepths depths;
    VoxelWalk walk;
};

/// Through the ball, beside the horns.
std::vector<Plane> planes_of_ball() {
    return {make_plane({0, 0, -11}, {0, 0, 1}), make_plane({0, 0, 6}, {0, 0, 1}), make_plane({0, -10, 0}, {0, 1, 0})};
}

double ball_depth(const Vec3& p) { return 25 - norm(p); }

/// In a horn beyond the ball, where the walk is asked at all.
bool is_in_horn(const Vec3& p) { return horned_depth(p) > 1 && norm(p) > 28 && norm(p) < 36; }

TEST(VoxelWalk, FollowsHornsThatTheSurfaceItBeginsWithHasNot) {
    const ContourSet contours = cut(planes_of_ball(), ball_depth);
    const WalkAboutBall about(image_of(cube_grid(1.5), horned_look, 8), contours);
    EXPECT_GT(about.share_inside(is_in_horn), 0.7);
    EXPECT_LT(about.share_inside([](const Vec3& p) { return horned_depth(p) < -1.5; }), 0.01);
}

TEST(VoxelWalk, IsTheSameInAnInvertedImage) {
    const ContourSet contours = cut(planes_of_ball(), ball_depth);
    const Image image = image_of(cube_grid(2), horned_look, 8);
    Image inverted = image;
    for (float& v : std::get<std::vector<float>>(inverted.samples)) v = 300 - 2 * v;
    const WalkAboutBall one(image, contours), other(inverted, contours);
    for (std::size_t n = 0; n < one.walk.inside.size(); ++n) ASSERT_NEAR(one.walk.inside[n], other.walk.inside[n], 0.02F);
}

TEST(VoxelWalk, OfAnImageThatShowsNothingStaysWhereItBegan) {
    const ContourSet contours = cut(planes_of_ball(), ball_depth);
    const WalkAboutBall about(image_of(cube_grid(2), [](const Vec3&) { return 5.0; }), contours);
    EXPECT_FALSE(about.walk.band.empty());
    EXPECT_EQ(about.share_inside([](const Vec3& p) { return norm(p) < 22; }), 1);
    EXPECT_EQ(about.share_inside([](const Vec3& p) { return norm(p) > 28; }), 0);
}

TEST(VoxelWalk, LeavesOutWhatHangsTogetherWithNothingDrawn) {
    const auto lump = [](const Vec3& p) { return 4 - norm(p - Vec3{-20, -20, 14}); };
    const auto look = [&](const Vec3& p) { return two_tissues(std::max(ball_depth(p), lump(p))); };
    const ContourSet contours = cut(planes_of_ball(), ball_depth);
    const WalkAboutBall about(image_of(cube_grid(1.5), look), contours);
    EXPECT_EQ(about.share_inside([&](const Vec3& p) { return lump(p) > 0; }), 0);
}

TEST(VoxelWalk, AsksNothingInDrawnPlanesNorBeyondTheImage) {
    const ContourSet contours = cut(planes_of_ball(), ball_depth);
    const Grid half = grid_around({{-48, -48, -48}, {10, 48, 48}}, {2, 2, 2}, 0);
    const WalkAboutBall about(image_of(half, horned_look), contours);
    for (const std::uint32_t cell : about.walk.band) {
        const Vec3 p = about.cells.center(cell);
        EXPECT_LT(p.x, 12);
        EXPECT_GT(std::abs(p.z - 6), 0.99);
        EXPECT_GT(std::abs(p.y + 10), 0.99);
    }
}

TEST(VoxelWalk, AskedNearAPlaneSaysThereWhatItSaysOtherwise) {
    const ContourSet contours = cut(planes_of_ball(), ball_depth);
    const Image image = image_of(cube_grid(1.5), horned_look, 8);
    const CellSlab near{make_plane({15, 0, 0}, {1, 0, 0}), 8 * 1.5};
    const WalkAboutBall everywhere(image, contours), there(image, contours, near);
    EXPECT_LT(there.walk.band.size(), 0.7 * static_cast<double>(everywhere.walk.band.size()));
    for (const std::uint32_t cell : there.walk.band) ASSERT_TRUE(near.holds(there.cells.center(cell)));
    double wrong = 0, in_plane = 0;
    for (std::size_t n = 0; n < there.walk.inside.size(); ++n) {
        if (std::abs(there.cells.center(n).x - 15) > 0.8) continue;
        in_plane += everywhere.walk.is_inside(n);
        wrong += everywhere.walk.is_inside(n) != there.walk.is_inside(n);
    }
    EXPECT_GT(in_plane, 1000);
    EXPECT_LT(wrong, 0.01 * in_plane);
}

TEST(ImageCells, AreTheVoxelsWhereThoseAreCubes) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    const Image image = image_of(cube_grid(2), body_look);
    const ImageCells cells = image_cells(image, contours, kMany);
    EXPECT_NEAR(cells.edge_mm(), 2, 1e-12);
    const Vec3 index = image.grid.index_to_mm.inverse().apply(cells.center(cells.looks.size() / 2));
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(index[axis], std::round(index[axis]), 1e-9);
}

TEST(ImageCells, AreCubesOfTheSameVolumeWhereVoxelsAreNot) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    Grid thick = grid_around({{-48, -48, -48}, {48, 48, 48}}, {0.8, 0.8, 8}, 0);
    const ImageCells cells = image_cells(image_of(thick, body_look), contours, kMany);
    EXPECT_NEAR(cells.edge_mm(), std::cbrt(0.8 * 0.8 * 8), 1e-9);
    thick.index_to_mm.set_column(2, {2, 1, 8});  // sheared
    const Affine3& to_mm = image_cells(image_of(thick, body_look), contours, kMany).grid.index_to_mm;
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(norm(to_mm.column(axis)), std::cbrt(0.8 * 0.8 * 8), 1e-9);
        EXPECT_NEAR(dot(to_mm.column(axis), to_mm.column((axis + 1) % 3)), 0, 1e-9);
    }
}

TEST(ImageCells, AreLargerWhereThereWouldBeTooMany) {
    const ContourSet contours = drawn_on(orthogonal_planes());
    const ImageCells cells = image_cells(image_of(cube_grid(1), body_look), contours, 10'000);
    EXPECT_LT(cells.looks.size(), 14'000U) << "some more at the borders";
    EXPECT_GT(cells.looks.size(), 8'000U);
}

ImplicitFunction times(double factor, const ImplicitFunction& f) {
    std::vector<Vec3> centers;
    std::vector<double> weights;
    for (std::size_t n = 0; n < f.weights().size(); ++n) {
        centers.push_back(f.centers()[n]);
        weights.push_back(factor * f.weights()[n]);
    }
    std::array<double, 4> polynomial = f.polynomial();
    for (double& one : polynomial) one *= factor;
    return {f.kernel(), f.frame(), PointArrays(centers), std::move(weights), polynomial};
}

// The same surface by a steeper function has steeper depths beside it: f bends nowhere that it did not.
TEST(WalkData, IsAsSteepAsTheFunction) {
    const ContourSet contours = cut(planes_of_ball(), ball_depth);
    const Drawing drawing(contours);
    const WalkAboutBall about(image_of(cube_grid(2), horned_look, 8), contours);
    const Depths depths = depths_below(about.walk, about.cells);
    FittedFunction fitted = follow_image_of(contours, image_of(cube_grid(2), horned_look, 8)).plain;
    const auto data_by = [&](double factor) {
        FittedFunction steeper = fitted;
        steeper.function = times(factor, fitted.function);
        return walk_data({about.walk, depths, about.cells}, {steeper, about.depths}, drawing, {});
    };
    const ImageData plain = data_by(1), flat = data_by(0.8);
    ASSERT_EQ(plain.values.size(), flat.values.size());
    std::size_t scaled = 0;
    for (std::size_t n = 0; n < plain.values.size(); ++n)
        scaled += std::abs(flat.values[n].value - 0.8 * plain.values[n].value) < 1e-9;
    EXPECT_GT(scaled, plain.values.size() / 2);
}

}  // namespace
}  // namespace kontur
