// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/spread.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/random.h"

namespace kontur {
namespace {

/// A ring that wavers by hand.
LinePoints drawn_ring(std::size_t count, std::mt19937& random) {
    std::uniform_real_distribution<double> waver(-0.3, 0.3);
    LinePoints ring{{}, true};
    for (std::size_t i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * (static_cast<double>(i) + waver(random)) / static_cast<double>(count);
        ring.positions.push_back((20 + waver(random)) * Vec3{std::cos(angle), std::sin(angle), 0});
    }
    return ring;
}

std::vector<Vec3> taken(const LinePoints& line, double apart_mm, std::size_t neighbours) {
    const std::vector<bool> chosen = spread_along(line, std::vector<double>(line.positions.size(), apart_mm), neighbours);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < chosen.size(); ++i)
        if (chosen[i]) points.push_back(line.positions[i]);
    std::ranges::sort(points, {}, [](const Vec3& p) { return std::pair(p.x, p.y); });
    return points;
}

TEST(SpreadAlong, TakesTheSamePointsWhereverARingBeginsAndWhicheverWayItRuns) {
    std::mt19937 random = test::random_of_this_test();
    const LinePoints ring = drawn_ring(150, random);
    for (const auto& [apart_mm, neighbours] : {std::pair(2.5, 1u), {0.0, 1u}, {6.0, 0u}}) {
        const std::vector<Vec3> points = taken(ring, apart_mm, neighbours);
        for (const int later : {1, 50, 149}) {
            LinePoints other = ring;
            std::ranges::rotate(other.positions, other.positions.begin() + later);
            EXPECT_EQ(taken(other, apart_mm, neighbours), points);
            std::ranges::reverse(other.positions);
            EXPECT_EQ(taken(other, apart_mm, neighbours), points);
        }
    }
}

TEST(SpreadAlong, KeepsTheDistanceAndLeavesNoRoomForMore) {
    std::mt19937 random = test::random_of_this_test();
    const LinePoints ring = drawn_ring(150, random);
    const std::size_t n = ring.positions.size();
    constexpr double kApart = 4;
    const std::vector<bool> chosen = spread_along(ring, std::vector<double>(n, kApart), 0);
    std::vector<std::size_t> at;
    for (std::size_t i = 0; i < 2 * n; ++i)
        if (chosen[i % n]) at.push_back(i);
    for (std::size_t k = 0; k + 1 < at.size(); ++k) {
        double way = 0, longest = 0;
        for (std::size_t i = at[k]; i < at[k + 1]; ++i) {
            const double step = distance(ring.positions[i % n], ring.positions[(i + 1) % n]);
            way += step;
            longest = std::max(longest, step);
        }
        EXPECT_GE(way, kApart);
        EXPECT_LT(way, 2 * (kApart + longest));
    }
}

TEST(SpreadAlong, ChangesNearADraggedPointAlone) {
    std::mt19937 random = test::random_of_this_test();
    const LinePoints ring = drawn_ring(150, random);
    const std::vector<double> apart(150, 2.5);
    const std::vector<bool> before = spread_along(ring, apart, 1);
    LinePoints dragged = ring;
    for (const double by : {1.02, 1.1, 1.3}) {
        dragged.positions[75] = by * ring.positions[75];
        const std::vector<bool> after = spread_along(dragged, apart, 1);
        for (std::size_t i = 0; i < 150; ++i)
            if (i < 55 || i > 95) {
                EXPECT_EQ(before[i], after[i]) << i;
            }
    }
}

TEST(SpreadAlong, AStraightLineIsWalkedFromItsStart) {
    LinePoints line{{}, false};
    for (int i = 0; i < 12; ++i) line.positions.push_back({1.0 * i, 0, 0});
    EXPECT_EQ(taken(line, 5, 1), (std::vector<Vec3>{{0, 0, 0}, {5, 0, 0}, {10, 0, 0}}));
    EXPECT_EQ(taken(line, 0, 0).size(), 12u);
    EXPECT_EQ(taken({{{1, 2, 3}}, true}, 5, 1).size(), 1u);
}

}  // namespace
}  // namespace kontur
