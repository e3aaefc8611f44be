// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/active_bounds.h"

#include <gtest/gtest.h>

#include "kontur/fit/fit.h"
#include "kontur/function/implicit_function.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

/// Points of a ball, and one bound.
FittedFunction fitted_with(const Bound& bound) {
    PreparedContours prepared = prepare(test::three_great_circles(), {.bounds = false});
    prepared.bounds = {bound};
    FitOptions options;
    options.normal_offset_mm = 0.1;
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

TEST(ActiveBounds, ABoundBySideTakesPartOnlyWhereFHasTheOtherOne) {
    const Vec3 inside{2, 2, 2}, outside{9, 9, 9};
    const double much = fitted_with({.position = inside, .most_mm = 1e3, .noise_mm = 1}).function.value(inside) + 2;
    EXPECT_EQ(fitted_with({.position = inside, .least_mm = much, .noise_mm = 0.01, .by_side = true}).bounded, 0u);
    EXPECT_EQ(fitted_with({.position = inside, .least_mm = much, .noise_mm = 0.01}).bounded, 1u);
    EXPECT_NEAR(fitted_with({.position = outside, .least_mm = 1, .noise_mm = 0.01, .by_side = true}).function.value(outside),
                1, 0.05);
}

std::size_t held(const ActiveBounds& bounds) {
    std::vector<PointConstraint> points;
    bounds.append_to(points);
    return points.size();
}

TEST(ActiveBounds, HoldAtFirstWhereFIsFarthestOffInASurroundingAsWideAsThatIsFarFromTheDrawing) {
    const std::vector<BoundaryPoint> drawn{{.position = {0, 0, 0}}};
    // f is 0, and may be -1 at most at 10 mm from what was drawn, -1.1 in the middle of them, and -2 at 1 mm on the other
    // side.
    std::vector<Bound> bounds;
    for (int i = -5; i <= 5; ++i)
        bounds.push_back({.position = {10, 1.0 * i, 0}, .most_mm = i == 0 ? -1.1 : -1.0, .noise_mm = 0.1});
    bounds.push_back({.position = {-1, 0, 0}, .most_mm = -2, .noise_mm = 0.1});
    ActiveBounds active(bounds, drawn);
    EXPECT_TRUE(active.update(ImplicitFunction(), 1e-3, 0.5, {}));
    EXPECT_EQ(held(active), 2u) << "the worst on either side";
    EXPECT_TRUE(active.update(ImplicitFunction(), 1e-3, 0.5, {}));
    EXPECT_EQ(held(active), bounds.size()) << "what they do not keep is held next";
}

TEST(ActiveBounds, WhereASingleValueIsToldFIsHeldFromTheFirstSolveOn) {
    const std::vector<BoundaryPoint> drawn{{.position = {0, 0, 0}}};
    const std::vector<Bound> bounds{{.position = {10, 0, 0}, .least_mm = 2, .most_mm = 2, .noise_mm = 0.1},
                                    {.position = {10, 1, 0}, .least_mm = -2, .most_mm = -2, .noise_mm = 0.1}};
    ActiveBounds active(bounds, drawn);
    for (int solve = 0; solve < 2; ++solve) {
        std::vector<PointConstraint> points;
        active.append_to(points);
        ASSERT_EQ(points.size(), 2u);
        EXPECT_EQ(points[0].value, 2);
        EXPECT_EQ(points[1].value, -2);
        EXPECT_FALSE(active.update(ImplicitFunction(), 1e-3, 0.5, {})) << "another solve would do the same";
    }
    EXPECT_FALSE(active.holds_any()) << "none that has to be settled";
}

TEST(ActiveBounds, WhatIsLittleBesideANoiseDoesNotCount) {
    const std::vector<BoundaryPoint> drawn{{.position = {0, 0, 0}}};
    const auto counts = [&](double most_mm, double noise_mm) {
        const std::vector<Bound> bounds{{.position = {10, 0, 0}, .most_mm = most_mm, .noise_mm = noise_mm}};
        return ActiveBounds(bounds, drawn).update(ImplicitFunction(), 1e-3, 0.5, {});
    };
    EXPECT_TRUE(counts(-0.01, 0.1));
    EXPECT_FALSE(counts(-0.01, 1));
    EXPECT_FALSE(counts(-1e-4, 1e-6)) << "the solver's tolerance";
}

}  // namespace
}  // namespace kontur
