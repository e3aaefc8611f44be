// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/residual.h"

#include <gtest/gtest.h>

#include "support/contour_sets.h"

namespace kontur {
namespace {

/// f(x) = slope * x, in mm, with the surface at x = 0.
ImplicitFunction plane_function(double slope) { return {Kernel::triharmonic, {}, {}, {}, {0, slope, 0, 0}}; }

TEST(Residual, IsTheDistanceInMillimetresWhateverTheSlope) {
    const ContourSet set = test::three_circles();
    double largest = 0, squares = 0;
    std::size_t worst = 0;
    for (std::size_t c = 0; c < 3; ++c)
        for (const Vec3& p : set.contours[c].points) {
            squares += p.x * p.x;
            if (std::abs(p.x) > largest) {
                largest = std::abs(p.x);
                worst = c;
            }
        }
    for (const double slope : {0.5, 1.0, 7.0}) {
        const Residual found = residual(plane_function(slope), set);
        EXPECT_NEAR(found.max_mm, largest, 1e-12);
        EXPECT_NEAR(found.rms_mm, std::sqrt(squares / 60), 1e-12);
        EXPECT_EQ(found.worst_contour, worst);
    }
}

TEST(Residual, FlatFunctionIsNotInfinitelyFar) {
    const ContourSet set = test::three_circles();
    EXPECT_NEAR(residual(plane_function(0.01), set).max_mm, 0.1 * residual(plane_function(1), set).max_mm, 1e-12);
    EXPECT_EQ(residual(ImplicitFunction(), set).max_mm, 0);
    EXPECT_EQ(residual(plane_function(1), {}).rms_mm, 0);
}

}  // namespace
}  // namespace kontur
