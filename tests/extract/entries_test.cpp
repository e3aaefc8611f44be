// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/entries.h"

#include <gtest/gtest.h>

#include "kontur/extract/adaptive.h"
#include "kontur/extract/voxelize.h"
#include "support/functions.h"

namespace kontur {
namespace {

std::vector<Vec3> with_entries(const ImplicitFunction& function, const Grid& grid, std::vector<Vec3> starts) {
    const Entries found = entries(function, grid, starts, {.threads = 2});
    starts.insert(starts.end(), found.points.begin(), found.points.end());
    return starts;
}

TEST(Entries, MakeASearchFindWhatTheGridCutsOutOfTheObject) {
    const ImplicitFunction torus = test::function_through(test::torus({}, 16, 5, 24));
    for (const Affine3& change : {Affine3{}, test::kOblique, test::kSheared, test::kMirrored})
        for (const Vec3& center : {Vec3{-14, 0, 0}, Vec3{0, 16, 0}, Vec3{0, -2, 3}}) {
            const Grid grid = test::changed(test::grid_about(center, {28, 50, 9}, 0.9), change);
            const Mask all = fill(sample_everywhere(torus, grid, {.threads = 2}));
            const std::vector<Vec3> more =
                with_entries(torus, grid, {{21, 0, 0}, {20.5, 1, 1}, {-60, -60, -60}, {60, 60, 60}});
            EXPECT_TRUE(fill(track_surface(torus, grid, more, {.threads = 2})).values == all.values);
            EXPECT_TRUE(fill(track_surface_adaptively(torus, grid, more, {.threads = 2})).values == all.values);
        }
}

TEST(Entries, FillAGridWithinTheObjectAndNoneWithinItsHollow) {
    const std::vector<Vec3> starts{{40, 0, 0}, {-40, 0, 0}, {0, 40, 0}};
    const Grid grid = test::grid_about({5, 3, 0}, {9, 8, 7}, 1);
    const ImplicitFunction ball = test::ball_function({}, 40);
    const Mask mask = fill(track_surface(ball, grid, with_entries(ball, grid, starts), {.threads = 1}));
    EXPECT_EQ(std::count(mask.values.begin(), mask.values.end(), 1), grid.voxel_count());

    const ImplicitFunction torus = test::function_through(test::torus({}, 36, 4, 24));
    const Mask none = fill(track_surface(torus, grid, with_entries(torus, grid, starts), {.threads = 1}));
    EXPECT_EQ(std::count(none.values.begin(), none.values.end(), 1), 0);
}

TEST(Entries, AreNoneWhereAllStartsLieInTheGridOrTheGridBesideThem) {
    const ImplicitFunction ball = test::ball_function({}, 8);
    const std::vector<Vec3> starts{{8, 0, 0}, {0, 8, 0}, {0, 0, -8}};
    for (const Vec3& center : {Vec3{}, Vec3{40, 0, 0}, Vec3{0, 0, -30}}) {
        const Entries found = entries(ball, test::grid_about(center, {20, 20, 20}, 1), starts, {.threads = 1});
        EXPECT_TRUE(found.points.empty());
        EXPECT_EQ(found.evaluations, 0);
    }
    EXPECT_TRUE(entries(ball, test::grid_about({}, {9, 9, 9}, 1), std::vector<Vec3>{{std::nan(""), 0, 0}}, {.threads = 1})
                    .points.empty());
}

TEST(Entries, AreTheSameForAnyNumberOfThreads) {
    const ImplicitFunction ball = test::ball_function({}, 30);
    const std::vector<Vec3> starts{{30, 0, 0}, {-30, 0, 0}};
    const Grid grid = test::grid_about({}, {20, 80, 20}, 1);
    const Entries one = entries(ball, grid, starts, {.threads = 1});
    EXPECT_FALSE(one.points.empty());
    for (const int threads : {2, 5}) EXPECT_EQ(entries(ball, grid, starts, {.threads = threads}).points, one.points);
}

}  // namespace
}  // namespace kontur
