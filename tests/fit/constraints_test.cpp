// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/constraints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/random.h"

namespace kontur {
namespace {

std::vector<BoundaryPoint> random_boundary(std::size_t count, double extent, std::mt19937& random) {
    std::uniform_real_distribution<double> coordinate(-extent, extent);
    std::normal_distribution<double> direction;
    const auto draw = [&](auto& d) { return Vec3{d(random), d(random), d(random)}; };
    std::vector<BoundaryPoint> points;
    for (std::size_t i = 0; i < count; ++i)
        points.push_back({draw(coordinate), normalized(draw(direction)), normalized(draw(direction)), 0});
    return points;
}

TEST(PlaceConstraints, ValuesAreThoseOfADistance) {
    const std::vector<BoundaryPoint> points{{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0}, {{0, 5, 0}, {0, 1, 0}, {0, 0, 1}, 0}};
    const std::vector<double> slopes{1, 0.5};
    const std::vector<PointConstraint> single_points{{{-3, 0, 0}, 2}, {{9, 0, 0}, -2}, {{0, 0, 8}, 0}};
    const PlacedConstraints placed = place_constraints(points, slopes, single_points, {.normal_offset_mm = 2});
    EXPECT_EQ(placed.constraints.centers,
              (std::vector<Vec3>{{0, 0, 0}, {0, 5, 0}, {2, 0, 0}, {0, 7, 0}, {-3, 0, 0}, {9, 0, 0}, {0, 0, 8}}));
    EXPECT_EQ(placed.constraints.values, (std::vector<double>{0, 0, -2, -1, 2, -2, 0}));
    EXPECT_EQ(placed.merged, 0u);
}

TEST(PlaceConstraints, OneNormalStandsForThoseThatAreNearerThanTheSpacing) {
    std::vector<BoundaryPoint> points;
    for (const std::int32_t contour : {0, 1})
        for (int i = 0; i < 12; ++i) points.push_back({{0, 1.0 * i, 20.0 * contour}, {1, 0, 0}, {0, 0, 1}, contour});
    const std::vector<double> slopes(points.size(), 1.0);
    const PlaceOptions options{.normal_offset_mm = 4, .both_sides = true, .normal_spacing_mm = 5, .slope_noise = 0.2};
    const ConstraintSet placed = place_constraints(points, slopes, {}, options).constraints;
    std::vector<double> at, noise;
    for (std::size_t i = points.size(); i < placed.centers.size(); ++i)
        if (placed.values[i] < 0) {  // those outside
            at.push_back(placed.centers[i].y);
            noise.push_back(placed.noise_mm[i]);
        }
    // Each stands for half of the points on the way to the next one, of which every second one would have two.
    EXPECT_EQ(at, (std::vector<double>{0, 5, 10, 0, 5, 10}));
    for (std::size_t i = 0; i < noise.size(); ++i)
        EXPECT_DOUBLE_EQ(noise[i], 0.2 * 4 / std::sqrt(std::vector<double>{1.5, 2.5, 2}[i % 3]));
    EXPECT_EQ(placed.centers.size(), points.size() + 2 * at.size());
}

TEST(PlaceConstraints, KeepsTheMergeDistanceAndDropsNothingElse) {
    std::mt19937 random = test::random_of_this_test();
    for (const double merge : {0.3, 0.8, 2.0}) {
        const std::vector<BoundaryPoint> points = random_boundary(150, 4, random);
        const std::vector<double> slopes(points.size(), 1.0);
        const PlacedConstraints placed =
            place_constraints(points, slopes, {}, {.normal_offset_mm = 1, .merge_distance_mm = merge});

        // One after the other, each compared with all that were kept; offset points only of boundary points that were.
        std::vector<Vec3> kept;
        std::size_t dropped = 0;
        const auto place = [&](const Vec3& p) {
            if (std::ranges::any_of(kept, [&](const Vec3& q) { return distance(p, q) < merge; })) {
                ++dropped;
                return false;
            }
            kept.push_back(p);
            return true;
        };
        std::vector<bool> has_boundary;
        for (const BoundaryPoint& p : points) has_boundary.push_back(place(p.position));
        for (std::size_t i = 0; i < points.size(); ++i)
            if (has_boundary[i]) place(points[i].position + points[i].inplane_normal);
        EXPECT_EQ(placed.constraints.centers, kept);
        EXPECT_EQ(placed.merged, dropped);
        EXPECT_GT(dropped, 0u);
    }
}

TEST(PlaceConstraints, ExactCopiesGoEvenWithoutAMergeDistance) {
    const BoundaryPoint point{{1, 2, 3}, {1, 0, 0}, {0, 0, 1}, 0};
    const std::vector<BoundaryPoint> points{point, point, {{1, 2, 3.0000001}, {1, 0, 0}, {0, 0, 1}, 0}};
    const PlacedConstraints placed = place_constraints(points, std::vector<double>(3, 1.0), {}, {.normal_offset_mm = 1});
    EXPECT_EQ(placed.constraints.size(), 4u);
    EXPECT_EQ(placed.merged, 1u);
}

}  // namespace
}  // namespace kontur
