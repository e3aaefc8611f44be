// SPDX-License-Identifier: Apache-2.0
#include "kontur/sureness/suggest_plane.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "kontur/phantom/phantom.h"
#include "kontur/sureness/surface_evidence.h"
#include "support/coarse_grid.h"
#include "support/drawn_bodies.h"
#include "support/expect_error.h"
#include "support/functions.h"

namespace kontur {
namespace {

using test::drawn;
using test::fitted;
using test::grid_for;

Plane axial(const Body& body, double fraction = 0.5) {
    Vec3 at = body.bounds().center();
    at.z = body.bounds().min.z + fraction * body.bounds().size().z;
    return make_plane(at, {0, 0, 1});
}

SuggestedPlane next_plane(const test::Fitted& made, const ContourSet& contours, const SuggestPlaneOptions& options = {}) {
    const PlaneSuggestions found = suggest_planes(made.evidence, contours, 1, options, {.threads = 1});
    EXPECT_EQ(found.planes.size(), 1u);
    return found.planes.at(0);
}

/// Draws what is suggested, plane by plane, and tells of each step.
void follow(const Body& body, std::size_t count, const SuggestPlaneOptions& options,
            const std::function<void(const std::vector<Plane>&, const test::Fitted&, const SuggestedPlane&)>& tell) {
    std::vector<Plane> planes{axial(body)};
    while (planes.size() < count) {
        const ContourSet contours = drawn(body, planes);
        const test::Fitted made = fitted(contours, grid_for(body));
        const SuggestedPlane next = next_plane(made, contours, options);
        tell(planes, made, next);
        planes.push_back(next.plane);
    }
}

double sum_of_uncertainty(const test::Fitted& made) { return 1 / expected_dice(made.evidence).value - 1; }

TEST(SuggestPlane, SecondPlaneIsPerpendicularAndAlongTheLongAxis) {
    const Body egg = test::ellipsoid({5, 6, 7}, {40, 20, 25});
    const Vec3 normal = normalized({0.2, -0.3, 0.9});
    const ContourSet contours = drawn(egg, {make_plane({5, 6, 7}, normal)});
    const SuggestedPlane next = next_plane(fitted(contours, grid_for(egg)), contours);
    EXPECT_NEAR(dot(next.plane.normal, normal), 0, 1e-6);
    EXPECT_NEAR(norm(next.plane.normal), 1, 1e-12);
    EXPECT_NEAR(next.plane.distance_to({5, 6, 7}), 0, 0.05);
    EXPECT_LT(std::abs(next.plane.normal.x), 0.1);  // the long axis lies in the plane
    EXPECT_FALSE(next.slice.has_value());
    EXPECT_EQ(next.before.value, 0);  // one plane does not tell
}

TEST(SuggestPlane, ParallelPlanesAreFollowedByOneAcross) {
    const Body egg = test::ellipsoid({}, {40, 20, 25});
    const ContourSet contours = drawn(egg, {axial(egg, 0.3), axial(egg, 0.5), axial(egg, 0.7)});
    const SuggestedPlane next = next_plane(fitted(contours, grid_for(egg)), contours);
    EXPECT_NEAR(next.plane.normal.z, 0, 1e-6);
}

/// Planes 0, 1 and 3.7 degrees apart through one place: they say nothing of the third direction, and of each other all that
/// they could contradict. kontur once made 4 % of a kidney's volume of such a drawing.
TEST(SuggestPlane, NearlyParallelPlanesOfAKidneyAreFollowedByOneAcross) {
    const Body body = kidney();
    const Vec3 middle = body.bounds().center();
    const std::vector<Plane> planes{make_plane(middle, {0, 0, 1}),
                                    make_plane(middle - Vec3{0, 0, 0.04}, {-0.0171, -0.0039, 0.9998}),
                                    make_plane(middle - Vec3{0, 0, 0.6}, {0.0551, -0.0328, 0.9979})};
    ContourSet contours = drawn(body, planes);
    const test::Fitted before = fitted(contours, grid_for(body));
    const SuggestedPlane next = next_plane(before, contours);
    EXPECT_LT(std::abs(dot(next.plane.normal, planes.front().normal)), 0.1);
    EXPECT_FALSE(before.report.uncertainty.is_known);

    const ContourSet more = drawn(body, {next.plane});
    contours.contours.insert(contours.contours.end(), more.contours.begin(), more.contours.end());
    const test::Fitted after = fitted(contours, grid_for(body));
    const Mask truth = make_truth_mask(body, grid_for(body), {.threads = 1});
    EXPECT_GT(test::dice(after.mask.values, truth.values), 0.85);
}

TEST(SuggestPlane, NeverRepeatsADrawnPlaneAndNeverMissesTheObject) {
    for (const PlaneChoice choice : {PlaneChoice::any, PlaneChoice::image_slices})
        for (const Body& body : {kidney(), vertebra()}) {
            SuggestPlaneOptions options{.planes = choice};
            options.grid = grid_for(body);
            follow(body, 10, options, [&](const auto& planes, const test::Fitted& made, const SuggestedPlane& next) {
                for (const Plane& plane : planes) {
                    if (std::abs(dot(plane.normal, next.plane.normal)) < 1 - 1e-9) continue;
                    EXPECT_GE(std::abs(plane.distance_to(next.plane.origin)), 0.03 * made.evidence.size_mm);
                }
                EXPECT_FALSE(drawn(body, {next.plane}).contours.empty()) << body.name() << " " << planes.size();
                EXPECT_GT(next.gain, 0);
                EXPECT_LE(next.gain, 1);
            });
        }
}

TEST(SuggestPlane, DrawingItLowersTheExpectedErrorInNineOfTenSteps) {
    int steps = 0, lower = 0;
    for (const Body& body : {liver(), kidney(), metastasis(), vertebra()}) {
        double last = 0;
        follow(body, 8, {}, [&](const auto& planes, const test::Fitted& made, const SuggestedPlane&) {
            if (planes.size() >= kLeastPlanes) {
                const double now = sum_of_uncertainty(made);
                if (last > 0) {
                    ++steps;
                    lower += now < last;
                }
                last = now;
            }
        });
    }
    EXPECT_EQ(steps, 4 * 4);
    EXPECT_GE(lower, 0.9 * steps);
}

TEST(SuggestPlane, SlicesOfTheImageAreItsLayers) {
    const Body body = kidney();
    SuggestPlaneOptions options{.planes = PlaneChoice::image_slices};
    options.grid = test::changed(grid_for(body), test::kOblique);
    const ContourSet contours = drawn(body, test::three_planes(body.bounds().center()));
    const PlaneSuggestions found = suggest_planes(fitted(contours, grid_for(body)).evidence, contours, 4, options);
    ASSERT_EQ(found.planes.size(), 4u);
    for (const SuggestedPlane& next : found.planes) {
        ASSERT_TRUE(next.slice.has_value());
        EXPECT_EQ(nearest_slice(*options.grid, next.slice->axis, next.plane.origin), *next.slice);
        const Plane layer = slice_plane(*options.grid, *next.slice);
        EXPECT_NEAR(layer.distance_to(next.plane.origin), 0, 1e-9);
        EXPECT_EQ(layer.normal, next.plane.normal);
    }
}

TEST(SuggestPlane, SkippedPlanesAreNotSuggestedAgain) {
    const Body body = kidney();
    const ContourSet contours = drawn(body, test::three_planes(body.bounds().center()));
    const test::Fitted made = fitted(contours, grid_for(body));
    SuggestPlaneOptions options;
    for (int skip = 0; skip < 4; ++skip) {
        const Plane next = next_plane(made, contours, options).plane;
        for (const Plane& plane : options.avoid) EXPECT_NE(plane, next);
        options.avoid.push_back(next);
    }
}

TEST(SuggestPlane, EmptyPlanesAreNotSuggestedAgain) {
    const Body body = kidney();
    ContourSet contours = drawn(body, test::three_planes(body.bounds().center()));
    const test::Fitted made = fitted(contours, grid_for(body));
    const Plane first = next_plane(made, contours).plane;
    contours.empty_planes = {first};
    const Plane second = next_plane(made, contours).plane;
    EXPECT_NE(second, first);
    EXPECT_EQ(second, next_plane(made, drawn(body, test::three_planes(body.bounds().center())), {.avoid = {first}}).plane);
}

TEST(SuggestPlane, AListLeavesLessAndLess) {
    const Body body = vertebra();
    const ContourSet contours = drawn(body, test::three_planes(body.bounds().center()));
    const PlaneSuggestions found = suggest_planes(fitted(contours, grid_for(body)).evidence, contours, 5);
    ASSERT_EQ(found.planes.size(), 5u);
    for (std::size_t n = 0; n < 5; ++n) {
        EXPECT_GT(found.planes[n].after.value, found.planes[n].before.value);
        if (n == 0) continue;
        EXPECT_EQ(found.planes[n].before.value, found.planes[n - 1].after.value);
    }
}

/// A drawing turned, moved and made three times as large.
struct Motion {
    static constexpr double kScale = 3;
    Affine3 to = [] {
        Affine3 motion = test::kOblique;
        for (auto& row : motion.linear)
            for (double& entry : row) entry *= kScale;
        motion.translation = {500, -70, 1200};
        return motion;
    }();
    Vec3 turned(const Vec3& direction) const { return to.apply_linear(direction) / kScale; }
    ContourSet moved(ContourSet contours) const {
        for (Contour& contour : contours.contours) {
            contour.plane = make_plane(to.apply(contour.plane.origin), turned(contour.plane.normal));
            for (Vec3& p : contour.points) p = to.apply(p);
        }
        return contours;
    }
    Grid moved(const Grid& grid) const { return {grid.size, compose(to, grid.index_to_mm)}; }
};

/// Samples lie elsewhere where rounding moves a crossing to the next edge of the lattice: one in a hundred here. Of planes
/// that are worth the same, another one may then be chosen.
TEST(SuggestPlane, TurnsMovesAndScalesWithTheDrawing) {
    const Motion motion;
    int same = 0;
    for (const Body& body : {liver(), kidney(), metastasis(), vertebra()})
        for (const PlaneChoice choice : {PlaneChoice::any, PlaneChoice::image_slices}) {
            const ContourSet contours = drawn(body, test::three_planes(body.bounds().center()));
            const Grid grid = grid_for(body), moved_grid = motion.moved(grid);
            const test::Fitted here = fitted(contours, grid), there = fitted(motion.moved(contours), moved_grid);
            const SuggestedPlane expected = next_plane(here, contours, {choice, grid}),
                                 found = next_plane(there, motion.moved(contours), {choice, moved_grid});
            const double off_mm = std::abs(found.plane.distance_to(motion.to.apply(expected.plane.origin)));
            same += std::abs(dot(found.plane.normal, motion.turned(expected.plane.normal))) > 1 - 1e-4 &&
                    off_mm < 3e-3 * there.evidence.size_mm;
            EXPECT_NEAR(found.gain / expected.gain, 1, 0.05) << body.name();
            EXPECT_NEAR(found.after.value, expected.after.value, 1e-3) << body.name();
            EXPECT_EQ(found.slice, expected.slice) << body.name();
        }
    EXPECT_GE(same, 7) << "of eight";
}

/// Candidates across the object are a seventh of it apart, gaps between ten drawn planes less than that.
TEST(SuggestPlane, LiesInTheMiddleOfANarrowGap) {
    const Body egg = test::ellipsoid({}, {20, 20, 40});
    std::vector<Plane> planes = test::parallel_planes(egg, 12);
    planes.erase(planes.begin() + 4);  // at z = -10
    planes.push_back(make_plane({}, {0, 1, 0}));
    const ContourSet contours = drawn(egg, planes);
    const SuggestedPlane next = next_plane(fitted(contours, grid_for(egg)), contours);
    EXPECT_GT(std::abs(next.plane.normal.z), 0.9) << next.plane.normal.x << " " << next.plane.normal.y;
    EXPECT_NEAR(next.plane.origin.z, -10, 1.2);
}

TEST(SuggestPlane, SameBytesForAnyNumberOfThreads) {
    const Body body = vertebra();
    const ContourSet contours = drawn(body, test::three_planes(body.bounds().center()));
    const test::Fitted made = fitted(contours, grid_for(body));
    const PlaneSuggestions one = suggest_planes(made.evidence, contours, 3, {.grid = grid_for(body)}, {.threads = 1}),
                           four = suggest_planes(made.evidence, contours, 3, {.grid = grid_for(body)}, {.threads = 4});
    ASSERT_EQ(one.planes.size(), four.planes.size());
    for (std::size_t n = 0; n < one.planes.size(); ++n) {
        EXPECT_EQ(one.planes[n].plane, four.planes[n].plane);
        EXPECT_EQ(one.planes[n].gain, four.planes[n].gain);
    }
    EXPECT_EQ(one.distances, four.distances);
}

/// What a suggestion costs depends on the samples, not on how much was drawn.
TEST(SuggestPlane, CostsAtMostTwentyMillionDistances) {
    const Body body = liver();
    const ContourSet contours = drawn(body, test::parallel_planes(body, 12));
    const ContourSet across = drawn(body, test::three_planes(body.bounds().center()));
    ContourSet all = contours;
    all.contours.insert(all.contours.end(), across.contours.begin(), across.contours.end());
    const test::Fitted made = fitted(all, grid_for(body));
    const PlaneSuggestions found = suggest_planes(made.evidence, all, 1, {.grid = grid_for(body)}, {.threads = 1});
    EXPECT_GT(found.candidates, 50);
    EXPECT_LE(found.candidates, 3 * 24 + 49 * 7 + 5 * 3 * 8);
    EXPECT_GT(found.distances, 0);
    EXPECT_LE(found.distances, 20'000'000);
}

TEST(SuggestPlane, SaysWhatIsMissing) {
    const Body ball = test::ball_solid({}, 20);
    const ContourSet contours = drawn(ball, test::three_planes({}));
    const SurfaceEvidence evidence = fitted(contours, grid_for(ball)).evidence;
    EXPECT_KONTUR_ERROR(suggest_planes(SurfaceEvidence{}, {}), ErrorKind::invalid_input, "there is no contour");
    EXPECT_KONTUR_ERROR(suggest_planes(evidence, contours, 0), ErrorKind::invalid_input, "0 planes are asked for");
    EXPECT_KONTUR_ERROR(suggest_planes(evidence, contours, 1, {.planes = PlaneChoice::image_slices}),
                        ErrorKind::invalid_input, "there is no image");
}

}  // namespace
}  // namespace kontur
