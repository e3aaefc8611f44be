// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/geometry/keyhole.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kontur {
namespace {

constexpr double kToleranceMm = 1e-3;

/// A ring with a hole and a channel between the first points of both, in the plane that two of the axes span.
struct Drawn {
    std::vector<Vec3> outer, hole, path;
};

Drawn draw(int u, int v, int points, double channel_mm) {
    Drawn drawn;
    for (int n = 0; n < points; ++n) {
        const double angle = 2 * std::numbers::pi * n / points;
        Vec3 p{5, 6, 7};
        p[u] += std::cos(angle);
        p[v] += std::sin(angle);
        drawn.outer.push_back(p);
        drawn.hole.push_back(Vec3{5, 6, 7} + 0.5 * (p - Vec3{5, 6, 7}));
    }
    std::reverse(drawn.hole.begin() + 1, drawn.hole.end());
    drawn.path = drawn.outer;
    Vec3 aside{};
    aside[v] = channel_mm;
    drawn.path.push_back(drawn.outer[0] + aside);
    drawn.path.insert(drawn.path.end(), drawn.hole.begin(), drawn.hole.end());
    drawn.path.push_back(drawn.hole[0] + aside);
    return drawn;
}

TEST(Keyhole, SplitsAlikeInPlanesAcrossAnyAxis) {
    for (const auto& [u, v] : {std::pair{0, 1}, {1, 2}, {2, 0}})
        for (const int points : {12, 300}) {
            const Drawn drawn = draw(u, v, points, 0.9 * kToleranceMm);
            const auto rings = split_keyhole(drawn.path, kToleranceMm);
            ASSERT_EQ(rings.size(), 2u) << u << v;
            EXPECT_TRUE(rings[0] == drawn.outer);
            EXPECT_TRUE(std::is_permutation(rings[1].begin(), rings[1].end(), drawn.hole.begin(), drawn.hole.end()));
        }
}

TEST(Keyhole, AWiderChannelIsNoChannel) {
    for (const auto& [u, v] : {std::pair{0, 1}, {1, 2}, {2, 0}}) {
        const std::vector<Vec3> path = draw(u, v, 12, 1.1 * kToleranceMm).path;
        EXPECT_EQ(split_keyhole(path, kToleranceMm), (std::vector<std::vector<Vec3>>{path}));
    }
}

TEST(Keyhole, FindsChannelsWhereverTheyLieInTheCellsOfTheSearch) {
    for (int n = 0; n < 200; ++n) {
        Drawn drawn = draw(0, 1, 12, 0.9 * kToleranceMm);
        const double shift = -6 + 0.07 * n * kToleranceMm;
        for (Vec3& p : drawn.path) p = p + Vec3{shift, shift, shift};
        EXPECT_EQ(split_keyhole(drawn.path, kToleranceMm).size(), 2u) << n;
    }
}

TEST(Keyhole, EndsForCoordinatesBeyondAllIntegers) {
    const std::vector<Vec3> path{{1e300, 0, 0}, {-1e300, 1e300, 0}, {0, -1e300, 0}, {-1e300, 1e300, 0}};
    EXPECT_LE(split_keyhole(path, kToleranceMm).size(), 1u);
}

}  // namespace
}  // namespace kontur
