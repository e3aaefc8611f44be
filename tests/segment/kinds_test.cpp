// SPDX-License-Identifier: Apache-2.0
// Everything that a hand can draw, on solids whose truth is a formula.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "kontur/base/error.h"
#include "kontur/measure/components.h"
#include "kontur/segment.h"
#include "support/contour_sets.h"
#include "support/expect_error.h"
#include "support/polygons.h"
#include "support/solids.h"

namespace kontur {
namespace {

Grid grid_over(const Body& body, double spacing_mm) {
    return grid_around(body.bounds(), {spacing_mm, spacing_mm, spacing_mm}, 6);
}

double dice(const Segmentation& result, const Body& body) {
    return test::dice(result.mask.values, make_truth_mask(body, result.mask.grid).values);
}

bool warns(const SegmentReport& report, const std::string& part) {
    return std::ranges::any_of(report.warnings, [&](const std::string& w) { return w.find(part) != std::string::npos; });
}

std::vector<Plane> planes(double low, double high, double step) {
    std::vector<double> heights;
    for (double z = low; z <= high + 1e-9; z += step) heights.push_back(z);
    return test::axial_planes(heights);
}

ContourSet without_flags(ContourSet set) {
    for (Contour& contour : set.contours) contour.hole = false;
    return set;
}

TEST(Kinds, NestedContoursAreTheWallsOfACavity) {
    const Body shell = test::shell({}, 24, 14);
    const ContourSet drawn = without_flags(draw_sections(shell, planes(-20, 20, 5), 1600));
    const Segmentation result = segment(drawn, grid_over(shell, 1.5));
    EXPECT_GT(dice(result, shell), 0.985);
    EXPECT_TRUE(warns(result.report, "contours inside others became holes"));
    SegmentOptions options;
    options.fill_rule = FillRule::declared;
    const Segmentation solid = segment(drawn, grid_over(shell, 1.5), options);
    EXPECT_GT(dice(solid, test::ball_solid({}, 24)), 0.985);
    EXPECT_TRUE(warns(solid.report, "they are not holes"));
}

TEST(Kinds, TorusFromRingsOrFromPairsOfCircles) {
    const Body torus = test::torus_solid({}, 25, 10);
    std::vector<Plane> radial;
    for (int i = 0; i < 5; ++i) {
        const double angle = std::numbers::pi * i / 5;
        radial.push_back(make_plane({}, {std::cos(angle), std::sin(angle), 0}));
    }
    for (const std::vector<Plane>& cuts : {planes(-8, 8, 4), radial}) {
        const Segmentation result = segment(without_flags(draw_sections(torus, cuts, 900)), grid_over(torus, 1.5));
        EXPECT_GT(dice(result, torus), 0.995);
        EXPECT_EQ(result.report.mask_components, 1);
    }
}

TEST(Kinds, ATubeThatDividesStaysOnePiece) {
    const Body tube = test::bifurcation();
    for (const auto& [step, least] : {std::pair{5.0, 0.985}, {10.0, 0.965}}) {
        const Segmentation result = segment(draw_sections(tube, planes(-35, 35, step), 900), grid_over(tube, 1.5));
        EXPECT_GT(dice(result, tube), least);
        EXPECT_EQ(result.report.mask_components, 1);
    }
}

TEST(Kinds, SeparateObjectsStaySeparate) {
    const Body left = test::ball_solid({-20, 0, 0}, 12), right = test::ball_solid({14, 0, 4}, 16);
    const Body balls{
        "balls", {{-33, -17, -13}, {31, 17, 21}}, [=](const Vec3& p) { return std::max(left.value(p), right.value(p)); }};
    const Segmentation result = segment(draw_sections(balls, planes(-10, 18, 4), 900), grid_over(balls, 1.5));
    EXPECT_GT(dice(result, balls), 0.995);
    EXPECT_EQ(result.report.mask_components, 2);
}

/// The contours' points from angle 0 to `share` of a full turn, as open stretches.
ContourSet opened(ContourSet set, double share) {
    for (Contour& contour : set.contours) {
        contour.closed = false;
        contour.points.resize(static_cast<std::size_t>(share * static_cast<double>(contour.points.size())));
    }
    return set;
}

TEST(Kinds, OpenStretchesCompleteWhatClosedContoursLeaveOut) {
    const Body body = test::ellipsoid({}, {28, 20, 16});
    const ContourSet axial = draw_sections(body, test::axial_planes({-6, 6}), 200);
    ContourSet with_stretches = axial;
    const std::vector<Plane> sagittal{make_plane({}, {1, 0, 0})};
    for (Contour& stretch : opened(draw_sections(body, sagittal, 100), 0.6).contours)
        with_stretches.contours.push_back(stretch);
    const double without = dice(segment(axial, grid_over(body, 1)), body);
    const Segmentation result = segment(with_stretches, grid_over(body, 1));
    EXPECT_GT(dice(result, body), without + 0.01);
    EXPECT_GT(dice(result, body), 0.955);
    EXPECT_TRUE(warns(result.report, "contour 3 is open; the object was taken to lie on its"));
    EXPECT_LT(result.report.residual.max_mm, 0.2);
}

TEST(Kinds, SinglePointsOnTheSurfacePinIt) {
    const Body body = test::ellipsoid({}, {28, 20, 16});
    ContourSet drawn = draw_sections(body, test::axial_planes({-6, 0, 6}), 300);
    const double without = dice(segment(drawn, grid_over(body, 1)), body);
    drawn.surface = {{{0, 0, 16}, {}}, {{0, 0, -16}, Vec3{0, 0, -1}}};
    const Segmentation result = segment(drawn, grid_over(body, 1));
    EXPECT_GT(dice(result, body), without);
    EXPECT_GT(dice(result, body), 0.985);
    for (const SurfacePoint& p : drawn.surface) EXPECT_LT(std::abs(result.function.value(p.position)), 0.05);
    EXPECT_TRUE(result.report.warnings.empty()) << result.report.warnings.front();
}

TEST(Kinds, SinglePointsThatContradictTheContoursAreReported) {
    const Body body = test::ellipsoid({}, {28, 20, 16});
    ContourSet drawn = draw_sections(body, test::axial_planes({-6, 0, 6}), 300);
    drawn.surface = {{{0, 0, 16}, {}}, {{0, 0, 0}, {}}, {{45, 0, 0}, {}}};
    const Segmentation result = segment(drawn, grid_over(body, 2));
    EXPECT_TRUE(warns(result.report, "surface point 2 contradicts contour 2: it lies 20 mm from its line"));
    EXPECT_TRUE(warns(result.report, "surface point 3 contradicts contour 3: it lies 19.1 mm from its line"));
    EXPECT_FALSE(warns(result.report, "surface point 1"));
    EXPECT_GT(dice(result, body), 0.95) << "the drawn contours keep the surface";
}

TEST(Kinds, ASinglePointFartherAwayThanAllLinesAreWideIsNamed) {
    const Body body = test::ellipsoid({}, {28, 20, 16});
    ContourSet drawn = draw_sections(body, test::axial_planes({-6, 0, 6}), 300);
    drawn.surface = {{{0, 0, 16}, {}}, {{0, 0, 300}, {}}};
    EXPECT_TRUE(warns(segment(drawn, grid_over(body, 2)).report, "surface point 2 is 29"));
    drawn.surface[1].position.z = 40;
    EXPECT_FALSE(warns(segment(drawn, grid_over(body, 2)).report, "from every line"));
}

TEST(Kinds, HolesInNothingAreReportedAndHolesAloneRefused) {
    const Body body = test::ellipsoid({}, {28, 20, 16});
    ContourSet drawn = draw_sections(body, planes(-10, 10, 5), 100);
    drawn.contours[0].hole = true;
    EXPECT_TRUE(warns(segment(drawn, grid_over(body, 4)).report, "contour 1 is a hole where nothing is drawn around it"));
    for (Contour& contour : drawn.contours) contour.hole = true;
    EXPECT_THROW(segment(drawn, grid_over(body, 4)), Error);
}

TEST(Kinds, AClickDeepInsideOrFarOutsideChangesNothing) {
    const Body body = test::ellipsoid({}, {28, 20, 16});
    ContourSet drawn = draw_sections(body, planes(-12, 12, 6), 400);
    const Segmentation without = segment(drawn, grid_over(body, 1.5));
    drawn.interior = {{0, 0, 0}, {10, 5, 2}};
    drawn.exterior = {{0, 0, 30}, {40, 0, 0}};
    const Segmentation with = segment(drawn, grid_over(body, 1.5));
    EXPECT_TRUE(with.mask.values == without.mask.values);
    EXPECT_EQ(with.report.warnings, without.report.warnings);
}

TEST(Kinds, AClickPullsTheSurfaceWhereItIsAndNowhereElse) {
    const Body body = test::ellipsoid({}, {28, 20, 16});
    ContourSet drawn = draw_sections(body, planes(-10, 10, 10), 400);
    const Grid grid = grid_over(body, 1);
    const Segmentation without = segment(drawn, grid);
    const Vec3 bump{0, 20.5, 5}, dent{0, -17.5, -5};
    ASSERT_LT(without.function.value(bump), 0);
    ASSERT_GT(without.function.value(dent), 0);
    drawn.interior = {bump};
    drawn.exterior = {dent};
    const Segmentation with = segment(drawn, grid);
    EXPECT_GT(with.function.value(bump), 0);
    EXPECT_LT(with.function.value(dent), 0);
    EXPECT_EQ(with.report.mask_components, 1);
    EXPECT_TRUE(with.report.warnings.empty()) << with.report.warnings.front();
    // Between planes 10 mm apart everything gives a little; the surface may move by a mm at the clicks, but hardly
    // elsewhere.
    double farthest_move_mm = 0;
    for (const Contour& contour : drawn.contours)
        for (const Vec3& p : contour.points) farthest_move_mm = std::max(farthest_move_mm, std::abs(with.function.value(p)));
    EXPECT_LT(farthest_move_mm, 0.1) << "drawn contours hold";
    for (const Vec3& side : {Vec3{26, 0, 5}, Vec3{-26, 0, -5}, Vec3{26, 0, -5}, Vec3{-26, 0, 5}})
        EXPECT_NEAR(with.function.value(side), without.function.value(side), 0.3);
}

TEST(Kinds, ContradictoryClicksAreReported) {
    const Body body = test::ellipsoid({}, {28, 20, 16});
    ContourSet drawn = draw_sections(body, planes(-10, 10, 10), 400);
    drawn.interior = {{36, 0, 0}};
    const Segmentation result = segment(drawn, grid_over(body, 2));
    EXPECT_TRUE(warns(result.report, "interior point 1 contradicts contour 2: it lies 8 mm on its outside"));
    EXPECT_GT(dice(result, body), 0.95) << "the drawn contours keep the surface";
}

/// Centres so far from each other are beyond what the kernel's polynomials hold for.
TEST(Kinds, AClickFarFromTheDrawingLeavesItAsItIs) {
    const Body body = test::ellipsoid({}, {28, 20, 16});
    ContourSet drawn = draw_sections(body, planes(-10, 10, 10), 400);
    const Grid grid = grid_over(body, 2);
    const double alone = dice(segment(drawn, grid), body);
    for (const double away_mm : {60.0, 90.0, 150.0, 300.0, 700.0, 3000.0}) {
        drawn.interior = {{0.8 * away_mm, 0, 0.6 * away_mm}};
        EXPECT_NEAR(dice(segment(drawn, grid), body), alone, 0.01) << away_mm;
    }
    drawn.interior = {{9000, 0, 0}, {-9000, 0, 0}};
    EXPECT_KONTUR_ERROR(segment(drawn, grid), ErrorKind::invalid_input, "interior point 1 lies 9e+03 mm from the contours");
}

TEST(Kinds, EndsHereIsFlatOrRoundInsteadOfGoingOn) {
    const Body body = test::cylinder(15, -20, 20);
    ContourSet drawn = draw_sections(body, test::axial_planes({-12.4, -4, 4, 12.4}), 400);
    const Grid grid = grid_around(body.bounds(), {1, 1, 1}, 6);
    const double open = segment(drawn, grid).report.mask_volume_ml;
    drawn.contours.front().end = drawn.contours.back().end = ContourEnd::flat;
    const Segmentation flat = segment(drawn, grid);
    EXPECT_GT(dice(flat, test::cylinder(15, -12.4, 12.4)), 0.97);
    drawn.contours.front().end = drawn.contours.back().end = ContourEnd::round;
    const Segmentation round = segment(drawn, grid);
    EXPECT_GT(round.report.mask_volume_ml, 1.05 * flat.report.mask_volume_ml);
    EXPECT_LT(round.report.mask_volume_ml, open);
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i) {
                const double height = std::abs(grid.center_mm(i, j, k).z);
                EXPECT_FALSE(flat.mask.values[grid.offset(i, j, k)] && height > 12.6);
                EXPECT_FALSE(round.mask.values[grid.offset(i, j, k)] && height > 16.8) << "half a plane spacing";
            }
}

// Voxel centres in the plane of a flat end are as good as on the surface.
TEST(Kinds, AFlatEndKeepsTheSliceItWasDrawnIn) {
    for (const auto& [bottom, top] : {std::pair{20.0, 20.0}, {12.0, 24.0}, {24.0, 12.0}}) {
        const auto radius = [&, b = bottom, t = top](double z) { return b + (t - b) * (z + 20) / 40; };
        ContourSet drawn;
        for (const double z : {-20.0, -10.0, 0.0, 10.0, 20.0})
            drawn.contours.push_back(test::circle(make_plane({0, 0, z}, {0, 0, 1}), radius(z), 60));
        drawn.contours.front().end = drawn.contours.back().end = ContourEnd::flat;
        Grid grid{{61, 61, 51}, {}};
        grid.index_to_mm.translation = {-30, -30, -25};
        const Mask mask = segment(drawn, grid).mask;
        std::size_t wrong = 0, inside = 0, beyond = 0;
        for (std::int64_t k = 0; k < grid.size.k; ++k)
            for (std::int64_t j = 0; j < grid.size.j; ++j)
                for (std::int64_t i = 0; i < grid.size.i; ++i) {
                    const Vec3 at = grid.center_mm(i, j, k);
                    const bool set = mask.values[grid.offset(i, j, k)] != 0;
                    if (std::abs(at.z) > 20) beyond += set;
                    if (std::abs(at.z) != 20) continue;
                    const bool drawn_there = std::hypot(at.x, at.y) < radius(at.z);
                    inside += drawn_there;
                    wrong += set != drawn_there;
                }
        EXPECT_LT(static_cast<double>(wrong), 0.03 * static_cast<double>(inside)) << bottom;
        EXPECT_EQ(beyond, 0u) << bottom;
    }
}

TEST(Kinds, ThinPlatesStayWhole) {
    for (const auto& [half, least] : {std::pair{1.0, 0.95}, {2.0, 0.975}}) {
        const Body plate = test::ellipsoid({}, {24, 20, half});
        std::vector<Plane> cuts;
        for (int i = -3; i <= 3; ++i) cuts.push_back(make_plane({6.0 * i, 0, 0}, {1, 0, 0}));
        for (int i = -2; i <= 2; ++i) cuts.push_back(make_plane({0, 6.0 * i, 0}, {0, 1, 0}));
        const Segmentation result = segment(draw_sections(plate, cuts, 1600), grid_over(plate, 1));
        EXPECT_GT(dice(result, plate), least) << 2 * half << " voxels thick";
        EXPECT_EQ(result.report.mask_components, 1);
    }
}

TEST(Kinds, ShapesInOnePlaneBecomePlausibleBodies) {
    const Plane plane = make_plane({3, -40, 200}, {0.3, -0.5, 0.8});
    const auto ellipse = [&](double a, double b, double u) {
        std::vector<test::Point2> points;
        for (int i = 0; i < 80; ++i)
            points.push_back({u + a * std::cos(std::numbers::pi * i / 40), b * std::sin(std::numbers::pi * i / 40)});
        return test::contour_in(plane, points);
    };
    struct Case {
        const char* name;
        std::vector<Contour> contours;
        std::int64_t components;
        double thickness_mm;  ///< about twice the radius of the circle with the outline's area; a thin wall's dome is lower
    };
    const Contour bracket = test::contour_in(
        plane,
        std::vector<test::Point2>{{-25, -25}, {25, -25}, {25, -10}, {-8, -10}, {-8, 10}, {25, 10}, {25, 25}, {-25, 25}});
    const Case cases[] = {
        {"long", {ellipse(40, 4, 0)}, 1, 16},
        {"ring", {ellipse(25, 25, 0), ellipse(15, 15, 0)}, 1, 20},
        {"two", {ellipse(12, 12, -25), ellipse(8, 14, 15)}, 2, 24},
        {"bracket", {bracket}, 1, 30},
        {"triangle", {test::contour_in(plane, std::vector<test::Point2>{{0, 0}, {30, 0}, {0, 22}})}, 1, 20.5}};
    for (const Case& c : cases) {
        ContourSet set;
        set.contours = c.contours;
        const Segmentation result = segment(set, grid_around(bounding_box(set), {1, 1, 1}, 20));
        EXPECT_EQ(result.report.mask_components, c.components) << c.name;
        EXPECT_FALSE(warns(result.report, "border")) << c.name;
        EXPECT_LT(result.report.residual.max_mm, 0.5) << c.name;
        double highest = 0;
        const Grid& grid = result.mask.grid;
        for (std::int64_t k = 0; k < grid.size.k; ++k)
            for (std::int64_t j = 0; j < grid.size.j; ++j)
                for (std::int64_t i = 0; i < grid.size.i; ++i)
                    if (result.mask.values[grid.offset(i, j, k)])
                        highest = std::max(highest, std::abs(plane.distance_to(grid.center_mm(i, j, k))));
        EXPECT_NEAR(2 * highest, c.thickness_mm, 0.2 * c.thickness_mm) << c.name;
    }
}

/// What is asked of contours takes as long as of those with what they say: the values of f that are computed tell.
TEST(Kinds, AHundredTimesTooManyPointsCostNoMoreValues) {
    const Body ball = test::ball_solid({}, 20);
    const auto drawn_with = [](int points) {
        ContourSet set;
        for (double z = -18; z <= 18; z += 3)
            set.contours.push_back(test::circle(make_plane({0, 0, z}, {0, 0, 1}), std::sqrt(400 - z * z), points));
        return set;
    };
    const Segmentation vast = segment(drawn_with(20000), grid_over(ball, 1)),
                       plain = segment(drawn_with(200), grid_over(ball, 1));
    EXPECT_EQ(vast.report.points, 13u * 20000);
    EXPECT_LT(5 * vast.report.evaluations, 6 * plain.report.evaluations);
    EXPECT_LT(5 * vast.report.constraints, 6 * plain.report.constraints);
    EXPECT_GT(test::dice(vast.mask.values, plain.mask.values), 0.997);
    EXPECT_TRUE(warns(vast.report, "13 contours with very many points were thinned"));
}

TEST(Kinds, TinyAndHugeContoursSpikesAndRepeatedPoints) {
    const Body ball = test::ball_solid({}, 20);
    const auto heights = {-12.0, 0.0, 12.0};
    ContourSet huge, plain;
    for (const double z : heights) {
        const Plane plane = make_plane({0, 0, z}, {0, 0, 1});
        huge.contours.push_back(test::circle(plane, std::sqrt(400 - z * z), 100000));
        plain.contours.push_back(test::circle(plane, std::sqrt(400 - z * z), 100));
    }
    const Segmentation thinned = segment(huge, grid_over(ball, 2));
    EXPECT_GT(test::dice(thinned.mask.values, segment(plain, grid_over(ball, 2)).mask.values), 0.995);
    EXPECT_TRUE(warns(thinned.report, "3 contours with very many points were thinned"));
    EXPECT_EQ(thinned.report.points, 300000u);
    EXPECT_LT(thinned.report.residual.max_mm, 0.05) << "measured at those that were kept";

    ContourSet dirty = plain;
    std::vector<Vec3>& points = dirty.contours[1].points;
    points.insert(points.begin() + 20, {points[19] + Vec3{9, 9, 0}, points[19], points[19]});
    const Segmentation cleaned = segment(dirty, grid_over(ball, 2));
    EXPECT_GT(test::dice(cleaned.mask.values, segment(plain, grid_over(ball, 2)).mask.values), 0.997);
    EXPECT_TRUE(warns(cleaned.report, "repeated point") && warns(cleaned.report, "spike"));

    ContourSet tiny;
    tiny.contours = {test::contour_in(Plane{}, std::vector<test::Point2>{{0, 0}, {3, 0}, {0, 3}})};
    EXPECT_EQ(segment(tiny, grid_around(bounding_box(tiny), {0.25, 0.25, 0.25}, 3)).report.mask_components, 1);
}

}  // namespace
}  // namespace kontur
