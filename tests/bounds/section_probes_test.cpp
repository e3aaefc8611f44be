// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/section_probes.h"
#include "support/polygons.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kontur {
namespace {

using test::figure_of_eight;

Polygon2 circle(double radius, int points = 180, double turned = 0) {
    Polygon2 line;
    for (int i = 0; i < points; ++i)
        line.push_back(
            {radius * std::cos(turned + 2 * M_PI * i / points), radius * std::sin(turned + 2 * M_PI * i / points)});
    return line;
}

TEST(AreasWithoutHoles, AreOfWhatIsFilled) {
    const Section ring{{}, {circle(10), circle(9)}, {0, 1}, {false, true}};
    EXPECT_NEAR(areas_without_holes(ring)[0], M_PI * (100 - 81), 0.1);
    EXPECT_EQ(areas_without_holes(ring)[1], 0);
    const Section beside{{}, {circle(1), circle(9)}, {0, 1}, {false, true}};
    EXPECT_GT(areas_without_holes(beside)[0], 0) << "a hole that is larger than what it is cut from";
}

TEST(Probes, FallIntoWallsHoweverThinAndTurned) {
    for (const double wall : {2.0, 0.5, 0.2})
        for (const double turned : {0.0, 0.3}) {
            const Section ring{{}, {circle(10, 180, turned), circle(10 - wall, 180, turned)}, {0, 1}, {false, true}};
            const std::vector<Probe> inside = probes(ring);
            int octants[8] = {};
            for (const Probe& probe : inside) {
                EXPECT_NEAR(std::hypot(probe.at[0], probe.at[1]), 10 - wall / 2, wall / 2);
                ++octants[static_cast<int>((std::atan2(probe.at[1], probe.at[0]) + M_PI) / (M_PI / 4)) % 8];
            }
            for (const int count : octants) EXPECT_GT(count, 3) << wall;
        }
}

TEST(Probes, OfALineThatCrossesItselfAreAsManyAsOfOthers) {
    const Section eight{{}, {figure_of_eight()}, {0}, {false}};
    EXPECT_GT(probes(eight).size(), 80u);
    EXPECT_LT(probes(eight).size(), 400u);
}

}  // namespace
}  // namespace kontur
