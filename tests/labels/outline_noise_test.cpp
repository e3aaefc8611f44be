// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/outline_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kontur/labels/label_boxes.h"
#include "support/label_maps.h"

namespace kontur {
namespace {

using test::index_grid;
using test::label_map;

/// A tube of `radius` voxels along k, painted on every fifth slice, and lengthwise on one, if asked.
std::optional<double> smoothing_of_tube(double radius, const Vec3& spacing_mm, bool lengthwise = false) {
    const Image map = label_map(index_grid({50, 50, 41}, spacing_mm), [&](const Index3& at) {
        const bool painted = at.k % 5 == 0 || (lengthwise && at.j == 25);
        return painted && std::hypot(double(at.i) - 25, double(at.j) - 25) < radius ? 1 : 0;
    });
    const PaintedObject object = painted_object(map, 1, label_boxes(map).at(1), 4);
    return outline_smoothing(object, contours_of(object, 0.7));
}

TEST(OutlineSmoothing, HasNoUnit) {
    const std::optional<double> one = smoothing_of_tube(10, {1, 1, 1}), three = smoothing_of_tube(10, {3, 3, 3});
    ASSERT_TRUE(one && three);
    EXPECT_NEAR(*one, *three, 1e-9);
}

TEST(OutlineSmoothing, GrowsWithTheSquareOfTheThickness) {
    const double thin = *smoothing_of_tube(4, {1, 1, 1}), thick = *smoothing_of_tube(12, {1, 1, 1});
    EXPECT_NEAR(std::sqrt(thick / thin), 11.5 / 3.5 * 20.4 / 23.3, 0.2) << "the balls around them have 20.4 and 23.3 voxels";
    EXPECT_NEAR(thick, 36 * std::pow(0.05 * 11.5 / 23.3, 2), 0.003) << "a twentieth of the half thickness";
}

TEST(OutlineSmoothing, IsThatOfDrawingsWhereSlicesCross) { EXPECT_FALSE(smoothing_of_tube(10, {1, 1, 1}, true)); }

}  // namespace
}  // namespace kontur
