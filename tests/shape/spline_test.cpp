// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/spline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "support/expect_error.h"

namespace kontur {
namespace {

std::vector<Vec3> circle(int count, double radius) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count;
        points.push_back({radius * std::cos(angle), radius * std::sin(angle), 4});
    }
    return points;
}

bool passes_through(const std::vector<Vec3>& curve, const Vec3& point) {
    return std::any_of(curve.begin(), curve.end(), [&](const Vec3& p) { return distance(p, point) < 1e-12; });
}

TEST(Spline, PassesThroughEveryPoint) {
    const std::vector<Vec3> points{{0, 0, 0}, {10, 0, 0}, {11, 1, 0}, {11, 30, 0}, {-3, 5, 0}};
    for (const bool closed : {true, false}) {
        const std::vector<Vec3> curve = spline(points, closed, 0.5);
        for (const Vec3& p : points) EXPECT_TRUE(passes_through(curve, p)) << closed;
        EXPECT_EQ(curve.front(), points.front());
        EXPECT_TRUE(closed || curve.back() == points.back());
    }
}

TEST(Spline, TwelvePointsMakeACircleWithinOnePercent) {
    for (const Vec3& p : spline(circle(12, 20), true, 0.5)) {
        EXPECT_NEAR(std::hypot(p.x, p.y), 20, 0.2);
        EXPECT_NEAR(p.z, 4, 1e-12);
    }
}

TEST(Spline, StepsAreNotLongerThanAsked) {
    const std::vector<Vec3> curve = spline(circle(8, 20), true, 0.7);
    for (std::size_t i = 0; i < curve.size(); ++i) EXPECT_LT(distance(curve[i], curve[(i + 1) % curve.size()]), 0.8);
}

TEST(Spline, HasNoLoopBetweenUnevenPoints) {
    // A uniform Catmull-Rom curve folds back here.
    const std::vector<Vec3> curve = spline_stretch({0, 0, 0}, {10, 0, 0}, {10.5, 0.1, 0}, {20, 0, 0}, 0.01);
    for (std::size_t i = 1; i < curve.size(); ++i) EXPECT_GT(curve[i].x, curve[i - 1].x);
}

TEST(Spline, RepeatedPointsStayFinite) {
    const std::vector<Vec3> points{{0, 0, 0}, {0, 0, 0}, {5, 0, 0}, {5, 5, 0}, {5, 5, 0}};
    for (const Vec3& p : spline(points, true, 0.5)) EXPECT_TRUE(is_finite(p));
}

TEST(Spline, FewPointsAreReturnedAndAStepOfZeroIsRefused) {
    const std::vector<Vec3> two{{0, 0, 0}, {1, 0, 0}};
    EXPECT_EQ(spline(two, true, 0.1), two);
    EXPECT_THROW(spline(circle(5, 1), true, 0), Error);
}

}  // namespace
}  // namespace kontur
