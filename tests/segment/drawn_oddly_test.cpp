// SPDX-License-Identifier: Apache-2.0
// What people and programs draw without meaning anything by it: twice, in planes that show only some of the parts, with any
// origin of a plane, rounded.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kontur/measure/compare.h"
#include "kontur/phantom/cases.h"
#include "kontur/segment.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

constexpr double kRadius = 50;

Contour circle_at(const Vec3& center, double radius, int count = 60, const Vec3& normal = {0, 0, 1}) {
    return test::circle(make_plane(center, normal), radius, count);
}

/// Axial circles of a ball, of an ellipsoid of 40 x 40 x 60 mm beside it, and of the wall of a cup.
ContourSet ball(const std::vector<double>& heights) {
    ContourSet set;
    for (const double z : heights) set.contours.push_back(circle_at({0, 0, z}, std::sqrt(kRadius * kRadius - z * z)));
    return set;
}

void add_kidney(ContourSet& set, double x, const std::vector<double>& heights) {
    for (const double z : heights) set.contours.push_back(circle_at({x, 0, z}, 40 * std::sqrt(1 - z * z / 3600)));
}

Segmentation segmented(const ContourSet& set, double spacing_mm, double margin_mm, const SegmentOptions& options = {}) {
    return segment(set, grid_around(bounding_box(set), {spacing_mm, spacing_mm, spacing_mm}, margin_mm), options);
}

double volume_ml(const ContourSet& set, double spacing_mm = 3, double margin_mm = 40, const SegmentOptions& options = {}) {
    return segmented(set, spacing_mm, margin_mm, options).report.mask_volume_ml;
}

bool warns(const SegmentReport& report, const std::string& part) {
    return std::ranges::any_of(report.warnings, [&](const std::string& w) { return w.find(part) != std::string::npos; });
}

TEST(DrawnOddly, TwiceIsOnce) {
    const double once = volume_ml(ball({-30, 0, 30}));
    EXPECT_NEAR(once, 531, 5);
    for (const std::vector<double>& heights :
         {std::vector<double>{-30, 0, 30, 0}, {-30, 0, 30, -30, 0, 30}, {-30, 0, 30, 0.01}, {-30, 0, 30, 0.1}})
        EXPECT_NEAR(volume_ml(ball(heights)), once, 0.01 * once) << heights.size();
    ContourSet redrawn = ball({-30, 0, 30, 0});
    for (std::size_t i = 0; i < 60; ++i) redrawn.contours[3].points[i].x += 2 * std::sin(0.7 * static_cast<double>(i));
    EXPECT_NEAR(volume_ml(redrawn), once, 0.01 * once) << "again by hand, in the same plane";
}

TEST(DrawnOddly, ALineDrawnAgainIsSaidToBeOneOrAWall) {
    ContourSet middle = ball({-30, 0, 30}), last = middle, last_of_two = ball({0, 30});
    middle.contours.push_back(circle_at({0, 0, 0}, kRadius + 0.5));
    for (ContourSet* set : {&last, &last_of_two}) set->contours.push_back(circle_at({0, 0, 30}, 40.5));
    const Segmentation one = segmented(middle, 3, 40), wall = segmented(last_of_two, 3, 40);
    for (const ContourSet& set : {middle, last}) EXPECT_NEAR(volume_ml(set), volume_ml(ball({-30, 0, 30})), 5);
    EXPECT_TRUE(warns(one.report, "contours 4 and 2, 0.5 mm apart, were taken for one line that was drawn twice, and the"));
    ASSERT_EQ(one.report.near_lines.size(), 1u);
    EXPECT_TRUE(one.report.near_lines[0].is_one);
    EXPECT_EQ(one.report.contours, 3u);
    EXPECT_TRUE(warns(wall.report, "contour 2 became a hole, which leaves a wall of 0.5 mm within contour 3; where it is"));
    ASSERT_EQ(wall.report.near_lines.size(), 1u);
    EXPECT_FALSE(wall.report.near_lines[0].is_one);
    middle.contours[1].hole = true;
    EXPECT_TRUE(segmented(middle, 3, 40).report.near_lines.empty()) << "a wall that was meant";
    EXPECT_LT(volume_ml(middle), 0.9 * one.report.mask_volume_ml);
}

/// A star of `arms` arms, drawn by its corners alone.
Contour star_at(double z, double inner, double outer, int arms) {
    Contour contour{make_plane({0, 0, z}, {0, 0, 1}), {}, true, false};
    for (int i = 0; i < 2 * arms; ++i) {
        const double angle = std::numbers::pi * i / arms, radius = i % 2 == 0 ? outer : inner;
        contour.points.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    }
    return contour;
}

// Straight edges are part of the drawing: the surface has to follow them, not only their ends.
TEST(DrawnOddly, ThinArmsDrawnByTheirCornersStayWhole) {
    ContourSet set;
    set.contours = {star_at(0, 8, 30, 9), star_at(12, 8, 30, 9)};
    const Segmentation result = segmented(set, 1, 40);
    EXPECT_EQ(result.report.mask_components, 1);
    for (int arm = 0; arm < 9; ++arm)
        for (double r = 0; r < 24; r += 0.5) {
            const double angle = 2 * std::numbers::pi * arm / 9;
            EXPECT_GT(result.function.value({r * std::cos(angle), r * std::sin(angle), 0}), 0) << arm << ", " << r;
        }
    EXPECT_FALSE(warns(result.report, "between its points"));
}

TEST(DrawnOddly, WhereTheSurfaceLeavesALineOfFewPointsItIsSaid) {
    ContourSet bars;
    for (const double z : {0.0, 8.0, 16.0})
        bars.contours.push_back(
            {make_plane({0, 0, z}, {0, 0, 1}), {{-30, -2, z}, {30, -2, z}, {30, 2, z}, {-30, 2, z}}, true, false});
    EXPECT_FALSE(warns(segmented(bars, 1, 10).report, "between its points"));
    SegmentOptions paper;
    paper.normals = Normals::in_plane;  // which leaves the edges' ends to themselves
    EXPECT_TRUE(warns(segmented(bars, 1, 10, paper).report, "between its points"));
}

TEST(DrawnOddly, WhatIsThinnerThanAVoxelIsSaid) {
    ContourSet needle;
    for (double z = 0; z < 50; z += 5) needle.contours.push_back(circle_at({0, 0, z}, 0.4));
    EXPECT_TRUE(warns(segmented(needle, 1, 10).report, "10 of 10 contours enclose less than a voxel"));
    EXPECT_FALSE(warns(segmented(needle, 0.3, 5).report, "less than a voxel"));
}

TEST(DrawnOddly, AnOrganAndItsCopyFarAwayAreEachAsAlone) {
    const PhantomCase kidney = phantom_case("kidney_radial6");
    const Segmentation alone = segment(kidney.contours, kidney.grid);
    const double size = bounding_box(kidney.contours).diagonal();
    for (const double sizes : {3.0, 12.0}) {
        ContourSet both = kidney.contours;
        for (Contour copy : kidney.contours.contours) {
            copy.plane.origin.x += sizes * size;
            for (Vec3& p : copy.points) p.x += sizes * size;
            both.contours.push_back(std::move(copy));
        }
        EXPECT_GT(compare(segment(both, kidney.grid).mask, alone.mask).dice, 0.998) << sizes << " sizes away";
    }
}

TEST(DrawnOddly, LinesWithinTheObjectAreNoResidual) {
    ContourSet set;
    for (double z = 0; z < 22; z += 3)
        for (const double x : {0.0, 12.0}) set.contours.push_back(circle_at({x, 0, z}, 10));
    const SegmentReport report = segmented(set, 1, 10).report;
    EXPECT_LT(report.residual.max_mm, 0.1) << "8 mm of each circle lie within the other one";
    EXPECT_FALSE(warns(report, "leaves contour"));
}

TEST(DrawnOddly, AFigureOfEightIsAsWideAsItsLobes) {
    ContourSet set;
    for (double z = 0; z < 10; z += 3) {
        Contour& line = set.contours.emplace_back(circle_at({0, 0, z}, 10));
        for (int i = 0; i < 60; ++i) {
            const double t = 2 * std::numbers::pi * (i + 0.5) / 60;
            line.points[static_cast<std::size_t>(i)] = {20 * std::sin(t), 10 * std::sin(2 * t), z};
        }
    }
    EXPECT_FALSE(warns(segmented(set, 1, 10).report, "less than a voxel"));
}

TEST(DrawnOddly, SmallContoursFarFromEachOtherAreFollowedAsIfDrawnAlone) {
    const auto balls = [](double apart) {
        ContourSet set;
        for (const double x : {0.0, apart})
            for (const Vec3& normal : {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}})
                set.contours.push_back(circle_at({x, 0, 0}, 1.5, 24, normal));
        return set;
    };
    const Grid grid = grid_around({{-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}}, {0.25, 0.25, 0.25}, 1);
    const double alone_ml = segment(balls(10), grid).report.mask_volume_ml;
    for (const double apart : {100.0, 300.0, 1000.0, 3000.0}) {
        const SegmentReport report = segment(balls(apart), grid).report;
        EXPECT_NEAR(report.mask_volume_ml, alone_ml, 0.03 * alone_ml) << apart << " mm apart";
        EXPECT_LT(report.residual.max_mm, 0.03) << apart << " mm apart";
        EXPECT_FALSE(warns(report, "lie in one plane")) << apart << " mm apart";
    }
    ContourSet stray = ball({-30, 0, 30});
    stray.contours.push_back(circle_at({50'000, 0, 0}, 4, 24));
    const Grid image = grid_around({{-50, -50, -50}, {50, 50, 50}}, {4, 4, 4}, 10);
    EXPECT_TRUE(warns(segment(stray, image).report,
                      fmt::format("contour {} is 49946 mm from any other; see that no contour", stray.contours.size())));
    stray.contours.pop_back();
    EXPECT_FALSE(warns(segment(stray, image).report, "from any other"));
}

TEST(DrawnOddly, WhatMissesAllContoursIsFoundOnEveryGrid) {
    // Two circles round one centre, of which the axial one is far too large for the coronal one: the surface passes between.
    for (const double radius : {4.0, 6.0, 8.0}) {
        ContourSet set;
        set.contours = {circle_at({}, 40), circle_at({}, radius, 60, {0, 1, 0})};
        const Segmentation fine = segmented(set, 1, 10);
        EXPECT_TRUE(warns(fine.report, "contradict each other"));
        EXPECT_GT(fine.report.mask_volume_ml, 50);
        for (const double spacing : {1.5, 2.0, 3.0})
            EXPECT_NEAR(volume_ml(set, spacing, 10), fine.report.mask_volume_ml, 0.04 * fine.report.mask_volume_ml)
                << radius << " mm on voxels of " << spacing << " mm";
    }
}

TEST(DrawnOddly, TwoPlanesAtTheSamePlaceAreOneEnd) {
    const double once = volume_ml(ball({-30, 0, 30}));
    EXPECT_NEAR(volume_ml(ball({-30.5, -30, 0, 30, 30.5})), once, 0.03 * once);
    const Segmentation pair = segmented(ball({0, 0.8}), 3, 80);
    EXPECT_NEAR(pair.report.mask_volume_ml, volume_ml(ball({0}), 3, 80), 0.05 * once);
    EXPECT_TRUE(warns(pair.report, "the thickness of the object there is a guess from its width"));
    EXPECT_FALSE(warns(segmented(ball({-30.5, -30, 0, 30, 30.5}), 3, 80).report, "is a guess"));
}

// Neighbouring slices of a scanner may be 2 % of the object's width apart. Two or three of them hardly tell how far it goes
// on, and a warning says so; with each slice more their distance is believed more.
TEST(DrawnOddly, NeighbouringSlicesEndTheSoonerTheMoreTheyAre) {
    double last_height = kRadius;
    for (const std::vector<double>& heights : {std::vector<double>{-1, 1},
                                               {-2, 0, 2},
                                               {-4, -2, 0, 2, 4},
                                               {-6, -4, -2, 0, 2, 4, 6},
                                               {-10, -8, -6, -4, -2, 0, 2, 4, 6, 8, 10}}) {
        const ContourSet set = ball(heights);
        const Segmentation result = segment(set, grid_around(bounding_box(set), {2, 2, 1}, 2 * kRadius));
        EXPECT_EQ(warns(result.report, "is a guess from its width"), heights.size() <= 3);
        EXPECT_EQ(result.report.mask_components, 1);
        double height = 0;
        while (result.function.value({0, 0, heights.back() + height}) > 0) height += 0.1;
        EXPECT_LE(height, last_height) << heights.size();
        EXPECT_GT(height, heights.size() <= 3 ? 0.5 * kRadius : 1.5) << heights.size();
        last_height = height;
        for (double x = 0; x < 0.95 * kRadius; x += 2)
            for (const double z : heights) EXPECT_GT(result.function.value({x, 0, z}), 0) << "a hole: " << x << ", " << z;
    }
}

TEST(DrawnOddly, APlaneNeedNotShowAllParts) {
    ContourSet one_more;
    add_kidney(one_more, 0, {-40, -20, 0, 20, 40});
    add_kidney(one_more, 120, {-40, -20, 0, 10, 20, 40});
    const Segmentation both = segmented(one_more, 3, 40);
    EXPECT_EQ(both.report.mask_components, 2);
    EXPECT_NEAR(both.report.mask_volume_ml, 790, 10);

    ContourSet in_turns;
    for (double z = -48; z <= 48; z += 4) {
        add_kidney(in_turns, 0, {z});
        add_kidney(in_turns, 120, {z + 2});
    }
    const Segmentation turns = segmented(in_turns, 3, 40);
    EXPECT_EQ(turns.report.mask_components, 2);
    EXPECT_GT(turns.report.mask_volume_ml, 750);
}

TEST(DrawnOddly, BetweenTwoTeethOfACombNothingGrows) {
    const auto rectangle = [](double z, double far) {
        Contour contour;
        contour.plane = make_plane({0, 0, z}, {0, 0, 1});
        contour.points = {{0, 0, z}, {far, 0, z}, {far, 20, z}, {0, 20, z}};
        return contour;
    };
    ContourSet comb;
    for (const double z : {-10.0, 0.0, 10.0}) comb.contours.push_back(rectangle(z, z == 0 ? 15 : 60));
    const Segmentation result = segmented(comb, 2, 20);
    for (const double x : {22.0, 30.0, 40.0, 50.0}) {
        EXPECT_LT(result.function.value({x, 10, 0}), 0) << x;
        EXPECT_GT(result.function.value({x, 10, 10}), 0) << x;
    }
    EXPECT_LT(result.report.section_check.largest_wrong_share(), 0.02);
}

TEST(DrawnOddly, RingsThatAPlaneBetweenThemDoesNotShowAreTwoObjects) {
    ContourSet set;
    for (double z = -20; z <= 20; z += 10) set.contours.push_back(circle_at({0, 0, z}, 20));
    for (const double z : {-20.0, 20.0}) set.contours.push_back(circle_at({35, 0, z}, 6));
    const Segmentation result = segmented(set, 2, 20);
    EXPECT_TRUE(sentences(result.report.section_check).empty()) << sentences(result.report.section_check).front();
    EXPECT_LT(result.function.value({35, 0, 0}), 0);
}

TEST(DrawnOddly, ASpeckFarAheadLeadsNoEndOn) {
    for (const auto& [radius, gap] : {std::pair(12.0, 5.0), {15.0, 3.0}, {20.0, 6.0}}) {
        ContourSet set;
        for (int i = 0; i < 4; ++i) set.contours.push_back(circle_at({0, 0, i * gap}, radius));
        const double alone = volume_ml(set, 1, 50);
        set.contours.push_back(circle_at({0, 0, 3 * gap + 35}, 2, 16));
        EXPECT_LT(volume_ml(set, 1, 50), 1.25 * alone) << radius << " mm, " << gap << " mm apart";
    }
}

TEST(DrawnOddly, AnArchIsNotCutByItsOwnPlanes) {
    ContourSet arch;
    for (int i = 0; i < 9; ++i) {
        const double angle = 1.2 * std::numbers::pi * i / 8;
        const Vec3 out{std::cos(angle), 0, std::sin(angle)};
        arch.contours.push_back(circle_at(40 * out, 12, 40, cross(out, {0, 1, 0})));
    }
    const Segmentation result = segmented(arch, 2, 40);
    EXPECT_EQ(result.report.mask_components, 1);
    EXPECT_NEAR(result.report.mask_volume_ml, std::numbers::pi * 144 * 40 * 1.2 * std::numbers::pi / 1000, 15);
}

TEST(DrawnOddly, ThinAndScatteredSectionsEnd) {
    ContourSet cup;
    for (int i = 0; i < 5; ++i)
        for (const double radius : {40.0, 32.0}) cup.contours.push_back(circle_at({0, 0, 10.0 * i}, radius - 3 * i));
    ContourSet tubes;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            for (const double z : {0.0, 10.0, 20.0}) tubes.contours.push_back(circle_at({60.0 * i, 60.0 * j, z}, 15, 30));
    for (const auto& [set, least, most] : {std::tuple{cup, 55.0, 95.0}, {tubes, 226.0, 440.0}}) {
        const Segmentation result = segmented(set, 3, 80);
        EXPECT_FALSE(warns(result.report, "border"));
        EXPECT_GT(result.report.mask_volume_ml, least);
        EXPECT_LT(result.report.mask_volume_ml, most);
    }
}

TEST(DrawnOddly, ThePlanesOriginsMeanNothing) {
    const auto stack = [](double aside) {
        ContourSet set;
        double tilt = 0.03;
        for (const double z : {-30.0, -15.0, 0.0, 15.0, 30.0}) {
            const Vec3 normal = normalized({0, tilt, 1});
            Contour contour = circle_at(z * normal, std::sqrt(kRadius * kRadius - z * z), 60, normal);
            contour.plane.origin += aside * contour.plane.v;
            set.contours.push_back(contour);
            tilt = -tilt;
        }
        return set;
    };
    const Segmentation here = segmented(stack(0), 3, 40), there = segmented(stack(300), 3, 40);
    EXPECT_NEAR(here.report.mask_volume_ml, 505, 15);
    EXPECT_EQ(here.mask.values, there.mask.values);
}

TEST(DrawnOddly, HolesAreFoundInPlanesFittedToRoundedPoints) {
    const Vec3 axis = normalized({0.5, -0.4, 0.8});
    ContourSet tube;
    for (int i = 0; i < 5; ++i)
        for (const double radius : {12.0, 8.0}) {
            Contour contour = circle_at(6.0 * i * axis, radius, 24, axis);
            for (Vec3& p : contour.points)
                for (int c = 0; c < 3; ++c) p[c] = std::round(100 * p[c]) / 100;
            contour.plane = *fit_plane(contour.points);
            tube.contours.push_back(contour);
        }
    const Segmentation result = segmented(tube, 1, 10);
    EXPECT_TRUE(warns(result.report, "5 contours inside others became holes"));
    EXPECT_EQ(result.report.mask_components, 1);
    EXPECT_NEAR(result.report.mask_volume_ml, 7.4, 0.5);
}

TEST(DrawnOddly, VeryManySmallContoursShareTheirPoints) {
    ContourSet many;
    for (int n = 0; n < 200; ++n) many.contours.push_back(circle_at({20.0 * (n % 20), 20.0 * (n / 20), 0}, 5, 4));
    EXPECT_LT(segmented(many, 5, 10).report.centres, 200 * (2 * 24 + 2 * (6 + 4) + 5))
        << "48 segments each would be twice as many; 5 for leak probes";
}

TEST(DrawnOddly, AClickOutsideMakesACavityAndOneFarAsideIsReported) {
    ContourSet hollow = ball({-30, 0, 30});
    hollow.exterior = {{0, 0, 15}};
    const Mask mask = segmented(hollow, 3, 20).mask;
    const Vec3 at = mask.grid.index_to_mm.inverse().apply({0, 0, 15});
    EXPECT_EQ(mask.values[mask.grid.offset(std::lround(at.x), std::lround(at.y), std::lround(at.z))], 0);

    ContourSet aside = ball({-30, 0, 30});
    aside.interior = {{120, 0, 0}};
    EXPECT_TRUE(warns(segmented(aside, 3, 100).report, "interior point 1 is not in the mask"));
    aside.interior = {{51, 0, 0}};
    EXPECT_FALSE(warns(segmented(aside, 3, 20).report, "is not in the mask"));
}

TEST(DrawnOddly, CornersAreThoseThatWereDrawn) {
    SegmentOptions options;
    options.quality = 0.1;
    const double rounded = volume_ml(ball({-30, 0, 30}), 3, 20, options);
    options.corners = Corners::faithful;
    EXPECT_NEAR(volume_ml(ball({-30, 0, 30}), 3, 20, options), rounded, 0.01 * rounded);
}

/// More points than the surface's tilts are found from: circles of a ball of radius 40, 4 mm apart.
ContourSet many_circles() {
    ContourSet set;
    for (int z = -36; z <= 36; z += 4) set.contours.push_back(circle_at({0, 0, double(z)}, std::sqrt(1600.0 - z * z), 64));
    return set;
}

TEST(DrawnOddly, ManyPointsAndWhatElseCanBeDrawn) {
    const double ball_ml = 4.0 / 3 * std::numbers::pi * 64;
    EXPECT_NEAR(volume_ml(many_circles()), ball_ml, 0.02 * ball_ml);

    ContourSet top = many_circles();
    top.surface = {{{0, 0, 40}}};
    EXPECT_NEAR(volume_ml(top), ball_ml, 0.02 * ball_ml) << "a surface point, which belongs to no contour";

    for (const std::size_t which : {std::size_t{0}, std::size_t{18}})
        for (const ContourEnd end : {ContourEnd::flat, ContourEnd::round}) {
            ContourSet ended = many_circles();
            ended.contours[which].end = end;
            EXPECT_NEAR(volume_ml(ended), ball_ml, 0.02 * ball_ml) << which << ' ' << name(end);
        }

    for (const bool first : {true, false}) {
        Contour open = circle_at({0, 0, first ? -38.0 : 38.0}, 12.49, 64);
        open.points.resize(50);
        open.closed = false;
        open.inside = Hand::left;
        ContourSet set = many_circles();
        set.contours.insert(first ? set.contours.begin() : set.contours.end(), open);
        EXPECT_NEAR(volume_ml(set), ball_ml, 0.02 * ball_ml) << first;
    }
}

}  // namespace
}  // namespace kontur
