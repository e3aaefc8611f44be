// SPDX-License-Identifier: Apache-2.0
#include "viewer/edits/proposed_lines.h"

#include <gtest/gtest.h>

#include <array>

namespace kontur::viewer {
namespace {

/// Adds a tetrahedron with edges of about this length.
void add_tetrahedron(TriangleMesh& mesh, const Vec3& at, double edge_mm) {
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    for (const Vec3& corner : {Vec3{0, 0, 0}, Vec3{1, 0.1, 0}, Vec3{0.1, 0.9, 0.2}, Vec3{0.2, 0.1, 0.8}})
        mesh.points.push_back(at + edge_mm * corner);
    for (const auto& [a, b, c] : {std::array{0u, 2u, 1u}, {0u, 1u, 3u}, {1u, 2u, 3u}, {0u, 3u, 2u}})
        mesh.triangles.push_back({first + a, first + b, first + c});
}

TEST(ProposedLines, AreAllPartsButSpecks) {
    TriangleMesh mesh;
    add_tetrahedron(mesh, {0, 0, 0}, 50);
    add_tetrahedron(mesh, {100, 0, 0}, 20);
    const Plane plane = make_plane({0, 0, 5}, {0, 0, 1});
    ASSERT_EQ(proposed_lines(mesh, plane).size(), 2u);
    add_tetrahedron(mesh, {200, 0, 4}, 2);
    EXPECT_EQ(outline(mesh, plane).size(), 3u);
    EXPECT_EQ(proposed_lines(mesh, plane).size(), 2u);
    EXPECT_TRUE(proposed_lines(mesh, make_plane({0, 0, 500}, {0, 0, 1})).empty());
    EXPECT_EQ(proposed_lines(mesh, make_plane({200.4, 0, 5}, {1, 0, 0})).size(), 1u) << "alone it is no speck";
}

}  // namespace
}  // namespace kontur::viewer
