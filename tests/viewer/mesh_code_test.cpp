// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/mesh_code.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kontur/editor.h"
#include "support/contour_sets.h"

namespace kontur::viewer {
namespace {

std::int64_t unzigzag(std::uint32_t code) {
    return static_cast<std::int64_t>(code >> 1) ^ -static_cast<std::int64_t>(code & 1);
}

/// As the page does it.
std::vector<std::array<std::uint32_t, 3>> triangles_of(const std::vector<std::uint8_t>& bytes) {
    std::size_t at = 0;
    const auto next = [&] {
        std::uint32_t number = 0;
        int shift = 0;
        for (; bytes[at] > 127; shift += 7) number |= (bytes[at++] & 127u) << shift;
        return unzigzag(number | static_cast<std::uint32_t>(bytes[at++]) << shift);
    };
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::int64_t first = 0; at < bytes.size();) {
        first += next();
        const std::int64_t second = first + next(), third = first + next();
        triangles.push_back(
            {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(second), static_cast<std::uint32_t>(third)});
    }
    return triangles;
}

TEST(MeshCode, KeepsTrianglesExactlyAndPointsToHalfAStep) {
    const TriangleMesh mesh = Editor().preview(test::ball_contours()).mesh;
    const MeshCode code = code_mesh(mesh);
    EXPECT_EQ(triangles_of(code.triangles), mesh.triangles);
    const std::size_t count = mesh.points.size();
    ASSERT_EQ(code.positions.size(), 6 * count);
    ASSERT_EQ(code.normals.size(), 2 * count);
    EXPECT_LT(code.step_mm.x, 0.001);
    for (int axis = 0; axis < 3; ++axis) {
        std::uint16_t number = 0;
        for (std::size_t n = 0; n < count; ++n) {
            const std::size_t at = 2 * count * static_cast<std::size_t>(axis) + n;
            number = static_cast<std::uint16_t>(number + unzigzag(code.positions[at] + 256u * code.positions[at + count]));
            ASSERT_NEAR(code.origin[axis] + number * code.step_mm[axis], mesh.points[n][axis], 0.51 * code.step_mm[axis]);
        }
    }
    std::uint8_t u = 0, v = 0;
    for (std::size_t n = 0; n < count; ++n) {
        u = static_cast<std::uint8_t>(u + unzigzag(code.normals[n]));
        v = static_cast<std::uint8_t>(v + unzigzag(code.normals[count + n]));
        Vec3 normal{u / 127.5 - 1, v / 127.5 - 1, 0};
        normal.z = 1 - std::abs(normal.x) - std::abs(normal.y);
        if (normal.z < 0) {
            const double x = normal.x;
            normal.x = std::copysign(1 - std::abs(normal.y), normal.x);
            normal.y = std::copysign(1 - std::abs(x), normal.y);
        }
        ASSERT_GT(dot(normalized(normal), mesh.normals[n]), std::cos(0.02)) << n;
    }
    EXPECT_TRUE(code_mesh({}).positions.empty());
}

TEST(MeshCode, WidthsAreKeptToATwoHundredthOfTheLargest) {
    const std::vector<double> widths{0, 0.5, 2.55};
    const WidthCode code = code_widths(widths);
    for (std::size_t n = 0; n < widths.size(); ++n) EXPECT_NEAR(code.steps[n] * code.step_mm, widths[n], 0.0051);
    EXPECT_EQ(code_widths(std::vector<double>{0, 0}).steps, (std::vector<std::uint8_t>{0, 0}));
}

TEST(MeshCode, DistancesAreKeptToA254thOfTheLargestOnBothSides) {
    const std::vector<double> distances{-3.5, 0, 1.1, 6.35};
    const WidthCode code = code_distances(distances);
    for (std::size_t n = 0; n < distances.size(); ++n)
        EXPECT_NEAR((code.steps[n] - 128) * code.step_mm, distances[n], 0.51 * 6.35 / 127);
    EXPECT_TRUE(code_distances({}).steps.empty());
    EXPECT_EQ(code_distances(std::vector<double>{0, 0}).steps, (std::vector<std::uint8_t>{128, 128}));
}

}  // namespace
}  // namespace kontur::viewer
