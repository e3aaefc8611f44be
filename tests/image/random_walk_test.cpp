// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/random_walk.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kontur/phantom/random.h"

namespace kontur {
namespace {

constexpr double kExactly = 1e-12;

/// The reference: elimination with pivots.
std::vector<double> solve_densely(const std::vector<WalkPlace>& places) {
    const std::size_t n = places.size();
    std::vector<std::vector<double>> rows(n, std::vector<double>(n + 1));
    for (std::size_t i = 0; i < n; ++i) {
        rows[i][i] = places[i].ends;
        rows[i][n] = places[i].ends_inside;
        for (std::size_t side = 0; side < 6; ++side)
            if (places[i].next[side] != WalkPlace::kNowhere) {
                rows[i][i] += static_cast<double>(places[i].weight[side]);
                rows[i][static_cast<std::size_t>(places[i].next[side])] -= static_cast<double>(places[i].weight[side]);
            }
    }
    for (std::size_t column = 0; column < n; ++column) {
        std::size_t pivot = column;
        for (std::size_t row = column; row < n; ++row)
            if (std::abs(rows[row][column]) > std::abs(rows[pivot][column])) pivot = row;
        std::swap(rows[column], rows[pivot]);
        for (std::size_t row = 0; row < n; ++row) {
            if (row == column) continue;
            const double factor = rows[row][column] / rows[column][column];
            for (std::size_t at = column; at <= n; ++at) rows[row][at] -= factor * rows[column][at];
        }
    }
    std::vector<double> x;
    for (std::size_t i = 0; i < n; ++i) x.push_back(rows[i][n] / rows[i][i]);
    return x;
}

/// A walk may go both ways between two places.
void join(std::vector<WalkPlace>& places, std::size_t a, std::size_t b, std::size_t side, float weight) {
    places[a].next[side] = static_cast<std::int32_t>(b);
    places[b].next[side ^ 1] = static_cast<std::int32_t>(a);
    places[a].weight[side] = places[b].weight[side ^ 1] = weight;
}

TEST(RandomWalk, IsWhatADenseSolveFinds) {
    Random random(5);
    constexpr std::size_t ni = 5, nj = 4, nk = 3;
    for (int trial = 0; trial < 5; ++trial) {
        std::vector<WalkPlace> places(ni * nj * nk);
        const auto weight = [&] { return static_cast<float>(std::exp(-8 * random.uniform(0, 1))); };
        for (std::size_t n = 0; n < places.size(); ++n) {
            if (n % ni + 1 < ni) join(places, n, n + 1, 1, weight());
            if (n / ni % nj + 1 < nj) join(places, n, n + ni, 3, weight());
            if (n / (ni * nj) + 1 < nk) join(places, n, n + ni * nj, 5, weight());
            if (random.uniform(0, 1) < 0.4) places[n].ends = random.uniform(0, 1);
            places[n].ends_inside = places[n].ends * random.uniform(0, 1);
        }
        const std::vector<double> found = walk_inside(places, kExactly), exact = solve_densely(places);
        for (std::size_t n = 0; n < places.size(); ++n) EXPECT_NEAR(found[n], exact[n], 1e-9);
        const std::vector<double> roughly = walk_inside(places, 1e-3);
        for (std::size_t n = 0; n < places.size(); ++n) EXPECT_NEAR(roughly[n], exact[n], 0.05);
    }
}

TEST(RandomWalk, OnALineIsTheGamblersRuin) {
    std::vector<WalkPlace> places(9);
    for (std::size_t n = 0; n + 1 < places.size(); ++n) join(places, n, n + 1, 1, 1);
    places.front().ends = places.back().ends = places.back().ends_inside = 1;
    const std::vector<double> inside = walk_inside(places, kExactly);
    for (std::size_t n = 0; n < places.size(); ++n) EXPECT_NEAR(inside[n], 0.1 * static_cast<double>(n + 1), 1e-9);
}

TEST(RandomWalk, StaysOnItsSideOfAStepThatIsHard) {
    std::vector<WalkPlace> places(10);
    for (std::size_t n = 0; n + 1 < places.size(); ++n) join(places, n, n + 1, 1, n == 2 ? 1e-3F : 1);
    places.front().ends = places.back().ends = places.back().ends_inside = 1;
    const std::vector<double> inside = walk_inside(places, kExactly);
    EXPECT_LT(inside[2], 0.01);
    EXPECT_GT(inside[3], 0.99);
}

TEST(RandomWalk, OfNoPlacesIsNone) { EXPECT_TRUE(walk_inside({}, kExactly).empty()); }

}  // namespace
}  // namespace kontur
