// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/outline.h"

#include <gtest/gtest.h>

#include <numbers>

#include "support/bodies.h"

namespace kontur {
namespace {

using test::ball;
using test::torus;

double length(const Polyline& line) {
    double sum = 0;
    for (std::size_t i = line.closed ? 0 : 1; i < line.points.size(); ++i)
        sum += distance(line.points[i], line.points[i == 0 ? line.points.size() - 1 : i - 1]);
    return sum;
}

void expect_on_plane(const Polyline& line, const Plane& plane) {
    for (const Vec3& p : line.points) EXPECT_NEAR(plane.distance_to(p), 0, 1e-9);
}

TEST(Outline, ObliqueCutOfABallIsTheRightCircle) {
    const Vec3 center{10, -20, 30};
    const TriangleMesh mesh = ball(center, 5, 5);
    for (const double offset : {-4.0, -1.3, 0.0, 2.5, 4.5}) {
        const Vec3 normal = normalized({1, 2, -0.5});
        const Plane plane = make_plane(center + offset * normal, normal);
        const auto lines = outline(mesh, plane);
        ASSERT_EQ(lines.size(), 1u) << offset;
        EXPECT_TRUE(lines[0].closed);
        expect_on_plane(lines[0], plane);
        const double radius = std::sqrt(25 - offset * offset);
        for (const Vec3& p : lines[0].points) EXPECT_NEAR(distance(p, plane.origin), radius, 0.02);
        EXPECT_NEAR(length(lines[0]), 2 * std::numbers::pi * radius, 0.1);
    }
}

TEST(Outline, PlaneThroughRowsOfMeshPointsGivesOneLoopWithoutRepetition) {
    // An octahedron's subdivision has points exactly on z = 0, here also whole edges.
    const TriangleMesh mesh = ball({}, 1, 4);
    const Plane plane = make_plane({}, {0, 0, 1});
    for (const double sign : {1.0, -1.0}) {
        const Plane turned = make_plane({}, {0, 0, sign});
        const auto lines = outline(mesh, turned);
        ASSERT_EQ(lines.size(), 1u);
        EXPECT_TRUE(lines[0].closed);
        expect_on_plane(lines[0], plane);
        for (std::size_t i = 0; i < lines[0].points.size(); ++i)
            EXPECT_NE(lines[0].points[i], lines[0].points[(i + 1) % lines[0].points.size()]);
        EXPECT_NEAR(length(lines[0]), 2 * std::numbers::pi, 0.01);
    }
}

TEST(Outline, TorusIsCutIntoTwoLoopsEitherWay) {
    const TriangleMesh mesh = torus({}, 10, 3, 60);
    const auto rings = outline(mesh, make_plane({0, 0, 0.1}, {0, 0, 1}));
    ASSERT_EQ(rings.size(), 2u);
    EXPECT_NEAR(length(rings[0]) + length(rings[1]), 2 * std::numbers::pi * 20, 0.5);
    const auto tubes = outline(mesh, make_plane({0, 0.1, 0}, {0, 1, 0}));
    ASSERT_EQ(tubes.size(), 2u);
    for (const Polyline& tube : tubes) EXPECT_NEAR(length(tube), 2 * std::numbers::pi * 3, 0.1);
}

TEST(Outline, TouchingAndMissingPlanesGiveNothing) {
    const TriangleMesh mesh = ball({}, 1, 3);
    EXPECT_TRUE(outline(mesh, make_plane({0, 0, 1}, {0, 0, 1})).empty());
    EXPECT_TRUE(outline(mesh, make_plane({0, 0, 1}, {0, 0, -1})).empty());
    EXPECT_TRUE(outline(mesh, make_plane({0, 0, 2}, {0, 0, 1})).empty());
    EXPECT_TRUE(outline({}, make_plane({}, {0, 0, 1})).empty());
}

TEST(Outline, OpenMeshGivesOneOpenLineFromBorderToBorder) {
    TriangleMesh mesh = ball({}, 1, 4);
    std::erase_if(mesh.triangles,
                  [&](const auto& t) { return mesh.points[t[0]].z + mesh.points[t[1]].z + mesh.points[t[2]].z > 0; });
    const auto lines = outline(mesh, make_plane({0.01, 0, 0}, {1, 0, 0}));
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_FALSE(lines[0].closed);
    EXPECT_NEAR(length(lines[0]), std::numbers::pi, 0.1);
}

TEST(Outline, RandomPlanesAlwaysCloseTheLinesOfAClosedMesh) {
    const TriangleMesh mesh = torus({1, 2, 3}, 4, 1.5, 24);
    for (int i = 0; i < 500; ++i) {
        // Through a mesh point, so that points on the plane are the rule.
        const Vec3 normal{std::sin(1.3 * i), std::cos(2.1 * i), std::sin(0.7 * i + 1)};
        const Plane plane = make_plane(mesh.points[static_cast<std::size_t>(i) % mesh.points.size()], normal);
        for (const Polyline& line : outline(mesh, plane)) {
            EXPECT_TRUE(line.closed);
            EXPECT_GE(line.points.size(), 3u);
            expect_on_plane(line, plane);
        }
    }
}

TEST(Crossings, SquareIsCrossedTwiceAndOnceWhenOpen) {
    Contour square;
    square.points = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
    const Plane plane = make_plane({0, 0.5, 0}, {0, 1, 0});
    const auto points = crossings(square, plane);
    ASSERT_EQ(points.size(), 2u);
    EXPECT_EQ(points[0], (Vec3{0, 0.5, 0}));
    EXPECT_EQ(points[1], (Vec3{2, 0.5, 0}));
    square.closed = false;
    EXPECT_EQ(crossings(square, plane).size(), 1u);
    EXPECT_TRUE(crossings(square, make_plane({0, 0, 1}, {0, 0, 1})).empty());
}

}  // namespace
}  // namespace kontur
