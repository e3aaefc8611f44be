// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/active_bounds.h"

#include <gtest/gtest.h>

#include "kontur/fit/fit.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

/// Points of a ball, and one bound.
FittedFunction fitted_with(const Bound& bound) {
    PreparedContours prepared = prepare(test::three_great_circles(), {.bounds = false});
    prepared.bounds = {bound};
    FitOptions options;
    options.place.normal_offset_mm = 0.1;
    options.solve.smoothing = 1e-5;
    return fit(prepared, options);
}

TEST(ActiveBounds, ABoundThatFKeepsAnywayChangesNothing) {
    const FittedFunction free = fitted_with({.position = {4, 4, 0}, .most_mm = 1e3, .noise_mm = 0.1});
    const FittedFunction kept = fitted_with({.position = {4, 4, 0}, .least_mm = -1e3, .most_mm = 1e3, .noise_mm = 0.1});
    EXPECT_EQ(free.bounded, 0u);
    EXPECT_EQ(kept.bounded, 0u);
    for (const Vec3& p : {Vec3{1, 2, 3}, {8, 8, 8}}) EXPECT_EQ(kept.function.value(p), free.function.value(p));
}

TEST(ActiveBounds, ABoundIsKeptFromBothSidesAsCloselyAsItsNoiseAllows) {
    const Vec3 at{5, 5, 5};
    const double free = fitted_with({.position = at, .most_mm = 1e3, .noise_mm = 1}).function.value(at);
    for (const double off : {-2.0, 2.0}) {
        Bound bound{.position = at, .noise_mm = 0.01};
        (off < 0 ? bound.most_mm : bound.least_mm) = free + off;
        EXPECT_NEAR(fitted_with(bound).function.value(at), free + off, 0.05);
        bound.noise_mm = 1e4;
        EXPECT_NEAR(fitted_with(bound).function.value(at), free, 0.05);
    }
}

}  // namespace
}  // namespace kontur
