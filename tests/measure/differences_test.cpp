// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/differences.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/measure/compare.h"
#include "support/expect_error.h"
#include "support/mask_of.h"

namespace kontur {
namespace {

Grid grid_of(const Index3& size, const Vec3& a, const Vec3& b, const Vec3& c) {
    Grid grid{size, {}};
    grid.index_to_mm.set_column(0, a);
    grid.index_to_mm.set_column(1, b);
    grid.index_to_mm.set_column(2, c);
    return grid;
}

bool in_ball(const Vec3& p, const Vec3& center, double radius) { return distance(p, center) <= radius; }

double sum_ml(const std::vector<Difference>& all, bool in_first) {
    double sum = 0;
    for (const Difference& one : all)
        if (one.in_first == in_first) sum += one.volume_ml;
    return sum;
}

/// Straight from the definition.
double distance_to(const Vec3& p, const Mask& mask) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::int64_t k = 0; k < mask.grid.size.k; ++k)
        for (std::int64_t j = 0; j < mask.grid.size.j; ++j)
            for (std::int64_t i = 0; i < mask.grid.size.i; ++i)
                if (mask.values[mask.grid.offset(i, j, k)])
                    nearest = std::min(nearest, distance(p, mask.grid.center_mm(i, j, k)));
    return nearest;
}

TEST(Differences, NameBulgesOnALayerThatIsEverywhere) {
    const Grid grid = grid_of({60, 60, 60}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    const Vec3 center{30, 30, 30}, right{50, 30, 30}, up{30, 30, 48};
    const Mask b = test::mask_of(grid, [&](const Vec3& p) { return in_ball(p, center, 16); });
    const Mask a = test::mask_of(grid, [&](const Vec3& p) {
        return in_ball(p, center, 17) || in_ball(p, right, 4) || in_ball(p, up, 4);  // 8 mm and 6 mm high, one layer between
    });
    const std::vector<Difference> found = differences(a, b);
    ASSERT_GE(found.size(), 2u);
    EXPECT_EQ(found[0].at, (Vec3{54, 30, 30}));
    EXPECT_EQ(found[0].distance_mm, 8);
    EXPECT_EQ(found[1].at, (Vec3{30, 30, 52}));
    EXPECT_EQ(found[1].distance_mm, 6);
    for (const Difference& one : found) EXPECT_TRUE(one.in_first);
    for (std::size_t n = 2; n < found.size(); ++n) EXPECT_LE(found[n].distance_mm, 2) << "the layer";
    EXPECT_NEAR(sum_ml(found, true), compare(a, b).volume_a_ml - compare(a, b).volume_b_ml, 1e-9);
    const std::vector<Difference> other_way = differences(b, a);
    ASSERT_EQ(other_way.size(), found.size());
    EXPECT_EQ(other_way[0].at, found[0].at);
    EXPECT_FALSE(other_way[0].in_first);
}

TEST(Differences, AShiftedBallHasOneOnEachSide) {
    const Grid grid = grid_of({50, 50, 20}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2.5});
    const Mask a = test::mask_of(grid, [](const Vec3& p) { return in_ball(p, {24, 25, 25}, 15); });
    const Mask b = test::mask_of(grid, [](const Vec3& p) { return in_ball(p, {28, 25, 25}, 15); });
    const std::vector<Difference> found = differences(a, b);
    ASSERT_GE(found.size(), 2u);
    for (std::size_t n = 2; n < found.size(); ++n)
        EXPECT_LT(found[n].volume_ml, 0.1 * found[0].volume_ml) << "what is thin at the rims of the crescents";
    EXPECT_NE(found[0].in_first, found[1].in_first);
    EXPECT_EQ(found[0].distance_mm, 4);
    EXPECT_EQ(found[0].volume_ml, found[1].volume_ml);
}

TEST(Differences, AreAllVoxelsAndTheirDistancesAreExact) {
    const Grid grids[] = {grid_of({14, 12, 9}, {0.7, 0, 0}, {0, 1.1, 0}, {0, 0, 3}),
                          grid_of({14, 12, 9}, {0.6, 0.4, 0}, {0.5, -0.9, 0.1}, {0, 0.8, 2.5})};
    for (const Grid& grid : grids) {
        for (int round = 0; round < 10; ++round) {
            const Vec3 at{0.4 * round, 0.2 * round - 2, 12.0};
            const auto wavy = [&](double amount) {
                return test::mask_of(grid, [&, amount](const Vec3& p) {
                    return distance(p, at + Vec3{4, 2, 0}) < 6 + amount * std::sin(3 * p.x + round) * std::cos(2 * p.y);
                });
            };
            const Mask a = wavy(2), b = wavy(-2);
            const std::vector<Difference> found = differences(a, b, kSaddle, {.threads = 2});
            std::int64_t alone[2]{};
            for (std::size_t n = 0; n < a.values.size(); ++n) {
                alone[0] += a.values[n] && !b.values[n];
                alone[1] += b.values[n] && !a.values[n];
            }
            const double voxel_ml = grid.voxel_volume_mm3() / 1000;
            EXPECT_NEAR(sum_ml(found, true), static_cast<double>(alone[0]) * voxel_ml, 1e-9);
            EXPECT_NEAR(sum_ml(found, false), static_cast<double>(alone[1]) * voxel_ml, 1e-9);
            for (const Difference& one : found)
                EXPECT_NEAR(one.distance_mm, distance_to(one.at, one.in_first ? b : a), 1e-9);
            for (std::size_t n = 1; n < found.size(); ++n) EXPECT_GE(found[n - 1].distance_mm, found[n].distance_mm);
            const std::vector<Difference> coarser = differences(a, b, 0.25);
            EXPECT_LE(coarser.size(), found.size());
            EXPECT_GE(differences(a, b, 1).size(), found.size());
        }
    }
}

TEST(Differences, OfEqualMasksAndOfAnEmptyOneThereAreNone) {
    const Grid grid = grid_of({5, 5, 5}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    const Mask one = test::mask_of(grid, [](const Vec3& p) { return p.x > 1; });
    const Mask empty = test::mask_of(grid, [](const Vec3&) { return false; });
    EXPECT_TRUE(differences(one, one).empty());
    EXPECT_TRUE(differences(one, empty).empty());
    EXPECT_TRUE(differences(empty, one).empty());
    EXPECT_KONTUR_ERROR(differences(one, one, 0), ErrorKind::invalid_input, "the saddle is 0");
    Mask other = one;
    other.grid.index_to_mm.translation.x += 1;
    EXPECT_KONTUR_ERROR(differences(one, other), ErrorKind::invalid_input, "the masks lie on different grids");
}

}  // namespace
}  // namespace kontur
