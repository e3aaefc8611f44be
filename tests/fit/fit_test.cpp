// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "kontur/base/error.h"
#include "kontur/phantom/cases.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

/// Mean error in degrees of the surface's tilt against the contours' planes, as the fit's slopes say it.
double mean_tilt_error(const PhantomCase& c, const PreparedContours& prepared, const FittedFunction& fitted) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < c.normals.size(); ++k)
        for (std::size_t i = 0; i < c.normals[k].size(); ++i) {
            const auto found =
                std::ranges::find(prepared.points, c.contours.contours[k].points[i], &BoundaryPoint::position);
            if (found == prepared.points.end()) {
                ADD_FAILURE() << "point " << i << " of contour " << k << " is not there";
                continue;
            }
            const double truth = std::acos(std::min(1.0, dot(c.normals[k][i], found->inplane_normal)));
            sum += std::abs(std::acos(std::min(1.0, fitted.slopes[found - prepared.points.begin()])) - truth);
            ++count;
        }
    EXPECT_EQ(count, fitted.slopes.size());
    return sum / static_cast<double>(count) * 180 / M_PI;
}

FitOptions options_for(const PhantomCase& c) {
    FitOptions options;
    const double diagonal = bounding_box(c.contours).diagonal();
    options.normal_offset_mm = 3e-3 * diagonal;
    options.merge_distance_mm = 4e-4 * diagonal;
    options.solve.smoothing = 1e-5;
    return options;
}

TEST(Fit, FindsTheTiltOfTheSurfaceFromAllContoursTogether) {
    for (const char* name : {"metastasis_parallel7", "kidney_radial6"}) {
        const PhantomCase c = phantom_case(name);
        const PreparedContours prepared = prepare(c.contours, {.least_segments = 0});
        FitOptions options = options_for(c);
        const FittedFunction surface = fit(prepared, options);
        options.normals = Normals::in_plane;
        const FittedFunction in_plane = fit(prepared, options);
        EXPECT_LT(mean_tilt_error(c, prepared, surface), 1.5) << name;
        EXPECT_GT(mean_tilt_error(c, prepared, in_plane), 8) << name << " leaves something to find";
        EXPECT_LT(surface.tilt_change_degrees, 1) << name;
        EXPECT_LE(surface.full_solves, options.most_solves);
        EXPECT_EQ(in_plane.solves, in_plane.full_solves);
        EXPECT_LE(surface.iterations, 10 * surface.solves) << name;
        for (const double slope : surface.slopes) {
            EXPECT_GE(slope, options.least_slope) << name;
            EXPECT_LE(slope, 1) << name;
        }
    }
}

TEST(Fit, SettlesItsBoundsBeforeItSolvesForAllPoints) {
    int solves_of_all = 0, solves_of_a_part = 0;
    for (const char* name : {"metastasis_parallel17", "liver_parallel14", "vertebra_parallel11"}) {
        const PhantomCase c = phantom_case(name);
        const PreparedContours prepared = prepare(c.contours);
        FitOptions options = options_for(c);
        const FittedFunction settled = fit(prepared, options);
        EXPECT_GT(settled.bounded, 0u) << name;
        solves_of_all += settled.full_solves;
        solves_of_a_part += settled.solves - options.rounds - settled.full_solves;

        options.most_solves = 1;
        EXPECT_EQ(fit(prepared, options).solves, options.rounds + 1) << name << ": whatever is held";
    }
    EXPECT_GT(solves_of_a_part, 0);
    EXPECT_LE(solves_of_all, 5) << "without, each takes three and has not ended then";
}

TEST(Fit, OneSolveWhereItIsToldWhichBoundsItLeansOn) {
    for (const char* name : {"metastasis_parallel17", "vertebra_parallel11"}) {
        const PhantomCase c = phantom_case(name);
        const PreparedContours prepared = prepare(c.contours);
        FitOptions options = options_for(c);
        options.most_points = 1000;
        options.most_solves = 10;  // until it has settled
        const FittedFunction settled = fit(prepared, options);
        options.rounds = 0;
        options.start_slopes = settled.slopes;
        const FittedFunction untold = fit(prepared, options);
        EXPECT_GT(untold.solves, 1) << name;
        for (const PointConstraint& one : settled.active_bounds)
            for (std::size_t b = 0; b < prepared.bounds.size(); ++b)
                if (prepared.bounds[b].position == one.position) options.start_bounds.push_back(b);
        ASSERT_EQ(options.start_bounds.size(), settled.active_bounds.size()) << name;
        const FittedFunction told = fit(prepared, options);
        EXPECT_EQ(told.solves, 1) << name;
        for (const BoundaryPoint& point : prepared.points) {
            const Vec3 beside = point.position + 2.0 * point.plane_normal;
            EXPECT_NEAR(told.function.value(beside), settled.function.value(beside), 0.02) << name;
        }
    }
}

TEST(Fit, RefusesToHoldABoundThatIsNotThere) {
    const PhantomCase c = phantom_case("metastasis_parallel7");
    const PreparedContours prepared = prepare(c.contours);
    FitOptions options = options_for(c);
    options.rounds = 0;
    options.start_bounds = {prepared.bounds.size()};
    try {
        static_cast<void>(fit(prepared, options));
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
        EXPECT_NE(std::string(error.what()).find("is to be held to begin with; there are"), std::string::npos)
            << error.what();
    }
}

TEST(Fit, OfSmoothLinesTakesFewPointsAndMissesNone) {
    for (const char* name : {"liver_oblique10", "kidney_radial6", "metastasis_parallel17"}) {
        const PhantomCase c = phantom_case(name);
        const PreparedContours prepared = prepare(c.contours);
        FitOptions options = options_for(c);
        const double tolerance_mm = 1e-4 * prepared.ball.diameter();
        const FittedFunction few = fit(prepared, options);
        options.line_tolerance_mm = 0;
        const FittedFunction all = fit(prepared, options);
        EXPECT_LT(2 * few.constraints, all.constraints) << name;
        EXPECT_EQ(few.solves, all.solves) << name << ": the first try is the last";
        for (const BoundaryPoint& point : prepared.points) {
            EXPECT_LT(std::abs(few.function.value(point.position)), 3 * tolerance_mm) << name;
            const Vec3 beside = point.position + 2.0 * point.plane_normal;
            EXPECT_NEAR(few.function.value(beside), all.function.value(beside), 0.05) << name;
        }
    }
}

TEST(Fit, TakesAllPointsWhereFewMissOneOrAnUnsteadyHandDrew) {
    const PhantomCase c = phantom_case("kidney_radial6_hand");
    const PreparedContours prepared = prepare(c.contours);
    FitOptions options = options_for(c);
    options.line_tolerance_mm = 0;
    const FittedFunction all = fit(prepared, options);
    for (const double share : {1e-4, 1e-3}) {
        options.line_tolerance_mm = share * prepared.ball.diameter();
        const FittedFunction fitted = fit(prepared, options);
        EXPECT_EQ(fitted.constraints, all.constraints) << share;
        EXPECT_EQ(fitted.full_solves, all.full_solves) << share;
        EXPECT_EQ(fitted.solves, all.solves + (share == 1e-3 ? 1 : 0)) << share << ": one is tried for nothing, or none";
        for (const BoundaryPoint& point : prepared.points)
            EXPECT_NEAR(fitted.function.value(point.position), all.function.value(point.position),
                        4 * *resolved(options.solve, prepared.ball.diameter()).tolerance_mm);
    }
}

TEST(Fit, FewIterationsOnThePapersLargestCase) {
    const PhantomCase c = phantom_case("liver_orthogonal14");
    FitOptions options = options_for(c);
    options.rounds = 1;
    options.line_tolerance_mm = 0;
    const FittedFunction fitted = fit(prepare(c.contours), options);
    EXPECT_GT(fitted.constraints, 13000u);
    EXPECT_LE(fitted.iterations, 15 * fitted.solves);
}

/// Many circles of a ball of radius 40, as prepared points of contours that are numbered as told.
PreparedContours numbered_circles(const std::vector<std::int32_t>& numbers) {
    ContourSet set;
    const auto count = static_cast<int>(numbers.size());
    for (int c = 0; c < count; ++c) {
        const double z = -36 + 72.0 * c / (count - 1);
        set.contours.push_back(test::circle(make_plane({0, 0, z}, {0, 0, 1}), std::sqrt(1600 - z * z), 60));
    }
    PreparedContours prepared = prepare(set, {.least_segments = 0, .bounds = false});
    for (BoundaryPoint& point : prepared.points) point.contour = numbers[static_cast<std::size_t>(point.contour)];
    return prepared;
}

FittedFunction few_points(const PreparedContours& prepared, std::size_t points) {
    FitOptions options;
    options.tilt_points = options.most_points = points;
    options.normal_offset_mm = 0.4;
    options.solve.smoothing = 1e-5;
    return fit(prepared, options);
}

TEST(Fit, ThinsPointsOfContoursInAnyOrder) {
    std::vector<std::int32_t> upward(19);
    std::iota(upward.begin(), upward.end(), 0);
    const FittedFunction expected = few_points(numbered_circles(upward), 300);
    EXPECT_LT(expected.constraints, 1200u) << "something was thinned";
    EXPECT_GT(expected.function.value({0, 0, 0}), 15);
    const std::vector<std::int32_t> downward(upward.rbegin(), upward.rend());
    std::vector<std::int32_t> far = upward;
    far.front() = 1'000'000'000;
    for (const std::vector<std::int32_t>& numbers : {downward, far}) {
        const FittedFunction fitted = few_points(numbered_circles(numbers), 300);
        EXPECT_EQ(fitted.constraints, expected.constraints);
        for (const Vec3& p : {Vec3{0, 0, 0}, {30, 10, -20}, {0, 0, 41}})
            EXPECT_EQ(fitted.function.value(p), expected.function.value(p)) << "what a contour is called changes nothing";
    }
}

TEST(Fit, ThinningKeepsSinglePointsUnlessTheyAreMost) {
    std::vector<std::int32_t> upward(19);
    std::iota(upward.begin(), upward.end(), 0);
    for (const std::size_t singles : {std::size_t{1}, std::size_t{12}, std::size_t{5000}})
        for (const bool first : {false, true}) {
            PreparedContours prepared = numbered_circles(upward);
            std::vector<BoundaryPoint> points;
            for (std::size_t i = 0; i < singles; ++i) {  // beside the ball, so that it shows whether they were followed
                const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(singles);
                points.push_back({.position = {43 * std::cos(angle), 43 * std::sin(angle), 2}, .contour = kNoContour});
            }
            prepared.points.insert(first ? prepared.points.begin() : prepared.points.end(), points.begin(), points.end());
            const FittedFunction fitted = few_points(prepared, 300);
            EXPECT_LT(fitted.constraints, 1800u) << singles;
            EXPECT_NEAR(fitted.function.value(points.front().position), 0, 0.5) << singles << ' ' << first;
            EXPECT_EQ(fitted.slopes.size(), prepared.points.size());
        }
}

}  // namespace
}  // namespace kontur
