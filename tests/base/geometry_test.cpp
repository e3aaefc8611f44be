// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/geometry.h"

#include <gtest/gtest.h>

#include <random>

#include "kontur/base/error.h"

namespace kontur {
namespace {

Affine3 random_affine(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-2, 2);
    Affine3 affine;
    do {
        for (auto& row : affine.linear)
            for (double& value : row) value = uniform(random);
    } while (std::abs(affine.determinant()) < 0.1);
    affine.translation = {1000 * uniform(random), 1000 * uniform(random), 1000 * uniform(random)};
    return affine;
}

TEST(Affine3, InverseUndoesApply) {
    std::mt19937 random(1);
    for (int run = 0; run < 200; ++run) {
        const Affine3 affine = random_affine(random);
        const Vec3 p{1.5, -20, 300};
        EXPECT_LT(distance(affine.inverse().apply(affine.apply(p)), p), 1e-8) << "run " << run;
    }
}

TEST(Affine3, ComposeAppliesSecondFirst) {
    std::mt19937 random(2);
    const Affine3 a = random_affine(random), b = random_affine(random);
    const Vec3 p{1, 2, 3};
    EXPECT_LT(distance(compose(a, b).apply(p), a.apply(b.apply(p))), 1e-9);
}

TEST(Affine3, RefusesDependentAxes) {
    Affine3 flat;
    flat.set_column(2, flat.column(0) + flat.column(1));
    EXPECT_THROW(flat.inverse(), Error);
}

TEST(AnyPerpendicular, IsUnitAndPerpendicular) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int run = 0; run < 200; ++run) {
        const Vec3 n = normalized({normal(random), normal(random), normal(random)});
        EXPECT_NEAR(dot(any_perpendicular(n), n), 0, 1e-14);
        EXPECT_NEAR(norm(any_perpendicular(n)), 1, 1e-14);
    }
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
        EXPECT_NEAR(dot(any_perpendicular(axis), axis), 0, 0);
}

TEST(MakePlane, FrameIsRightHanded) {
    const Plane plane = make_plane({1, 2, 3}, {1, -2, 0.5});
    EXPECT_LT(distance(cross(plane.u, plane.v), plane.normal), 1e-14);
    EXPECT_LT(distance(plane.from_uv(4, -5), plane.from_uv(0, 0) + 4 * plane.u - 5 * plane.v), 1e-14);
}

TEST(FitPlane, RecoversThePlaneOfANoisyPolygonAndItsOrientation) {
    std::mt19937 random(4);
    std::normal_distribution<double> noise(0, 1e-3);
    const Plane truth = make_plane({100, -50, 20}, {0.3, 0.4, -0.7});
    std::vector<Vec3> polygon;
    for (int i = 0; i < 40; ++i) {
        const double t = 2 * M_PI * i / 40;
        polygon.push_back(truth.from_uv(30 * std::cos(t), 12 * std::sin(t)) + noise(random) * truth.normal);
    }
    const auto fitted = fit_plane(polygon);
    ASSERT_TRUE(fitted);
    EXPECT_GT(dot(fitted->normal, truth.normal), 1 - 1e-6);
    EXPECT_LT(std::abs(fitted->distance_to(truth.origin)), 1e-3);
}

TEST(FitPlane, HasNoAnswerForALine) {
    EXPECT_FALSE(fit_plane(std::vector<Vec3>{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {2, 2, 2}}));
    EXPECT_FALSE(fit_plane(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}}));
}

}  // namespace
}  // namespace kontur
