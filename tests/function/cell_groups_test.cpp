// SPDX-License-Identifier: Apache-2.0
#include "kontur/function/cell_groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "support/random.h"

namespace kontur {
namespace {

std::vector<Vec3> random_points(std::size_t count, double extent, std::mt19937& random) {
    std::uniform_real_distribution<double> coordinate(-extent, extent);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) points.push_back({coordinate(random), coordinate(random), coordinate(random)});
    return points;
}

TEST(CellGroups, EveryPointIsInItsCellOnce) {
    std::mt19937 random = test::random_of_this_test();
    for (const double edge : {0.3, 1.0, 50.0}) {
        std::vector<Vec3> points = random_points(500, 2, random);
        points.push_back({0, 0, 0});
        points.push_back({-edge, edge, -1e-300});
        const CellGroups groups = group_by_cell(PointArrays(points), edge);
        std::set<std::size_t> seen;
        std::set<std::uint64_t> keys;
        for (std::size_t c = 0; c < groups.cells.size(); ++c) {
            EXPECT_TRUE(keys.insert(cell_key(groups.cells[c])).second) << "a cell twice";
            EXPECT_LT(groups.starts[c], groups.starts[c + 1]) << "an empty cell";
            for (std::size_t m = groups.starts[c]; m < groups.starts[c + 1]; ++m) {
                EXPECT_TRUE(seen.insert(groups.order[m]).second);
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_EQ(groups.cells[c][axis],
                              static_cast<std::int64_t>(std::floor(points[groups.order[m]][axis] / edge)));
            }
        }
        EXPECT_EQ(seen.size(), points.size());
    }
    EXPECT_TRUE(group_by_cell({}, 1).cells.empty());
}

TEST(SourceCells, GatherEverySourceWithinTheRadiusAndNoneTwice) {
    std::mt19937 random = test::random_of_this_test();
    const std::vector<Vec3> points = random_points(800, 1, random);
    std::vector<double> weights;
    for (std::size_t i = 0; i < points.size(); ++i) weights.push_back(static_cast<double>(i + 1));
    NearSources sources;
    for (const double edge : {0.001, 0.05, 0.3, 5.0}) {
        const SourceCells cells(PointArrays(points), weights, edge);
        for (const Vec3& low : random_points(20, 2, random)) {
            const Vec3 high = low + Vec3{0.2, 0.2, 0.2};
            const double radius = 0.5;
            cells.gather_near(low, high, radius, sources);
            EXPECT_EQ(sources.x.size() % kNearLanes, 0u);
            std::set<double> found;
            for (std::size_t s = 0; s < sources.w.size(); ++s)
                if (sources.w[s] > 0) {
                    EXPECT_TRUE(found.insert(sources.w[s]).second) << "a source twice";
                    EXPECT_EQ(points[static_cast<std::size_t>(sources.w[s]) - 1],
                              (Vec3{sources.x[s], sources.y[s], sources.z[s]}));
                }
            for (std::size_t i = 0; i < points.size(); ++i) {
                Vec3 nearest = points[i];
                for (int axis = 0; axis < 3; ++axis) nearest[axis] = std::clamp(nearest[axis], low[axis], high[axis]);
                if (distance(points[i], nearest) <= radius) {
                    EXPECT_TRUE(found.contains(weights[i]));
                }
            }
        }
    }
}

TEST(SourceCells, WithoutSourcesGatherNothing) {
    NearSources sources;
    SourceCells({}, {}, 0.1).gather_near({-1, -1, -1}, {1, 1, 1}, 1, sources);
    EXPECT_TRUE(sources.x.empty());
}

}  // namespace
}  // namespace kontur
