// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/surface_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "kontur/editor.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

/// The least of many places of each triangle: never less than the distance, and hardly more.
double sampled_mm(const Vec3& p, const TriangleMesh& mesh) {
    constexpr int kSteps = 12;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [a, b, c] : mesh.triangles)
        for (int i = 0; i <= kSteps; ++i)
            for (int j = 0; i + j <= kSteps; ++j) {
                const double u = double(i) / kSteps, v = double(j) / kSteps;
                least = std::min(least, norm(p - ((1 - u - v) * mesh.points[a] + u * mesh.points[b] + v * mesh.points[c])));
            }
    return least;
}

TEST(SurfaceDistance, IsTheLeastOverAllTriangles) {
    TriangleMesh tetrahedron{{{0, 0, 0}, {9, 1, 0}, {1, 8, 2}, {2, 1, 7}}, {}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
    ASSERT_GT(signed_volume_mm3(tetrahedron), 0);
    tetrahedron.normals = point_normals(tetrahedron);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> somewhere(-6, 14);
    std::vector<Vec3> points;
    for (int n = 0; n < 300; ++n) points.push_back({somewhere(random), somewhere(random), somewhere(random)});
    const std::vector<double> found = distances_mm(points, tetrahedron);
    const std::vector<Vec3> places = nearest_places(points, tetrahedron);
    for (std::size_t n = 0; n < points.size(); ++n) {
        const double sampled = sampled_mm(points[n], tetrahedron);
        EXPECT_LE(std::abs(found[n]), 1.0205 * sampled) << "at most 2 % too far";
        EXPECT_GT(std::abs(found[n]), sampled - 0.6) << "the samples lie 0.9 mm apart";
        EXPECT_LE(distance(points[n], places[n]), std::abs(found[n]) + 1e-12) << "places are the very nearest ones";
        EXPECT_GE(1.0205 * distance(points[n], places[n]), std::abs(found[n]));
    }
}

TEST(SurfaceDistance, OfAFittedBallIsThatOfTheBallAndNegativeInside) {
    const TriangleMesh mesh = Editor().preview(test::ball_contours()).mesh;
    const Box3 box = bounding_box(mesh.points);
    const Vec3 center = 0.5 * (box.min + box.max);
    double radius = 0;
    for (const Vec3& p : mesh.points) radius += norm(p - center) / double(mesh.points.size());
    std::vector<Vec3> points;
    std::mt19937 random(3);
    std::normal_distribution<double> side;
    for (int n = 0; n < 200; ++n) {
        const Vec3 direction{side(random), side(random), side(random)};
        points.push_back(center + (radius * (0.3 + 0.008 * n) / norm(direction)) * direction);
    }
    const std::vector<double> found = distances_mm(points, mesh);
    for (std::size_t n = 0; n < points.size(); ++n)
        EXPECT_NEAR(found[n], norm(points[n] - center) - radius, 0.05 * radius) << n;
}

TEST(SurfaceDistance, OfAnEmptySurfaceIsNotKnown) { EXPECT_TRUE(distances_mm(std::vector<Vec3>{{1, 2, 3}}, {}).empty()); }

}  // namespace
}  // namespace kontur
