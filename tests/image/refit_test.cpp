// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/refit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "kontur/pipeline.h"
#include "support/lobed_body.h"

namespace kontur {
namespace {

using namespace test;

constexpr double kSpacing = 1.5;

/// The same lines with so many points for each one, by a hand that trembles: those of a straight edge would say nothing.
ContourSet finer(ContourSet contours, int times) {
    for (Contour& contour : contours.contours) {
        const std::vector<Vec3> points = std::exchange(contour.points, {});
        for (std::size_t n = 0; n < points.size(); ++n) {
            const Vec3 edge = points[(n + 1) % points.size()] - points[n];
            for (int part = 0; part < times; ++part)
                contour.points.push_back(points[n] + double(part) / times * edge +
                                         (part % 2 == 0 ? 0.0 : 0.02) * cross(contour.plane.normal, edge));
        }
    }
    return contours;
}

struct FittedBody {
    explicit FittedBody(int times = 1) : contours(finer(drawn_on(orthogonal_planes()), times)) {
        const Drawing drawing = read_drawing(contours, FillRule::even_odd);
        stages = stage_options({}, drawing.diameter_mm());
        prepared = prepare(drawing, stages.prepare);
        fitted = fit(prepared, stages.fit);
    }

    /// Points of the body's surface between the contours, at which f is to be 0.
    std::vector<PointConstraint> told() const {
        std::vector<PointConstraint> told;
        for (const double x : {-1.0, 1.0})
            for (const double y : {-1.0, 1.0})
                for (const double z : {-1.0, 1.0})
                    for (int n = 0; n < 40; ++n) {
                        const Vec3 direction = normalized({x * (0.5 + 0.01 * n), 0.6 * y, z * (0.9 - 0.01 * n)});
                        told.push_back({.position = (30 + lobed_depth(30 * direction)) * direction,
                                        .value = 0,
                                        .noise_mm = 0.03 * kSpacing});
                    }
        return told;
    }

    ContourSet contours;
    StageOptions stages;
    PreparedContours prepared;
    FittedFunction fitted;
};

/// f through everything at once, with no point of the contours left out.
Solution solution_at_once(const FittedBody& body, const std::vector<PointConstraint>& more) {
    std::vector<PointConstraint> single = body.fitted.active_bounds;
    single.insert(single.end(), more.begin(), more.end());
    SolveOptions solving = body.stages.fit.solve;
    solving.ball = body.prepared.ball;
    return solve(
        place_constraints(body.prepared.points, body.fitted.slopes, single, place_options(body.stages.fit)).constraints,
        solving);
}

TEST(Refit, IsNearlyWhatOneSolveOfAllIs) {
    const FittedBody body;
    const std::vector<PointConstraint> told = body.told();
    const ImplicitFunction one = solution_at_once(body, told).function;
    const FittedFunction refit = Refit(body.prepared, body.fitted, body.stages.fit, kSpacing).with({told, {}}, {});
    double changed = 0, off = 0;
    for (const Vec3& p : surface_points(one, body.contours)) {
        changed = std::max(changed, std::abs(body.fitted.function.value(p)));
        off = std::max(off, std::abs(refit.function.value(p)));
    }
    EXPECT_GT(changed, 2) << "mm: the data say something";
    EXPECT_LT(off, 0.05 * changed);
    EXPECT_EQ(refit.constraints, refit.function.weights().size());
}

TEST(Refit, KeepsTheContours) {
    const FittedBody body;
    const FittedFunction refit = Refit(body.prepared, body.fitted, body.stages.fit, kSpacing).with({body.told(), {}}, {});
    double largest = 0;
    for (const Contour& contour : body.contours.contours)
        for (const Vec3& p : contour.points)
            largest = std::max(largest, std::abs(refit.function.value(p) - body.fitted.function.value(p)));
    EXPECT_LT(largest, 0.02 * kSpacing);
}

TEST(Refit, TakesAPartOfThePointsOfLines) {
    const FittedBody body(10);
    const FittedFunction refit =
        Refit(body.prepared, body.fitted, body.stages.fit, kSpacing / 5).with({body.told(), {}}, {});
    EXPECT_LT(refit.report.matrix_mb, solution_at_once(body, body.told()).report.matrix_mb / 2);
    for (const Contour& contour : body.contours.contours)
        for (const Vec3& p : contour.points)
            EXPECT_NEAR(refit.function.value(p), body.fitted.function.value(p), 0.02 * kSpacing);
}

TEST(Refit, FollowsWhatIsToldFarFromTheContours) {
    const FittedBody body;
    const UnitFrame frame = body.fitted.function.frame();
    std::vector<PointConstraint> told;
    for (const double radii : {1.3, 1.5, 1.7})
        for (const double x : {-1.0, 1.0})
            told.push_back({.position = frame.center + radii * frame.scale * normalized({x, 0.6, 0.9}),
                            .value = (1.5 - radii) * frame.scale,
                            .noise_mm = 0.03 * kSpacing});
    const FittedFunction refit = Refit(body.prepared, body.fitted, body.stages.fit, kSpacing).with({told, {}}, {});
    for (const PointConstraint& one : told) EXPECT_NEAR(refit.function.value(one.position), one.value, 0.3 * kSpacing);
}

TEST(Refit, BetweenTwoFunctionsIsTheirMean) {
    const FittedBody body;
    const FittedFunction refit = Refit(body.prepared, body.fitted, body.stages.fit, kSpacing).with({body.told(), {}}, {});
    for (const double share : {0.0, 0.3, 1.0}) {
        const FittedFunction mean = between(body.fitted, refit, share);
        for (const PointConstraint& one : body.told())
            EXPECT_NEAR(mean.function.value(one.position),
                        std::lerp(body.fitted.function.value(one.position), refit.function.value(one.position), share),
                        1e-9);
    }
}

TEST(Refit, ChangesNothingWhereItIsToldWhatIsSo) {
    const FittedBody body;
    std::vector<PointConstraint> told = body.told();
    for (PointConstraint& one : told) one.value = body.fitted.function.value(one.position);
    const FittedFunction refit = Refit(body.prepared, body.fitted, body.stages.fit, kSpacing).with({told, {}}, {});
    for (const PointConstraint& one : told)
        EXPECT_NEAR(refit.function.value(one.position), body.fitted.function.value(one.position), 1e-9);
}

}  // namespace
}  // namespace kontur
