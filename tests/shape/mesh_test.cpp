// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "support/bodies.h"
#include "support/expect_error.h"

namespace kontur {
namespace {

using test::ball;
using test::torus;

TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
    const auto shift = static_cast<std::uint32_t>(a.points.size());
    a.points.insert(a.points.end(), b.points.begin(), b.points.end());
    for (const auto& [p, q, r] : b.triangles) a.triangles.push_back({p + shift, q + shift, r + shift});
    return a;
}

TEST(CheckMesh, NamesWhatDoesNotFitTogether) {
    EXPECT_NO_THROW(check_mesh({}));
    EXPECT_NO_THROW(check_mesh(ball({1, 2, 3}, 10, 2)));
    for (const double bad : {std::nan(""), -1e39, std::numeric_limits<double>::infinity()}) {
        TriangleMesh mesh = ball({1, 2, 3}, 10, 2);
        mesh.points[4].z = bad;
        EXPECT_KONTUR_ERROR(check_mesh(mesh), ErrorKind::invalid_input, "point 5 of the mesh is (");
    }
    const std::vector<Vec3> points(3);
    EXPECT_KONTUR_ERROR(check_mesh({points, {}, {{0, 1, 3}}}), ErrorKind::invalid_input,
                        "triangle 1 of the mesh refers to point 4 of 3");
    EXPECT_KONTUR_ERROR(check_mesh({points, {{0, 0, 1}}, {}}), ErrorKind::invalid_input, "1 normals for 3 points");
}

TEST(SignedVolume, BallFarFromTheOriginConvergesToTheAnalyticVolume) {
    const double exact = 4.0 / 3 * std::numbers::pi * 1000;
    double previous = exact;
    for (int levels = 2; levels <= 5; ++levels) {
        const double error = exact - signed_volume_mm3(ball({1e6, -2e6, 3e6}, 10, levels));
        EXPECT_GT(error, 0) << "inscribed polyhedron";
        EXPECT_LT(error, 0.3 * previous) << levels;
        previous = error;
    }
    EXPECT_LT(previous, 0.002 * exact);
}

TEST(SignedVolume, TorusMatchesPappus) {
    EXPECT_NEAR(signed_volume_mm3(torus({5, 6, 7}, 20, 5, 200)), 2 * std::numbers::pi * std::numbers::pi * 20 * 25, 12);
}

TEST(SignedVolume, TurnsNegativeWithTheTriangles) {
    TriangleMesh mesh = ball({1, 2, 3}, 10, 2);
    const double volume = signed_volume_mm3(mesh);
    for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
    EXPECT_DOUBLE_EQ(signed_volume_mm3(mesh), -volume);
}

TEST(SignedVolume, EmptyMeshHasNone) { EXPECT_EQ(signed_volume_mm3({}), 0); }

TEST(Topology, SphereAndTorusHaveTheirEulerNumbers) {
    const MeshTopology sphere = topology(ball({}, 1, 3));
    EXPECT_TRUE(sphere.closed);
    EXPECT_TRUE(sphere.oriented);
    EXPECT_EQ(sphere.euler, 2);
    EXPECT_EQ(sphere.components, 1);
    const MeshTopology ring = topology(torus({}, 3, 1, 12));
    EXPECT_TRUE(ring.closed);
    EXPECT_TRUE(ring.oriented);
    EXPECT_EQ(ring.euler, 0);
    EXPECT_EQ(ring.components, 1);
}

TEST(Topology, CountsComponentsAndIgnoresUnusedPoints) {
    TriangleMesh mesh = joined(ball({}, 1, 1), torus({10, 0, 0}, 3, 1, 8));
    mesh.points.push_back({99, 99, 99});
    const MeshTopology result = topology(mesh);
    EXPECT_TRUE(result.closed);
    EXPECT_EQ(result.euler, 2 + 0);
    EXPECT_EQ(result.components, 2);
}

TEST(Topology, MissingTriangleOpensTheSurface) {
    TriangleMesh mesh = ball({}, 1, 2);
    mesh.triangles.pop_back();
    EXPECT_FALSE(topology(mesh).closed);
    EXPECT_FALSE(topology(mesh).oriented);
}

TEST(Topology, OneTurnedTriangleBreaksTheOrientationOnly) {
    TriangleMesh mesh = ball({}, 1, 2);
    std::swap(mesh.triangles[7][0], mesh.triangles[7][1]);
    EXPECT_TRUE(topology(mesh).closed);
    EXPECT_FALSE(topology(mesh).oriented);
}

TEST(Topology, EmptyMeshIsNoSurface) {
    const MeshTopology result = topology({});
    EXPECT_FALSE(result.closed);
    EXPECT_EQ(result.euler, 0);
    EXPECT_EQ(result.components, 0);
}

}  // namespace
}  // namespace kontur
