// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/searched_band.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kontur {
namespace {

/// On a surface around the origin, about 2 mm apart; the radius depends on the height of the direction, -1 .. 1.
template <class Radius>
std::vector<Vec3> points_around(const Radius& radius) {
    constexpr int kCount = 3000;
    std::vector<Vec3> points;
    for (int n = 0; n < kCount; ++n) {
        const double z = 1 - 2 * (n + 0.5) / kCount, across = std::sqrt(1 - z * z), angle = 2.399963 * n;
        if (const double r = radius(z); r > 0)
            points.push_back(r * Vec3{across * std::cos(angle), across * std::sin(angle), z});
    }
    return points;
}

const auto ball = [](double) { return 30.0; };

SearchedBand band_about_ball(double reach_mm) {
    std::vector<Vec3> points = points_around(ball);
    std::vector<double> reach(points.size(), reach_mm);
    return {std::move(points), std::move(reach)};
}

TEST(SearchedBand, IsNotLeftByASurfaceThatMovesNoFartherThanItReaches) {
    const SearchedBand band = band_about_ball(5);
    EXPECT_TRUE(band.left_from(points_around(ball)).empty());
    EXPECT_TRUE(band.left_from(points_around([](double z) { return 30 + 4 * z; })).empty());
}

TEST(SearchedBand, TellsFromWhereASurfaceRanAway) {
    const std::vector<Vec3> left = band_about_ball(5).left_from(points_around([](double z) { return z > 0.9 ? 45 : 30; }));
    ASSERT_FALSE(left.empty());
    for (const Vec3& p : left) EXPECT_GT(p.z, 30 * 0.85);
}

TEST(SearchedBand, TellsWhereASurfaceIsMissing) {
    const std::vector<Vec3> left =
        band_about_ball(5).left_from(points_around([](double z) { return z < -0.5 ? 0 : 30; }), {.threads = 3});
    ASSERT_FALSE(left.empty());
    for (const Vec3& p : left) EXPECT_LT(p.z, -15);
    EXPECT_EQ(band_about_ball(5).left_from({}).size(), points_around(ball).size());
}

TEST(SearchedBand, AboutNothingIsNeverLeft) { EXPECT_TRUE(SearchedBand({}, {}).left_from(points_around(ball)).empty()); }

}  // namespace
}  // namespace kontur
