// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/livewire.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "kontur/base/error.h"

namespace kontur {
namespace {

constexpr int kSize = 128;
constexpr double kCenter = 63.3, kRadius = 40.2;

/// A bright disc with an edge blurred over about a pixel.
std::vector<float> disc(double contrast, double noise) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0, 1);
    std::vector<float> values;
    for (int row = 0; row < kSize; ++row)
        for (int column = 0; column < kSize; ++column) {
            const double depth = kRadius - std::hypot(column - kCenter, row - kCenter);
            values.push_back(static_cast<float>(contrast / (1 + std::exp(-2 * depth)) + noise * normal(random)));
        }
    return values;
}

Pixel on_circle(double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    return {static_cast<int>(std::lround(kCenter + kRadius * std::cos(angle))),
            static_cast<int>(std::lround(kCenter + kRadius * std::sin(angle)))};
}

double off_circle(const PixelPosition& p) { return std::abs(std::hypot(p[0] - kCenter, p[1] - kCenter) - kRadius); }

int path_cost(const EdgeMap& edges, const std::vector<Pixel>& path) {
    int sum = 0;
    for (std::size_t i = 1; i < path.size(); ++i) sum += edges.cost(path[i - 1], path[i]);
    return sum;
}

/// All distances from a seed by relaxation until nothing changes.
std::vector<int> relaxed_distances(const EdgeMap& edges, Pixel seed) {
    const int width = edges.width(), height = edges.height();
    constexpr int kFar = std::numeric_limits<int>::max() / 2;
    std::vector<int> distance(static_cast<std::size_t>(width) * height, kFar);
    const auto at = [&](Pixel p) -> int& { return distance[static_cast<std::size_t>(p.row) * width + p.column]; };
    at(seed) = 0;
    for (bool changed = true; changed;) {
        changed = false;
        for (int row = 0; row < height; ++row)
            for (int column = 0; column < width; ++column)
                for (int dr = -1; dr <= 1; ++dr)
                    for (int dc = -1; dc <= 1; ++dc) {
                        const Pixel from{column, row}, to{column + dc, row + dr};
                        if ((dc == 0 && dr == 0) || !edges.contains(to)) continue;
                        const int through = at(from) + edges.cost(from, to);
                        if (through < at(to)) at(to) = through, changed = true;
                    }
    }
    return distance;
}

TEST(LiveWire, FollowsAFaintNoisyEdgeWithinAPixel) {
    const EdgeMap edges(disc(50, 10), kSize, kSize);
    LiveWire wire(edges, on_circle(10));
    for (const double degrees : {60.0, 120.0, 300.0})
        for (const PixelPosition& p : smooth_path(edges, wire.path_to(on_circle(degrees)))) EXPECT_LT(off_circle(p), 1.5);
}

TEST(LiveWire, FollowsACleanEdgeWithinAFractionOfAPixel) {
    const EdgeMap edges(disc(100, 0), kSize, kSize);
    LiveWire wire(edges, edges.snap(on_circle(0), 3));
    for (const PixelPosition& p : smooth_path(edges, wire.path_to(edges.snap(on_circle(90), 3))))
        EXPECT_LT(off_circle(p), 0.35);
}

TEST(LiveWire, PathsCostWhatRelaxationFinds) {
    std::mt19937 random(3);
    std::vector<float> values(24 * 17);
    for (float& v : values) v = static_cast<float>(random() % 100);
    const EdgeMap edges(values, 24, 17);
    const Pixel seed{5, 11};
    const std::vector<int> expected = relaxed_distances(edges, seed);
    LiveWire wire(edges, seed);
    for (int row = 0; row < 17; ++row)
        for (int column = 0; column < 24; ++column)
            EXPECT_EQ(path_cost(edges, wire.path_to({column, row})), expected[static_cast<std::size_t>(row) * 24 + column]);
}

TEST(LiveWire, APathDoesNotDependOnEarlierOnes) {
    const EdgeMap edges(disc(50, 10), kSize, kSize);
    LiveWire fresh(edges, on_circle(0)), used(edges, on_circle(0));
    used.path_to({2, 2});
    used.path_to(on_circle(200));
    EXPECT_EQ(used.path_to(on_circle(77)), fresh.path_to(on_circle(77)));
}

TEST(LiveWire, PathsAreConnectedFromSeedToTarget) {
    const EdgeMap edges(disc(50, 10), kSize, kSize);
    LiveWire wire(edges, {3, 4});
    const std::vector<Pixel> path = wire.path_to({120, 99});
    EXPECT_EQ(path.front(), (Pixel{3, 4}));
    EXPECT_EQ(path.back(), (Pixel{120, 99}));
    for (std::size_t i = 1; i < path.size(); ++i)
        EXPECT_EQ(std::max(std::abs(path[i].column - path[i - 1].column), std::abs(path[i].row - path[i - 1].row)), 1);
}

TEST(LiveWire, TargetsBeyondTheReachAreMovedToItsBorder) {
    const EdgeMap edges(disc(50, 0), kSize, kSize);
    LiveWire wire(edges, {60, 60}, 10);
    EXPECT_EQ(wire.path_to({500, 62}).back(), (Pixel{70, 62}));
    EXPECT_EQ(wire.path_to({60, 60}).size(), 1u);
}

TEST(LiveWire, WithoutAnyEdgeThePathIsShort) {
    const EdgeMap edges(std::vector<float>(64 * 64, 7.f), 64, 64);
    LiveWire wire(edges, {10, 10});
    EXPECT_EQ(wire.path_to({40, 10}).size(), 31u);
    EXPECT_EQ(edges.snap({10, 10}, 5), (Pixel{10, 10}));
    EXPECT_EQ(edges.strength({10, 10}), 0);
}

TEST(EdgeMap, SnapsToTheEdgeNearby) {
    const EdgeMap edges(disc(100, 0), kSize, kSize);
    for (const double degrees : {0.0, 33.0, 90.0, 211.0}) {
        Pixel p = on_circle(degrees);
        p.column += 3;
        const Pixel snapped = edges.snap(p, 6);
        EXPECT_LT(off_circle(edges.subpixel_position(snapped)), 0.3) << degrees;
        EXPECT_LE(std::hypot(snapped.column - p.column, snapped.row - p.row), 6);
    }
}

TEST(EdgeMap, CostsStayWithinTheBucketQueue) {
    std::mt19937 random(11);
    std::vector<float> values(32 * 32);
    for (float& v : values) v = static_cast<float>(random()) * (random() % 3 ? 1.f : 1e30f);
    values[40] = std::numeric_limits<float>::quiet_NaN();
    values[90] = std::numeric_limits<float>::infinity();
    const EdgeMap edges(values, 32, 32);
    for (int row = 1; row < 31; ++row)
        for (int column = 1; column < 31; ++column)
            for (int dr = -1; dr <= 1; ++dr)
                for (int dc = -1; dc <= 1; ++dc) {
                    if (dr == 0 && dc == 0) continue;
                    const int cost = edges.cost({column, row}, {column + dc, row + dr});
                    EXPECT_GE(cost, 1);
                    EXPECT_LE(cost, EdgeMap::kMostCost);
                }
}

TEST(EdgeMap, RefusesASliceWithoutRoomForAnEdge) {
    EXPECT_THROW(EdgeMap(std::vector<float>(4), 2, 2), Error);
    EXPECT_THROW(EdgeMap(std::vector<float>(8), 3, 3), Error);
    const EdgeMap edges(std::vector<float>(9), 3, 3);
    EXPECT_THROW(LiveWire(edges, {3, 0}), Error);
}

}  // namespace
}  // namespace kontur
