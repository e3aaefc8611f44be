// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/smallest_ball.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace kontur {
namespace {

double farthest(const Ball3& ball, const std::vector<Vec3>& points) {
    double most = 0;
    for (const Vec3& p : points) most = std::max(most, distance(p, ball.center));
    return most;
}

/// A descent that knows nothing of supports: steps to the farthest point that become ever shorter (Badoiu, Clarkson 2003).
double radius_by_descent(const std::vector<Vec3>& points) {
    Vec3 center = points[0];
    for (int step = 1; step <= 200000; ++step) {
        const Vec3& far = *std::max_element(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) {
            return distance(a, center) < distance(b, center);
        });
        center += (far - center) / (step + 1);
    }
    return farthest({center, 0}, points);
}

std::vector<Vec3> cloud(unsigned seed, std::size_t count, const Vec3& size) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<Vec3> points(count);
    for (Vec3& p : points) p = {size.x * normal(random), size.y * normal(random), size.z * normal(random)};
    return points;
}

TEST(SmallestBall, IsKnownForSimpleSets) {
    EXPECT_EQ(smallest_ball({}).radius, 0);
    EXPECT_EQ(smallest_ball(std::vector<Vec3>{{1, 2, 3}, {1, 2, 3}}).center, (Vec3{1, 2, 3}));
    const Ball3 two = smallest_ball(std::vector<Vec3>{{-1, 0, 0}, {0, 0.5, 0}, {3, 0, 0}});
    EXPECT_NEAR(two.radius, 2, 1e-12);
    EXPECT_NEAR(two.center.x, 1, 1e-12);
    std::vector<Vec3> corners;
    for (const double x : {0.0, 1.0})
        for (const double y : {0.0, 1.0})
            for (const double z : {0.0, 1.0}) corners.push_back({x, y, z});
    EXPECT_NEAR(smallest_ball(corners).diameter(), std::sqrt(3.0), 1e-12);
}

TEST(SmallestBall, HoldsAllPointsAndIsTheSmallest) {
    for (unsigned seed = 0; seed < 6; ++seed) {
        const std::vector<Vec3> points = cloud(seed, 10 + 40 * seed, {20, 5.0 + seed, seed % 2 ? 3.0 : 0.0});
        const Ball3 ball = smallest_ball(points);
        EXPECT_LE(farthest(ball, points), (1 + 1e-9) * ball.radius) << "seed " << seed;
        EXPECT_NEAR(ball.radius, radius_by_descent(points), 1e-4 * ball.radius) << "seed " << seed;
    }
}

TEST(SmallestBall, IsStableWhereManyPointsLieOnIt) {
    std::vector<Vec3> points;
    for (int turn = 0; turn < 3; ++turn)
        for (int i = 0; i < 360; ++i) {
            const double a = 2 * M_PI * i / 360, c = 30 * std::cos(a), s = 30 * std::sin(a);
            points.push_back(Vec3{500, -700, 90} + (turn == 0 ? Vec3{c, s, 0} : turn == 1 ? Vec3{0, c, s} : Vec3{s, 0, c}));
        }
    const Ball3 ball = smallest_ball(points);
    EXPECT_NEAR(ball.radius, 30, 1e-9);
    EXPECT_NEAR(distance(ball.center, {500, -700, 90}), 0, 1e-9);
}

TEST(SmallestBall, IsTheSameFarFromTheOrigin) {
    for (unsigned seed = 0; seed < 40; ++seed) {
        std::vector<Vec3> points = cloud(seed, 120, {20, 10, 5});
        const double radius = smallest_ball(points).radius;
        for (const double away : {1e4, 1e6, 1e8}) {
            std::vector<Vec3> moved = points;
            for (Vec3& p : moved) p += away * normalized(Vec3{1, 0.3, -0.7});
            EXPECT_NEAR(smallest_ball(moved).radius, radius, 1e-9 * radius + 1e-15 * away) << seed << " " << away;
        }
    }
}

TEST(SmallestBall, TurnsWithItsPoints) {
    const std::vector<Vec3> points = cloud(3, 500, {40, 20, 10});
    const Plane frame = make_plane({}, {0.3, -0.5, 0.8});
    std::vector<Vec3> turned;
    for (const Vec3& p : points) turned.push_back(p.x * frame.u + p.y * frame.v + p.z * frame.normal);
    EXPECT_NEAR(smallest_ball(points).radius, smallest_ball(turned).radius, 1e-9);
}

}  // namespace
}  // namespace kontur
