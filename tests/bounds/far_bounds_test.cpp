// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/far_bounds.h"

#include <gtest/gtest.h>

#include <random>

#include "kontur/phantom/cases.h"
#include "kontur/pipeline.h"
#include "support/contour_sets.h"
#include "support/random.h"

namespace kontur {
namespace {

TEST(FarBounds, LieAllAroundAtNearlyTwiceTheBallWithItsClicks) {
    ContourSet set = test::three_circles();
    set.interior = {{100, 0, 0}};
    std::vector<Vec3> all = set.interior;
    for (const Contour& contour : set.contours) all.insert(all.end(), contour.points.begin(), contour.points.end());
    const Ball3 ball = smallest_ball(all);
    const std::vector<Bound> bounds = far_bounds(DrawnPlanes(set));
    for (const Bound& bound : bounds) {
        EXPECT_NEAR(distance(bound.position, ball.center), 1.9 * ball.radius, 1e-9 * ball.radius);
        EXPECT_LT(bound.most_mm, 0);
    }
    std::mt19937 random = test::random_of_this_test();
    std::normal_distribution<double> normal;
    for (int n = 0; n < 1000; ++n) {
        const Vec3 direction = normalized({normal(random), normal(random), normal(random)});
        double nearest = -1;
        for (const Bound& bound : bounds)
            nearest = std::max(nearest, dot(direction, normalized(bound.position - ball.center)));
        EXPECT_GT(nearest, 0.97);
    }
}

TEST(FarBounds, TakeNoPartWhereTheObjectEndsByItself) {
    for (const char* name : {"kidney_radial6", "liver_oblique10"}) {
        const Drawing drawing = read_drawing(phantom_case(name).contours, FillRule::even_odd);
        const StageOptions stages = stage_options({}, drawing.diameter_mm());
        for (const PointConstraint& held : fit(prepare(drawing, stages.prepare), stages.fit).active_bounds)
            EXPECT_LT(distance(held.position, drawing.ball.center), 1.8 * drawing.ball.radius) << name;
    }
}

}  // namespace
}  // namespace kontur
