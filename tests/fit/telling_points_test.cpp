// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/telling_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <numeric>

#include "support/random.h"

namespace kontur {
namespace {

/// A closed line about z = 0 whose radius is a function of the angle, with its in-plane normals taken for those of a circle.
template <class Radius>
std::vector<BoundaryPoint> ring(int count, const Radius& radius_mm, std::int32_t contour = 0) {
    std::vector<BoundaryPoint> points;
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count;
        const Vec3 outward{std::cos(angle), std::sin(angle), 0};
        points.push_back({.position = radius_mm(angle) * outward,
                          .inplane_normal = outward,
                          .plane_normal = {0, 0, 1},
                          .contour = contour,
                          .on_ring = true});
    }
    return points;
}

double smooth(double angle) { return 30 + 3 * std::cos(2 * angle) + std::sin(3 * angle); }

std::vector<BoundaryPoint> smooth_ring() { return ring(300, smooth); }

std::vector<BoundaryPoint> open_line() {
    std::vector<BoundaryPoint> points = smooth_ring();
    points.resize(200);
    for (BoundaryPoint& point : points) point.on_ring = false;
    return points;
}

std::vector<Vec3> places(const TellingPoints& telling, const std::vector<BoundaryPoint>& points) {
    std::vector<Vec3> result;
    for (const std::size_t i : telling.numbers) result.push_back(points[i].position);
    std::ranges::sort(result, {}, [](const Vec3& p) { return std::pair(p.x, p.y); });
    return result;
}

TEST(TellingPoints, OfASmoothLineAreAThird) {
    for (const std::vector<BoundaryPoint>& points : {smooth_ring(), open_line()}) {
        const TellingPoints telling = telling_points(points, 0.01);
        EXPECT_LT(3 * telling.numbers.size(), points.size() + 6);
        EXPECT_GT(5 * telling.numbers.size(), points.size());
        EXPECT_TRUE(std::ranges::is_sorted(telling.numbers));
        // They stand for all points together, and none for many more than another.
        const double sum = std::accumulate(telling.weights.begin(), telling.weights.end(), 0.0);
        EXPECT_NEAR(sum, static_cast<double>(telling.numbers.size()), 1e-9);
        EXPECT_LT(std::ranges::max(telling.weights), 2);
    }
}

TEST(TellingPoints, OfAnUnsteadyHandAreNearlyAll) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> waver(-0.1, 0.1);
    std::vector<BoundaryPoint> points = smooth_ring();
    for (BoundaryPoint& point : points) point.position += waver(random) * point.inplane_normal;
    EXPECT_GT(telling_points(points, 0.01).numbers.size(), 270u);
}

TEST(TellingPoints, AreAllWhereALineIsRoughAndFewWhereItIsSmooth) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> waver(-0.1, 0.1);
    std::vector<BoundaryPoint> points = smooth_ring();
    for (std::size_t i = 100; i < 200; ++i) points[i].position += waver(random) * points[i].inplane_normal;
    const TellingPoints telling = telling_points(points, 0.01);
    const auto rough = std::ranges::count_if(telling.numbers, [](std::size_t i) { return i >= 100 && i < 200; });
    EXPECT_GT(rough, 90);
    EXPECT_LT(telling.numbers.size() - static_cast<std::size_t>(rough), 90u);
}

TEST(TellingPoints, AreTheSameWhereverARingBeginsAndWhicheverWayItRuns) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> waver(-0.3, 0.3);
    constexpr double kTolerance = 0.2;
    std::vector<BoundaryPoint> points = smooth_ring();
    for (BoundaryPoint& point : points) point.position += waver(random) * point.inplane_normal;  // none turns as another
    const std::vector<Vec3> expected = places(telling_points(points, kTolerance), points);
    EXPECT_GT(expected.size(), 120u) << "some are missed,";
    EXPECT_LT(expected.size(), 240u) << "and some are not";
    for (const int later : {1, 150, 299}) {
        std::vector<BoundaryPoint> other = points;
        std::ranges::rotate(other, other.begin() + later);
        EXPECT_EQ(places(telling_points(other, kTolerance), other), expected) << later;
        std::ranges::reverse(other);
        EXPECT_EQ(places(telling_points(other, kTolerance), other), expected) << later;
    }
}

TEST(TellingPoints, OfOneLineDoNotDependOnOthers) {
    const std::vector<BoundaryPoint> alone = smooth_ring();
    std::vector<BoundaryPoint> both = ring(
        77, [](double) { return 90.0; }, 1);
    both.insert(both.end(), alone.begin(), alone.end());
    const std::vector<Vec3> expected = places(telling_points(alone, 0.01), alone),
                            found = places(telling_points(both, 0.01), both);
    EXPECT_TRUE(std::ranges::all_of(expected, [&](const Vec3& p) { return std::ranges::count(found, p) == 1; }));
}

TEST(TellingPoints, KeepCornersEndsShortLinesAndSinglePoints) {
    std::vector<BoundaryPoint> points = open_line();
    points[41].inplane_normal = points[42].inplane_normal = {};
    points.push_back({.position = {1, 2, 3}, .contour = kNoContour});
    for (BoundaryPoint point : ring(
             9, [](double) { return 5.0; }, 1))
        points.push_back(point);
    const std::vector<std::size_t> taken = telling_points(points, 0.01).numbers;
    for (const std::size_t i : {0, 41, 42, 199, 200, 201, 205, 209}) EXPECT_EQ(std::ranges::count(taken, i), 1) << i;
}

TEST(TellingPoints, ToleranceIsOfThePartThatAPointBelongsTo) {
    std::vector<BoundaryPoint> points = ring(120, [](double angle) { return smooth(2 * angle); });
    const std::size_t few = telling_points(points, 0.1).numbers.size();
    for (BoundaryPoint& point : points) point.extent = 0.01;
    EXPECT_GT(telling_points(points, 0.1).numbers.size(), 2 * few);
}

TEST(TellingPoints, PointsAtTheSamePlaceAreKept) {
    std::vector<BoundaryPoint> points = smooth_ring();
    for (BoundaryPoint& point : points) point.position = points.front().position;
    EXPECT_EQ(telling_points(points, 0.01).numbers.size(), points.size());
}

TEST(TellingPoints, TellTheRestUnlessAFunctionMissesIt) {
    std::vector<BoundaryPoint> points = smooth_ring();
    const std::vector<BoundaryPoint> line = open_line();
    points.insert(points.end(), line.begin(), line.end());
    for (std::size_t i = 300; i < points.size(); ++i) points[i].contour = 1;
    const TellingPoints telling = telling_points(points, 0.01);
    std::vector<double> values(points.size(), 0.0);
    EXPECT_TRUE(tell_the_rest(telling, points, values, 0.01));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool is_taken = std::ranges::binary_search(telling.numbers, i);
        for (const double missed : {0.02, -0.02, std::numeric_limits<double>::quiet_NaN()}) {
            values[i] = missed;
            EXPECT_EQ(tell_the_rest(telling, points, values, 0.01), is_taken && !std::isnan(missed)) << i;
        }
        values[i] = 0.009;
        EXPECT_TRUE(tell_the_rest(telling, points, values, 0.01)) << i;
        values[i] = 0;
    }
    // Where contours contradict each other f misses those that were taken, too.
    std::ranges::fill(values, 3.0);
    EXPECT_TRUE(tell_the_rest(telling, points, values, 0.01));
}

}  // namespace
}  // namespace kontur
