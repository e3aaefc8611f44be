// SPDX-License-Identifier: Apache-2.0
#include "kontur/sampling/surface_samples.h"

#include <gtest/gtest.h>

#include <numbers>

#include "kontur/extract/polygonize.h"
#include "kontur/extract/track.h"
#include "kontur/sampling/sample_surface.h"
#include "support/functions.h"

namespace kontur {
namespace {

constexpr double kRadius = 20;
const Vec3 kCenter{3, -50, 700};

SurfaceLattice lattice_of(const Grid& grid) {
    const ImplicitFunction ball = test::ball_function(kCenter, kRadius);
    return track_surface(ball, grid, std::vector<Vec3>{kCenter + Vec3{kRadius, 0, 0}}, {.threads = 1});
}

/// Not centred on the ball: its symmetry would make the same of many crossings.
Grid usual_grid() { return test::grid_about(kCenter + Vec3{0.31, 0.17, -0.44}, {64, 66, 90}, 0.8); }

std::vector<Grid> grids() {
    return {usual_grid(), test::changed(usual_grid(), test::kOblique), test::changed(usual_grid(), test::kSheared),
            test::changed(usual_grid(), test::kMirrored)};
}

void expect_ball(const SurfaceSamples& samples) {
    const double area = 4 * std::numbers::pi * kRadius * kRadius;
    EXPECT_NEAR(samples.area_mm2(), area, 0.02 * area);
    Vec3 squares;  // of a ball each coordinate's mean square is a third of the radius'
    for (std::size_t n = 0; n < samples.points.size(); ++n) {
        const Vec3 d = samples.points[n] - kCenter;
        EXPECT_NEAR(norm(d), kRadius, 0.02);
        EXPECT_NEAR(samples.slopes[n], 1, 0.1);
        squares += samples.areas_mm2[n] * Vec3{d.x * d.x, d.y * d.y, d.z * d.z};
    }
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(squares[axis], area * kRadius * kRadius / 3, 0.05 * area * kRadius * kRadius / 3);
}

TEST(AreaSamples, SumsOverALatticesSamplesAreIntegralsOverTheBall) {
    for (const Grid& grid : grids()) {
        const SurfaceSamples samples =
            sample_surface(lattice_of(grid), test::ball_function(kCenter, kRadius), 1200, {.threads = 1});
        EXPECT_NEAR(static_cast<double>(samples.points.size()), 1200, 12);
        expect_ball(samples);
    }
}

TEST(AreaSamples, SumsOverAMeshsSamplesAreTheSame) {
    const ImplicitFunction ball = test::ball_function(kCenter, kRadius);
    const TriangleMesh mesh = polygonize(lattice_of(test::grid_about(kCenter, {90, 90, 90}, 0.5)), ball, {.threads = 1});
    const SurfaceSamples samples = sample_surface(mesh, ball, 1200, {.threads = 1});
    EXPECT_EQ(samples.points.size(), 1200u);
    expect_ball(samples);
}

TEST(AreaSamples, AreAsManyAsThereAreCrossingsWhereThoseAreFew) {
    const Grid coarse = test::grid_about(kCenter, {9, 9, 9}, 6);
    const SurfaceSamples samples =
        sample_surface(lattice_of(coarse), test::ball_function(kCenter, kRadius), 100000, {.threads = 1});
    EXPECT_GT(samples.points.size(), 50u);
    EXPECT_LT(samples.points.size(), 500u);
}

TEST(AreaSamples, AreNoneWithoutASurface) {
    const Grid elsewhere = test::grid_about(kCenter + Vec3{500, 0, 0}, {9, 9, 9}, 1);
    EXPECT_TRUE(sample_surface(lattice_of(elsewhere), test::ball_function(kCenter, kRadius)).points.empty());
    EXPECT_TRUE(sample_surface(TriangleMesh{}, test::ball_function(kCenter, kRadius)).points.empty());
}

TEST(AreaSamples, LeaveOutWhereTheGridsBorderCutsTheObjectOff) {
    Grid half = usual_grid();
    half.size.k = 45;  // ends amid the ball
    half.index_to_mm.translation.z = kCenter.z - 44.5 * 0.8;
    const SurfaceSamples samples =
        sample_surface(lattice_of(half), test::ball_function(kCenter, kRadius), 1200, {.threads = 1});
    const double area = 2 * std::numbers::pi * kRadius * kRadius;
    EXPECT_NEAR(samples.area_mm2(), area, 0.02 * area);
    for (const Vec3& p : samples.points) EXPECT_NEAR(distance(p, kCenter), kRadius, 0.02);
}

}  // namespace
}  // namespace kontur
