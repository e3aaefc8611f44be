// SPDX-License-Identifier: Apache-2.0
#include "viewer/edits/snapped_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "viewer/drawn_contours.h"

namespace kontur::viewer {
namespace {

constexpr double kRadius = 10;

/// Of a rod that leans: its centre at this height.
Vec3 centre_at(double z) { return {20 + 0.6 * (z - 20), 20, z}; }

/// 0 outside, `inside` in the rod, `rim` in the 1.5 mm within its border, and noise.
Image rod(double inside, double rim, double noise) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    Image image{{{40, 40, 40}, {}}, std::vector<float>(64000)};
    auto& values = std::get<std::vector<float>>(image.samples);
    for (std::int64_t k = 0; k < 40; ++k)
        for (std::int64_t j = 0; j < 40; ++j)
            for (std::int64_t i = 0; i < 40; ++i) {
                const Vec3 p = image.grid.center_mm(i, j, k);
                const double depth = kRadius - distance(p, centre_at(p.z));
                values[image.grid.offset(i, j, k)] = static_cast<float>((depth < 0     ? 0
                                                                         : depth < 1.5 ? rim
                                                                                       : inside) +
                                                                        noise * normal(random));
            }
    return image;
}

std::vector<Vec3> circle_around(const Vec3& centre) {
    std::vector<Vec3> points = test::circle(80, kRadius);
    for (Vec3& p : points) p = p - test::kPlane.origin + centre;
    return points;
}

Plane at_height(double z) {
    Plane plane = test::kPlane;
    plane.origin.z = z;
    return plane;
}

/// How far the circle that was drawn at a height of 20, proposed as it is at 24, is from the rod's border there, once
/// snapped.
double largest_error(const Image& image) {
    const Plane there = at_height(24);
    const std::vector<Vec3> drawn = circle_around(centre_at(20));
    std::vector<Vec3> expected = drawn;
    for (Vec3& p : expected) p.z = 24;
    double largest = 0;
    for (const Vec3& p : snapped_line({expected, there}, {drawn, at_height(20)}, image)) {
        EXPECT_NEAR(p.z, 24, 1e-9);
        largest = std::max(largest, std::abs(distance(p, centre_at(24)) - kRadius));
    }
    return largest;
}

TEST(SnappedLine, GoesToTheBorderThatWasDrawn) {
    EXPECT_LT(largest_error(rod(100, 100, 0)), 0.8);
    EXPECT_LT(largest_error(rod(-100, -100, 0)), 0.8) << "dark on bright";
    EXPECT_LT(largest_error(rod(100, 100, 30)), 1.2) << "in noise";
    EXPECT_LT(largest_error(rod(0, 100, 0)), 0.8) << "a thin rim";
}

TEST(SnappedLine, StaysWhereTheImageSaysNothing) {
    EXPECT_NEAR(largest_error(rod(0, 0, 0)), 2.4, 0.01) << "as it was expected: 4 mm on, by 0.6 each";
    const std::vector<Vec3> tiny{{20, 20, 24}, {21, 20, 24}, {20, 21, 24}};
    EXPECT_EQ(snapped_line({tiny, at_height(24)}, {circle_around(centre_at(20)), at_height(20)}, rod(100, 100, 0)), tiny);
}

}  // namespace
}  // namespace kontur::viewer
