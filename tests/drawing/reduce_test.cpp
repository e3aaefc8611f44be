// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/reduce.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/contour_sets.h"
#include "support/expect_error.h"
#include "support/polygons.h"
#include "support/random.h"
#include "support/subsequence.h"

namespace kontur {
namespace {

using test::is_subsequence;
using test::Point2;

const Plane kTilted = make_plane({30, -20, 100}, {0.3, -0.5, 0.8});

/// Weight of the middle point as the paper prints it.
double weight(const Vec3& before, const Vec3& at, const Vec3& after) {
    const Vec3 a = at - before, b = after - at;
    const double cosine = dot(normalized(a), normalized(b));
    return 0.5 * (1 - cosine) * norm(a) * norm(b) / (norm(a) + norm(b));
}

/// Removes the least important point of all, again and again, with all weights computed afresh.
std::vector<Vec3> reduced_naively(std::vector<Vec3> points, std::size_t keep) {
    while (points.size() > keep) {
        const std::size_t n = points.size();
        std::vector<double> weights;
        for (std::size_t i = 0; i < n; ++i)
            weights.push_back(weight(points[(i + n - 1) % n], points[i], points[(i + 1) % n]));
        points.erase(points.begin() + (std::min_element(weights.begin(), weights.end()) - weights.begin()));
    }
    return points;
}

TEST(Reduce, KeepsExactlyTheAskedShareInOrder) {
    std::mt19937 random = test::random_of_this_test();
    for (const int count : {3, 5, 6, 7, 10, 100, 137})
        for (const int percent : {100, 99, 55, 50, 20, 7, 1}) {
            const Contour contour = test::contour_in(kTilted, test::random_star(count, random), true);
            const Contour reduced = reduce(contour, {percent / 100.0});
            const int share = (count * percent + 99) / 100;
            EXPECT_EQ(static_cast<int>(reduced.points.size()), std::max(share, std::min(count, 6)))
                << count << " " << percent;
            EXPECT_TRUE(is_subsequence(reduced.points, contour.points));
            EXPECT_EQ(reduced.plane, contour.plane);
            EXPECT_TRUE(reduced.hole);
        }
}

TEST(Reduce, RemovesWhatAWorkedExampleSays) {
    // (4, 2.2) lies on its side exactly: weight 0. At (2, -0.1) the path turns by twice the angle of slope 0.05, so
    // (1 - cos) / 2 = 0.05^2 / (1 + 0.05^2) = 0.0024938, times half the edges' length 2.0025: 0.0024969.
    const std::vector<Point2> points{{0, 0}, {2, -0.1}, {4, 0}, {4, 2.2}, {4, 4}, {2, 5}, {0, 4}};
    const auto kept = [&](std::size_t keep) {
        return reduce(test::contour_in(Plane{}, points), {.quality = 0.01, .min_points = keep}).points;
    };
    EXPECT_NEAR(weight({0, 0, 0}, {2, -0.1, 0}, {4, 0, 0}), 0.0024969, 1e-7);
    EXPECT_EQ(kept(6), (std::vector<Vec3>{{0, 0, 0}, {2, -0.1, 0}, {4, 0, 0}, {4, 4, 0}, {2, 5, 0}, {0, 4, 0}}));
    EXPECT_EQ(kept(5), (std::vector<Vec3>{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 5, 0}, {0, 4, 0}}));
}

TEST(Reduce, AgreesWithRecomputingAllWeightsAtEveryStep) {
    std::mt19937 random = test::random_of_this_test();
    for (int round = 0; round < 40; ++round) {
        const Contour contour = test::contour_in(
            kTilted, round % 2 ? test::random_star(20 + 3 * round, random) : test::random_tangle(20 + 3 * round, random));
        for (const double quality : {0.8, 0.3, 0.1}) {
            const std::vector<Vec3> reduced = reduce(contour, {quality}).points;
            EXPECT_EQ(reduced, reduced_naively(contour.points, reduced.size()));
        }
    }
}

TEST(Reduce, RepeatedPointsGoFirst) {
    const Contour once = test::circle(kTilted, 10, 20);
    Contour contour = once;
    for (const std::ptrdiff_t i : {19, 7, 3}) {
        const Vec3 repeated = contour.points[static_cast<std::size_t>(i)];
        contour.points.insert(contour.points.begin() + i, repeated);
    }
    EXPECT_EQ(reduce(contour, {20.0 / 23}).points, once.points);
}

TEST(Reduce, RefusesAQualityOutsideOfItsRange) {
    const Contour contour = test::circle(kTilted, 10, 20);
    for (const double quality : {0.0, -1.0, 1.0001, std::nan("")})
        EXPECT_KONTUR_ERROR(reduce(contour, {quality}), ErrorKind::invalid_input, "quality");
}

}  // namespace
}  // namespace kontur
