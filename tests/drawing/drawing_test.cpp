// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/drawing.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kontur/shape/repeated_contours.h"
#include "support/contour_sets.h"
#include "support/expect_error.h"
#include "support/polygons.h"

namespace kontur {
namespace {

const Plane kPlane = make_plane({30, -20, 100}, {0.3, -0.5, 0.8});
const Plane kNext = make_plane(kPlane.origin + 5.0 * kPlane.normal, kPlane.normal);

Contour polygon(const Plane& plane, const std::vector<test::Point2>& points) { return test::contour_in(plane, points); }

const Contour kSquare = polygon(kPlane, {{0, 0}, {10, 0}, {10, 10}, {0, 10}});
const Contour kLine = polygon(kNext, {{0, 0}, {4, 0}, {9, 0}, {6, 0}});
const Contour kWayBack = polygon(kNext, {{0, 0}, {5, 1}, {9, 7}, {5, 1}});

Drawing drawing_of(const std::vector<Contour>& contours) {
    ContourSet set;
    set.contours = contours;
    return Drawing(set);
}

TEST(Drawing, LeavesOutContoursThatEncloseNothingAndSaysSo) {
    for (const Contour& nothing : {kLine, kWayBack}) {
        const Drawing drawing = drawing_of({nothing, kSquare});
        ASSERT_EQ(drawing.contours.contours.size(), 1u);
        ASSERT_EQ(drawing.tidied.contours.size(), 1u);
        EXPECT_EQ(drawing.contours.contours[0].points, kSquare.points);
        ASSERT_EQ(drawing.notes.size(), 1u);
        EXPECT_NE(drawing.notes[0].find("left out"), std::string::npos) << drawing.notes[0];
    }
    EXPECT_TRUE(drawing_of({kLine, kSquare}).notes[0].starts_with("contour 1 has no area: its 4 points lie within"));
}

// Its plane would say that the object is nowhere else in it.
TEST(Drawing, LeavesOutContoursAsSmallAsASlipOfTheHandAndSaysSo) {
    const Contour speck = polygon(kNext, {{4, 4}, {4.002, 4}, {4.002, 4.002}, {4, 4.002}});
    const Contour small = polygon(kNext, {{4, 4}, {4.03, 4}, {4.03, 4.03}, {4, 4.03}});
    const Drawing one = drawing_of({kSquare, speck});
    ASSERT_EQ(one.contours.contours.size(), 1u);
    ASSERT_EQ(one.notes.size(), 1u);
    EXPECT_EQ(one.notes[0], "contour 2 is 0.0028 mm across and was left out");
    const Drawing two = drawing_of({speck, kSquare, speck});
    ASSERT_EQ(two.contours.contours.size(), 1u);
    EXPECT_EQ(two.contours.contours[0].points, kSquare.points);
    EXPECT_EQ(drawing_of({kSquare, small}).contours.contours.size(), 2u);
    EXPECT_EQ(drawing_of({speck}).contours.contours.size(), 1u) << "nothing else was drawn";
}

TEST(Drawing, ContoursOfVeryManyPointsAreThinnedForAllThatIsAskedOfThem) {
    const Contour vast = test::circle(kNext, 3, 20000), many = test::circle(kPlane, 3, 3000);
    const Drawing drawing = drawing_of({kSquare, kLine, vast, many});
    ASSERT_EQ(drawing.contours.contours.size(), 3u);
    EXPECT_EQ(drawing.numbers, (std::vector<std::size_t>{0, 2, 3}));
    EXPECT_LT(drawing.contours.contours[1].points.size(), 1000u);
    EXPECT_EQ(drawing.contours.contours[2].points, many.points) << "few enough";
    EXPECT_EQ(drawing.points_drawn, kSquare.points.size() + 23000);
    for (const Vec3& p : drawing.contours.contours[1].points)
        EXPECT_TRUE(std::ranges::count(vast.points, p)) << "of those that were drawn";
    const auto said = [&](const std::string& note) { return note.find("with very many points") != std::string::npos; };
    EXPECT_EQ(std::ranges::count_if(drawing.notes, said), 1);
}

TEST(Drawing, AContourDrawnTwiceCountsOnce) {
    const Contour across =
        polygon(make_plane(kPlane.origin + 5.0 * kPlane.u + 4.0 * kPlane.v, kPlane.u), {{-3, -4}, {3, -4}, {3, 4}, {-3, 4}});
    const Drawing once = drawing_of({kSquare, across});
    ASSERT_FALSE(once.crossings.empty());
    Contour again = kSquare;
    std::reverse(again.points.begin(), again.points.end());
    std::rotate(again.points.begin(), again.points.begin() + 1, again.points.end());
    again.points.push_back(again.points.back());
    const Drawing twice = drawing_of({kSquare, across, again, kSquare});
    EXPECT_EQ(twice.contours.contours.size(), 2u);
    ASSERT_EQ(twice.crossings.size(), once.crossings.size());
    for (std::size_t n = 0; n < once.crossings.size(); ++n) EXPECT_EQ(twice.crossings[n].matched, once.crossings[n].matched);
    EXPECT_EQ(twice.notes.back(), "2 contours that repeat others were left out, the first of them contour 3");
    EXPECT_EQ(drawing_of({kSquare, across, kSquare}).notes.back(), "contour 3 repeats one before it and was left out");
}

TEST(Drawing, WhatDiffersIsNoRepetitionHoweverSmallAndFarAwayItIs) {
    for (const double scale : {1e-6, 1.0, 1e6}) {
        std::vector<Contour> contours;
        for (const double size : {10.0, 9.99})
            for (const double place : {0.0, 0.01}) {
                Contour& contour =
                    contours.emplace_back(polygon(make_plane(kPlane.origin + place * kPlane.normal, kPlane.normal),
                                                  {{0, 0}, {size, 0}, {size, size}, {0, size}}));
                contour.plane.origin = scale * (contour.plane.origin + Vec3{1e6, 0, 0});
                for (Vec3& p : contour.points) p = scale * (p + Vec3{1e6, 0, 0});
            }
        ContourSet set{"", contours, {}, {}};
        EXPECT_TRUE(leave_out_repetitions(set).empty()) << scale;
        EXPECT_EQ(set.contours.size(), 4u) << scale;
    }
}

TEST(Drawing, RefusesToLeaveOutAll) {
    EXPECT_KONTUR_ERROR(drawing_of({kLine}), ErrorKind::invalid_input, "contour 1 has no area");
    EXPECT_KONTUR_ERROR(drawing_of({kWayBack}), ErrorKind::invalid_input, "contour 1 is nothing but a path back");
    Contour hole = kSquare;
    hole.hole = true;
    EXPECT_KONTUR_ERROR(drawing_of({kLine, hole}), ErrorKind::invalid_input, "contour 1 has no area");
}

}  // namespace
}  // namespace kontur
