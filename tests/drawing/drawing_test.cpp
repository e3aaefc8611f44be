// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/drawing.h"

#include <gtest/gtest.h>

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

TEST(Drawing, RefusesToLeaveOutAll) {
    EXPECT_KONTUR_ERROR(drawing_of({kLine}), ErrorKind::invalid_input, "contour 1 has no area");
    EXPECT_KONTUR_ERROR(drawing_of({kWayBack}), ErrorKind::invalid_input, "contour 1 is nothing but a path back");
    Contour hole = kSquare;
    hole.hole = true;
    EXPECT_KONTUR_ERROR(drawing_of({kLine, hole}), ErrorKind::invalid_input, "contour 1 has no area");
}

}  // namespace
}  // namespace kontur
