// SPDX-License-Identifier: Apache-2.0
// The stages called alone, with their own defaults, are what `segment` does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "kontur/kontur.h"
#include "kontur/pipeline.h"
#include "kontur/stages.h"
#include "same_function.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

using test::expect_same_function;

/// Three circles of a ball, of which the last one is drawn too large: they contradict each other where they cross.
ContourSet contradiction() {
    ContourSet set = test::three_great_circles();
    set.contours[2] = test::circle(set.contours[2].plane, 10.6, 60);
    return set;
}

/// An open line that does not tell on which hand the object lies, and clicks.
ContourSet open_line_and_clicks() {
    ContourSet set = test::three_circles();
    Contour& middle = set.contours[1];
    middle.closed = false;
    middle.points.resize(12);
    set.interior = {{1, 2, 3}};
    set.exterior = {{1, 2, 14}};
    return set;
}

std::vector<ContourSet> drawings() {
    ContourSet one_plane;
    one_plane.contours = {test::three_circles().contours.front()};
    return {phantom_case("kidney_radial6").contours, contradiction(), open_line_and_clicks(), one_plane};
}

Segmentation segmented(const ContourSet& set, const SegmentOptions& options) {
    return segment(set, grid_around(bounding_box(set), {3, 3, 3}, 2 * diameter_mm(set)), options);
}

TEST(Defaults, OfTheStagesMakeTheFunctionThatSegmentMakes) {
    for (const ContourSet& set : drawings())
        expect_same_function(fit(prepare(read_drawing(set))).function, segmented(set, {}).function);
}

TEST(Defaults, OfTheFitFollowTheNormals) {
    const SegmentOptions options{.normals = Normals::in_plane};
    for (const ContourSet& set : drawings()) {
        const Drawing drawing = read_drawing(set);
        const StageOptions stages = stage_options(options, drawing.diameter_mm());
        const FittedFunction alone = fit(prepare(drawing, stages.prepare), {.normals = Normals::in_plane});
        expect_same_function(alone.function, segmented(set, options).function);
    }
}

TEST(Defaults, OfReconcilingAreThoseOfPreparing) {
    const Drawing drawing = read_drawing(contradiction());
    const std::vector<BoundaryPoint> together = prepare(drawing).points;
    std::vector<BoundaryPoint> alone = prepare(drawing, {.reconcile = {.conflicts = Conflicts::exact}}).points;
    reconcile(alone, drawing.crossings, drawing.diameter_mm());
    ASSERT_EQ(alone.size(), together.size());
    double least = 1;
    for (std::size_t i = 0; i < alone.size(); ++i) {
        EXPECT_EQ(alone[i].trust, together[i].trust);
        least = std::min(least, alone[i].trust);
    }
    EXPECT_LT(least, 0.1) << "there is something to reconcile";
}

TEST(Defaults, OfSolvingAreThoseOfTheFit) {
    const PreparedContours prepared = prepare(read_drawing(test::three_circles()));
    const FitOptions fitting = resolved(FitOptions{.rounds = 0, .most_solves = 1}, prepared.ball.diameter());
    const std::vector<double> slopes(prepared.points.size(), 1.0);
    const ConstraintSet constraints = place_constraints(prepared.points, slopes, {}, place_options(fitting)).constraints;
    const SolveOptions ball{.ball = prepared.ball};
    const Solution alone = solve(constraints, ball), given = solve(constraints, resolved(ball, prepared.ball.diameter()));
    expect_same_function(alone.function, given.function);
    EXPECT_EQ(*fitting.solve.smoothing, *resolved(SolveOptions{}, 40).smoothing);
    EXPECT_EQ(*fitting.solve.tolerance_mm, *resolved(SolveOptions{}, prepared.ball.diameter()).tolerance_mm);
}

TEST(Defaults, GiveWayToWhatIsGiven) {
    const FitOptions fitting{.normals = Normals::in_plane,
                             .normal_offset_mm = 0.7,
                             .both_sides = true,
                             .slope_noise = 0.5,
                             .solve = {.smoothing = 1e-3, .tolerance_mm = 0.2}};
    const FitOptions all = resolved(fitting, 100);
    EXPECT_EQ(all.normal_offset_mm, 0.7);
    EXPECT_EQ(all.both_sides, true);
    EXPECT_EQ(all.normal_spacing_mm, 0) << "that of in-plane normals";
    EXPECT_EQ(all.slope_noise, 0.5);
    EXPECT_EQ(all.solve.smoothing, 1e-3);
    EXPECT_EQ(all.solve.tolerance_mm, 0.2);
    const PrepareOptions preparing = resolved(PrepareOptions{.click_margin_mm = 2}, 100);
    EXPECT_EQ(preparing.click_margin_mm, 2);
    EXPECT_EQ(preparing.corner_spacing_mm, 2 * kMergeFraction * 100);
}

}  // namespace
}  // namespace kontur
