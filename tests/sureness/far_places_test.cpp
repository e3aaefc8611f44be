// SPDX-License-Identifier: Apache-2.0
#include "kontur/sureness/far_places.h"

#include <gtest/gtest.h>

#include <vector>

namespace kontur {
namespace {

/// So many points in a row along x from a place, 1 mm apart.
void add_cluster(std::vector<Vec3>& points, std::vector<double>& distances, const Vec3& from, int count,
                 double distance_mm) {
    for (int n = 0; n < count; ++n) {
        points.push_back(from + Vec3{static_cast<double>(n), 0, 0});
        distances.push_back(distance_mm);
    }
}

TEST(FarPlaces, ThePlaneGoesThroughTheMiddlesOfTheThreeLargestClusters) {
    std::vector<Vec3> points;
    std::vector<double> distances;
    add_cluster(points, distances, {0, 0, 0}, 3, 6);  // the fourth
    add_cluster(points, distances, {100, 0, 10}, 9, 10);
    add_cluster(points, distances, {0, 100, 20}, 7, 8);
    add_cluster(points, distances, {0, 0, 130}, 5, 6);
    add_cluster(points, distances, {50, 50, 50}, 30, 4.9);  // not far
    const auto plane = plane_through_far_places(points, distances, 1.5);
    ASSERT_TRUE(plane.has_value());
    for (const Vec3& middle : {Vec3{104, 0, 10}, Vec3{3, 100, 20}, Vec3{2, 0, 130}})
        EXPECT_NEAR(plane->distance_to(middle), 0, 1e-9);
    EXPECT_FALSE(plane_through_far_places(points, distances, 500).has_value()) << "all of them are one cluster";
}

TEST(FarPlaces, ThereIsNoneThroughTwoClustersOrThreeInARow) {
    EXPECT_FALSE(plane_through_far_places({}, {}, 1).has_value());
    std::vector<Vec3> points;
    std::vector<double> distances;
    add_cluster(points, distances, {0, 0, 0}, 4, 5);
    add_cluster(points, distances, {0, 50, 0}, 4, 5);
    EXPECT_FALSE(plane_through_far_places(points, distances, 1.5).has_value());
    add_cluster(points, distances, {0, 100, 0}, 4, 5);
    EXPECT_FALSE(plane_through_far_places(points, distances, 1.5).has_value());
}

}  // namespace
}  // namespace kontur
