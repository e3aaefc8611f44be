// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/point_tree.h"

#include <gtest/gtest.h>

#include "support/random_masks.h"

namespace kontur {
namespace {

double brute_force_distance(const std::vector<Vec3>& points, const Vec3& p) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3& point : points) {
        const Vec3 d = p - point;
        nearest = std::min(nearest, dot(d, d));
    }
    return std::sqrt(nearest);
}

TEST(PointTree, AgreesWithLookingAtEveryPoint) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> number(-50, 50);
    const auto vector = [&] { return Vec3{number(random), 3 * number(random), 0.1 * number(random)}; };
    for (const std::size_t count : {1u, 2u, 8u, 9u, 10u, 100u, 3000u}) {
        std::vector<Vec3> points(count);
        for (Vec3& p : points) p = vector();
        const PointTree tree(points);
        for (int query = 0; query < 200; ++query) {
            const Vec3 p = query % 2 ? vector() : 20 * vector();
            ASSERT_EQ(tree.distance_to(p), brute_force_distance(points, p)) << count << " points";
        }
        for (const Vec3& p : points) ASSERT_EQ(tree.distance_to(p), 0);
    }
}

TEST(PointTree, AgreesOnALatticeFullOfTies) {
    std::vector<Vec3> points;
    for (int i = 0; i < 1000; ++i) points.push_back({double(i % 10), double(i / 10 % 10), double(i / 100)});
    const PointTree tree(points);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 p{i % 10 + 0.5, i / 10 % 10 * 1.5, i / 100 - 3.0};
        ASSERT_EQ(tree.distance_to(p), brute_force_distance(points, p));
    }
}

TEST(PointTree, FindsTheLeastOfACostThatIsNowhereLessThanTheSquaredDistance) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> number(-50, 50);
    const auto vector = [&] { return Vec3{number(random), number(random), number(random)}; };
    std::vector<Vec3> points(2000);
    for (Vec3& p : points) p = vector();
    const PointTree tree(points);
    const auto above = [](const Vec3& d) { return d.z > 5 ? dot(d, d) : std::numeric_limits<double>::infinity(); };
    for (int query = 0; query < 200; ++query) {
        const Vec3 p = vector();
        double least = std::numeric_limits<double>::infinity();
        for (const Vec3& q : points) least = std::min(least, above(q - p));
        ASSERT_EQ(tree.least(p, above), least);
    }
}

TEST(PointTree, CoincidentPointsAreOne) {
    const PointTree tree(std::vector<Vec3>(1000, Vec3{1, 2, 3}));
    EXPECT_EQ(tree.distance_to({1, 2, 5}), 2);
}

TEST(PointTree, NothingIsInfinitelyFar) {
    EXPECT_EQ(PointTree({}).distance_to({1, 2, 3}), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace kontur
