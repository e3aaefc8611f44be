// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kontur/base/error.h"
#include "support/bodies.h"
#include "support/expect_error.h"

namespace kontur::viewer {
namespace {

using std::numbers::pi;

Grid cube_of(std::int64_t n) { return {{n, n, n}, {}}; }

TEST(Statistics, OfABallAreThoseOfTheFormulas) {
    const TriangleMesh mesh = test::ball({20, 20, 20}, 10, 5);
    const Grid grid = cube_of(40);
    Mask mask{grid, std::vector<std::uint8_t>(64000)};
    std::vector<std::int16_t> values(64000);
    for (std::int64_t k = 0, n = 0; k < 40; ++k)
        for (std::int64_t j = 0; j < 40; ++j)
            for (std::int64_t i = 0; i < 40; ++i, ++n) {
                const Vec3 at{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
                mask.values[static_cast<std::size_t>(n)] = distance(at, {20, 20, 20}) < 10;
                values[static_cast<std::size_t>(n)] =
                    static_cast<std::int16_t>(10 * i - 100);  // a ramp: its mean is that of the centre
            }
    const Statistics found = statistics(mesh);
    EXPECT_NEAR(found.volume_ml, 4.0 / 3 * pi, 0.01);
    EXPECT_NEAR(found.surface_cm2, 4 * pi, 0.02);
    EXPECT_NEAR(found.diameter_mm, 20, 0.01);
    EXPECT_NEAR(distance(found.from, found.to), found.diameter_mm, 1e-12);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(found.extent_mm[axis], 20, 1e-9);
    const ValueStatistics inside = value_statistics(mask, {grid, values});
    EXPECT_NEAR(static_cast<double>(inside.voxels), 4000.0 / 3 * pi, 60);
    EXPECT_NEAR(inside.mean, 100, 1e-9);
    EXPECT_NEAR(inside.deviation, 100 / std::sqrt(5.0), 0.5);  // r^2 / 5 along an axis of a ball
    EXPECT_EQ(inside.least, 10);
    EXPECT_EQ(inside.most, 190);
}

TEST(Statistics, TheLargestDiameterIsThatOfAllPairsOfPoints) {
    TriangleMesh mesh =
        test::star({0, 0, 0}, 4, [](const Vec3& d) { return 10 + 4 * d.x * d.y + 3 * std::sin(5 * d.z) + 2 * d.x; });
    double longest = 0;
    for (const Vec3& a : mesh.points)
        for (const Vec3& b : mesh.points) longest = std::max(longest, distance(a, b));
    EXPECT_NEAR(statistics(mesh).diameter_mm, longest, 1e-9);
}

TEST(Statistics, WithoutVoxelsOfAnEmptyMaskOrOfNoFiniteValue) {
    const Mask nothing{cube_of(1), {0}}, all{cube_of(1), {1}};
    const Image image{cube_of(1), std::vector<float>{std::nanf("")}};
    for (const Mask& mask : {nothing, all}) {
        EXPECT_EQ(value_statistics(mask, image).voxels, 0);
        EXPECT_EQ(value_statistics(mask, image).mean, 0);
    }
}

TEST(Statistics, RefusesAMaskOfAnotherGrid) {
    const Mask mask{cube_of(2), std::vector<std::uint8_t>(8)};
    EXPECT_KONTUR_ERROR(value_statistics(mask, {cube_of(3), std::vector<std::int16_t>(27)}), ErrorKind::invalid_input,
                        "does not lie on the image's grid");
}

}  // namespace
}  // namespace kontur::viewer
