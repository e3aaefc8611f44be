// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/compare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "kontur/base/error.h"
#include "support/random_masks.h"
#include "support/run_python.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

Grid grid_of(const Index3& size, const Vec3& a, const Vec3& b, const Vec3& c) {
    Grid grid{size, {}};
    grid.index_to_mm.set_column(0, a);
    grid.index_to_mm.set_column(1, b);
    grid.index_to_mm.set_column(2, c);
    grid.index_to_mm.translation = {-120, 33, 800};
    return grid;
}

Grid anisotropic(const Index3& size) { return grid_of(size, {0.7, 0, 0}, {0, 1.1, 0}, {0, 0, 3}); }
Grid sheared_left_handed(const Index3& size) { return grid_of(size, {0.6, 0.4, 0}, {0.5, -0.9, 0.1}, {0, 0.8, 2.5}); }

/// Pairwise distances of surface voxels, straight from the definition.
SurfaceDistance brute_force(const Mask& a, const Mask& b) {
    const auto surface = [](const Mask& mask) {
        const Index3 size = mask.grid.size;
        const auto inside = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
            const bool in_grid = i >= 0 && j >= 0 && k >= 0 && i < size.i && j < size.j && k < size.k;
            return in_grid && mask.values[mask.grid.offset(i, j, k)] != 0;
        };
        std::vector<Vec3> points;
        for (std::int64_t k = 0; k < size.k; ++k)
            for (std::int64_t j = 0; j < size.j; ++j)
                for (std::int64_t i = 0; i < size.i; ++i)
                    if (inside(i, j, k) && !(inside(i - 1, j, k) && inside(i + 1, j, k) && inside(i, j - 1, k) &&
                                             inside(i, j + 1, k) && inside(i, j, k - 1) && inside(i, j, k + 1)))
                        points.push_back(mask.grid.center_mm(i, j, k));
        return points;
    };
    const auto distances = [](const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
        std::vector<double> result;
        for (const Vec3& p : from) {
            double nearest = std::numeric_limits<double>::infinity();
            for (const Vec3& q : to) nearest = std::min(nearest, distance(p, q));
            result.push_back(nearest);
        }
        std::sort(result.begin(), result.end());
        return result;
    };
    const auto percentile95 = [](const std::vector<double>& sorted) {
        const double rank = 0.95 * double(sorted.size() - 1);
        const double low = sorted[std::size_t(std::floor(rank))], high = sorted[std::size_t(std::ceil(rank))];
        return low + (rank - std::floor(rank)) * (high - low);
    };
    const std::vector<Vec3> surface_a = surface(a), surface_b = surface(b);
    const std::vector<double> forward = distances(surface_a, surface_b), backward = distances(surface_b, surface_a);
    double sum = 0;
    for (const double d : forward) sum += d;
    for (const double d : backward) sum += d;
    return {std::max(forward.back(), backward.back()), std::max(percentile95(forward), percentile95(backward)),
            sum / double(forward.size() + backward.size())};
}

void expect_near(const std::optional<SurfaceDistance>& found, const SurfaceDistance& expected) {
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(found->hausdorff_mm, expected.hausdorff_mm, 1e-10);
    EXPECT_NEAR(found->hausdorff95_mm, expected.hausdorff95_mm, 1e-10);
    EXPECT_NEAR(found->mean_surface_distance_mm, expected.mean_surface_distance_mm, 1e-10);
}

TEST(Compare, DistancesAgreeWithAllPairsOnRandomMasks) {
    std::mt19937 random = test::random_of_this_test();
    for (const Grid& grid : {anisotropic({9, 8, 5}), sheared_left_handed({9, 8, 5}), sheared_left_handed({20, 1, 1})})
        for (const double probability : {0.03, 0.3, 0.8, 1.0}) {
            Mask a = test::random_mask(grid, probability, random), b = test::random_mask(grid, 0.2, random);
            a.values.front() = b.values.back() = 1;
            expect_near(compare(a, b).surface, brute_force(a, b));
        }
}

TEST(Compare, OverlapCountsVoxels) {
    Mask a{anisotropic({10, 10, 10}), std::vector<std::uint8_t>(1000)}, b = a;
    std::fill_n(a.values.begin(), 300, 1);
    std::fill_n(b.values.begin() + 200, 500, 255);
    const Comparison result = compare(a, b);
    EXPECT_DOUBLE_EQ(result.dice, 200.0 / 800);
    EXPECT_DOUBLE_EQ(result.jaccard, 100.0 / 700);
    EXPECT_DOUBLE_EQ(result.volume_a_ml, 300 * 0.7 * 1.1 * 3 / 1000);
    EXPECT_DOUBLE_EQ(result.volume_b_ml, 500 * 0.7 * 1.1 * 3 / 1000);
}

TEST(Compare, ShiftedBallIsOneShiftAway) {
    const Grid grid = grid_of({80, 60, 60}, {0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5});
    const Vec3 center = grid.center_mm(30, 30, 30);
    const double radius = 12, shift = 4;
    const Comparison result =
        compare(test::ball_mask(grid, center, radius), test::ball_mask(grid, center + Vec3{shift, 0, 0}, radius));
    // The tip in the direction of the shift is exactly the shift away, and nothing is farther.
    ASSERT_TRUE(result.surface.has_value());
    EXPECT_NEAR(result.surface->hausdorff_mm, shift, 1e-12);
    // Lens of two balls; mean of |shift cos(angle)| over the sphere to first order.
    const double x = shift / radius;
    EXPECT_NEAR(result.dice, 1 - 0.75 * x + x * x * x / 16, 0.003);
    EXPECT_NEAR(result.surface->mean_surface_distance_mm, shift / 2, 0.15);
    EXPECT_LT(result.surface->hausdorff95_mm, shift);
    EXPECT_NEAR(result.jaccard, result.dice / (2 - result.dice), 1e-12);
}

TEST(Compare, IsSymmetric) {
    std::mt19937 random = test::random_of_this_test();
    const Grid grid = sheared_left_handed({12, 11, 10});
    const Mask a = test::random_mask(grid, 0.1, random), b = test::random_mask(grid, 0.4, random);
    const Comparison forward = compare(a, b), backward = compare(b, a);
    EXPECT_EQ(forward.dice, backward.dice);
    expect_near(forward.surface, *backward.surface);
}

TEST(Compare, EqualMasksAgreeFully) {
    std::mt19937 random = test::random_of_this_test();
    const Mask mask = test::random_mask(sheared_left_handed({12, 11, 10}), 0.4, random);
    const Comparison result = compare(mask, mask);
    EXPECT_EQ(result.dice, 1);
    EXPECT_EQ(result.jaccard, 1);
    expect_near(result.surface, {0, 0, 0});
}

TEST(Compare, EmptyMasksHaveNoDistance) {
    const Mask empty{anisotropic({3, 3, 3}), std::vector<std::uint8_t>(27)};
    const Mask full{anisotropic({3, 3, 3}), std::vector<std::uint8_t>(27, 1)};
    EXPECT_EQ(compare(empty, empty).dice, 1);
    EXPECT_EQ(compare(empty, empty).jaccard, 1);
    EXPECT_FALSE(compare(empty, empty).surface);
    for (const Comparison& result : {compare(empty, full), compare(full, empty)}) {
        EXPECT_EQ(result.dice, 0);
        EXPECT_EQ(result.jaccard, 0);
        EXPECT_FALSE(result.surface);
    }
}

std::string refusal(const Mask& a, const Mask& b) {
    try {
        compare(a, b);
        return {};
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
        return error.what();
    }
}

TEST(Compare, DifferentGridsAreRefusedSayingHow) {
    const Mask a{anisotropic({3, 4, 5}), std::vector<std::uint8_t>(60, 1)};
    Mask b{anisotropic({5, 4, 3}), std::vector<std::uint8_t>(60, 1)};
    EXPECT_EQ(refusal(a, b), "the masks lie on different grids: 3 x 4 x 5 and 5 x 4 x 3 voxels");
    b = a;
    b.grid.index_to_mm.translation.x += 2.5;
    EXPECT_EQ(refusal(a, b),
              "the masks lie on different grids: corner voxels are up to 2.5 mm apart; the limit is 0.001 mm");
    b = a;
    b.grid.index_to_mm.translation.x += 0.0005;
    EXPECT_EQ(refusal(a, b), "");
    b = a;
    b.values.pop_back();
    EXPECT_EQ(refusal(a, b), "the second mask has 59 values for a grid of 60 voxels");
}

TEST(Compare, AnyNumberOfThreadsGivesTheSameNumbers) {
    const Grid grid = anisotropic({80, 80, 40});
    const Mask a = test::ball_mask(grid, grid.center_mm(40, 40, 20), 22),
               b = test::ball_mask(grid, grid.center_mm(36, 41, 20), 20);
    const Comparison one = compare(a, b, {.threads = 1}), three = compare(a, b, {.threads = 3});
    EXPECT_EQ(one.surface->mean_surface_distance_mm, three.surface->mean_surface_distance_mm);
    EXPECT_EQ(one.surface->hausdorff95_mm, three.surface->hausdorff95_mm);
    EXPECT_EQ(one.surface->hausdorff_mm, three.surface->hausdorff_mm);
}

TEST(Compare, StopsWhenAsked) {
    const Mask full{anisotropic({3, 3, 3}), std::vector<std::uint8_t>(27, 1)};
    StopSource source;
    source.request_stop();
    EXPECT_THROW(compare(full, full, {.stop = source.token()}), Error);
}

TEST(Compare, AgreesWithScipyOnAnAnisotropicGrid) {
    std::mt19937 random = test::random_of_this_test();
    const Grid grid = anisotropic({40, 30, 20});
    Mask a = test::ball_mask(grid, grid.center_mm(18, 14, 9), 11), b = test::ball_mask(grid, grid.center_mm(22, 15, 4), 13);
    for (int i = 0; i < 30; ++i) a.values[random() % a.values.size()] = 1;
    const test::TemporaryFolder folder;
    const auto dump = [&](const Mask& mask, const char* name) {
        std::ofstream(folder / name, std::ios::binary)
            .write(reinterpret_cast<const char*>(mask.values.data()), static_cast<std::streamsize>(mask.values.size()));
        return (folder / name).string();
    };
    const auto scipy =
        test::run_python("surface_distance.py", {dump(a, "a"), dump(b, "b"), "40", "30", "20", "0.7", "1.1", "3"});
    ASSERT_EQ(scipy.exit_code, 0) << scipy.output;
    SurfaceDistance expected;
    ASSERT_TRUE(std::istringstream(scipy.output) >> expected.hausdorff_mm >> expected.hausdorff95_mm >>
                expected.mean_surface_distance_mm);
    expect_near(compare(a, b).surface, expected);
}

}  // namespace
}  // namespace kontur
