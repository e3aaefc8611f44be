// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/click_guards.h"

#include <gtest/gtest.h>

#include "kontur/pipeline.h"
#include "support/drawn_bodies.h"

namespace kontur {
namespace {

const Vec3 kRadii{37, 33, 29};

ContourSet three_sections() { return test::drawn(test::ellipsoid({}, kRadii), test::three_planes({})); }

FittedFunction fitted(const ContourSet& set) {
    const Drawing drawing = read_drawing(set, FillRule::even_odd);
    const StageOptions stages = stage_options({}, drawing.diameter_mm());
    return fit(prepare(drawing, stages.prepare), stages.fit);
}

/// How far from the middle a function's surface is.
double reach(const ImplicitFunction& function, const Vec3& direction) {
    double near = 5, far = 60;
    while (far - near > 1e-3) (function.value((near + far) / 2 * direction) > 0 ? near : far) = (near + far) / 2;
    return near;
}

TEST(ClickGuards, AnExteriorClickMovesTheObjectOutwardsNowhere) {
    ContourSet set = three_sections();
    const ImplicitFunction before = fitted(set).function;
    const Vec3 clicked = normalized({1, 1, 1});
    set.exterior = {(reach(before, clicked) - 5) * clicked};
    const ImplicitFunction after = fitted(set).function;
    EXPECT_LT(reach(after, clicked), reach(before, clicked) - 4.9);
    for (const double x : {1.0, -1.0})
        for (const double y : {1.0, -1.0})
            for (const double z : {1.0, -1.0}) {
                const Vec3 octant = normalized({x, y, z});
                if (octant == clicked) continue;
                EXPECT_NEAR(reach(after, octant), reach(before, octant), 0.4) << x << " " << y << " " << z;
            }
}

TEST(ClickGuards, AreNoneWhereClicksHaveTheirSide) {
    ContourSet set = three_sections();
    const ImplicitFunction without = fitted(set).function;
    set.interior = {{0, 0, 0}};
    set.exterior = {{40, 40, 40}};
    const Drawing drawing = read_drawing(set, FillRule::even_odd);
    const PreparedContours prepared = prepare(drawing);
    EXPECT_TRUE(click_guards(prepared, without, {}).empty());
}

TEST(ClickGuards, LieOnTheSurfaceWithoutClicksAwayFromLines) {
    ContourSet set = three_sections();
    const ImplicitFunction without = fitted(set).function;
    const Vec3 clicked = normalized({1, 1, 1});
    set.exterior = {(reach(without, clicked) - 5) * clicked};
    const Drawing drawing = read_drawing(set, FillRule::even_odd);
    const std::vector<Bound> guards = click_guards(prepare(drawing), without, {});
    EXPECT_GT(guards.size(), 20u);
    for (const Bound& guard : guards) {
        EXPECT_NEAR(without.value(guard.position), 0, 0.5);
        EXPECT_EQ(guard.most_mm, 0);
        EXPECT_TRUE(std::isinf(guard.least_mm));
        EXPECT_GT(std::min({std::abs(guard.position.x), std::abs(guard.position.y), std::abs(guard.position.z)}), 1);
    }
}

}  // namespace
}  // namespace kontur
