// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "kontur/derive/derive.h"
#include "solid_levels.h"

namespace kontur {
namespace {

NamedStructure ball_at(const std::string& name, const Vec3& center, double radius, const Grid& grid) {
    test::Solid solid{name, [=](const Vec3& p) { return radius - distance(p, center); }, {}};
    return {name, test::mask_of(solid, grid), {}};
}

TEST(Relations, OfTwoBallsAreThoseOfTheirCentres) {
    const Grid grid = test::grid_of({1, 1, 1.5}, 0.17, 30);
    const std::vector<NamedStructure> balls{ball_at("a", {-10, 0, 0}, 8, grid), ball_at("b", {9, 2, 0}, 6, grid),
                                            ball_at("c", {-9, 0, 0}, 4, grid)};
    const std::vector<StructureRelation> found = relations(balls, {.threads = 2});
    ASSERT_EQ(found.size(), 3U);
    const StructureRelation &ab = found[0], &ac = found[1];
    const double apart = std::hypot(19, 2);
    EXPECT_EQ(ab.a + ab.b, "ab");
    EXPECT_NEAR(ab.volume_a_ml, 2.145, 0.05);
    EXPECT_EQ(ab.overlap_ml, 0);
    ASSERT_TRUE(ab.least_distance_mm);
    EXPECT_NEAR(*ab.least_distance_mm, apart - 14, 0.4);
    EXPECT_NEAR(ab.a_beyond_b_mm, apart + 8 - 6, 0.4);
    EXPECT_NEAR(ab.b_beyond_a_mm, apart + 6 - 8, 0.4);
    EXPECT_NEAR(distance(ab.a_beyond_b, {-10, 0, 0}), 8, 0.4);
    EXPECT_EQ(ac.b, "c");
    EXPECT_DOUBLE_EQ(ac.overlap_ml, ac.volume_b_ml);
    EXPECT_EQ(*ac.least_distance_mm, 0);
    EXPECT_NEAR(ac.a_beyond_b_mm, 1 + 8 - 4, 0.4);
    EXPECT_EQ(ac.b_beyond_a_mm, 0);
}

TEST(Relations, OfAnEmptyOneHaveNoDistance) {
    const Grid grid = test::grid_of({1, 1, 1}, 0, 12);
    const std::vector<StructureRelation> found =
        relations(std::vector{ball_at("a", {}, 8, grid), ball_at("none", {}, -1, grid)}, {});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_FALSE(found[0].least_distance_mm);
    EXPECT_EQ(found[0].volume_b_ml, 0);
}

}  // namespace
}  // namespace kontur
