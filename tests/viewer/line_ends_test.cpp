// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "kontur/base/geometry.h"
#include "kontur/shape/predicates.h"
#include "support/expect_error.h"
#include "viewer/drawn_contours.h"
#include "viewer/edits/contour_edits.h"

// Open lines: what edits do to them, and how contours are opened and lines are closed.

namespace kontur::viewer {
namespace {

using test::circle;
using test::circle_of;
using test::freehand_circle;
using test::kPlane;

constexpr SketchOptions kNoSnap{.snap = false};

std::vector<Vec3> on_plane(const std::vector<Point2>& places) {
    std::vector<Vec3> points;
    for (const Point2& place : places) points.push_back(kPlane.from_uv(place[0], place[1]));
    return points;
}

/// An open line through places on the plane, as a hand draws it.
DrawnContour hand_line(const std::vector<Point2>& places) {
    DrawnContour line = as_drawn({.plane = kPlane, .points = on_plane(places), .closed = false});
    line.id = 7;
    line.structure = 3;
    line.inside = Hand::right;
    return line;
}

std::vector<SketchPoint> through(const std::vector<Point2>& places) {
    std::vector<SketchPoint> sketch;
    for (const Vec3& at : on_plane(places)) sketch.push_back({at, Stretch::line, {}});
    return sketch;
}

bool has(const std::vector<Vec3>& points, const Vec3& p) { return std::ranges::find(points, p) != points.end(); }

void expect_sound(const DrawnContour& line, const DrawnContour& before) {
    EXPECT_EQ(line.id, before.id);
    EXPECT_EQ(line.structure, before.structure);
    EXPECT_FALSE(line.closed);
    EXPECT_EQ(line.inside, before.inside);
    ASSERT_GE(line.control.size(), 2u);
    EXPECT_EQ(line.control.front().index, 0u);
    EXPECT_EQ(line.control.back().index, line.points.size() - 1);
    for (const ControlPoint& point : line.control) EXPECT_EQ(line.points.at(point.index), point.at);
}

class LineEnds : public testing::Test {
protected:
    SliceEdges edges{test::flat_image()};
    const DrawnContour round = circle_of(8, Stretch::spline, edges);
    const DrawnContour straight = hand_line({{0, 0}, {2, 0}, {4, 0}, {6, 0}, {8, 0}});
    /// Three quarters of a circle by a curve through eight points.
    const DrawnContour arc = opened(circle_of(8, Stretch::spline, edges), kPlane.from_uv(9, -4), edges);
};

TEST_F(LineEnds, ASketchDrawsAnOpenLineAgain) {
    for (const DrawnContour& line : {straight, arc}) {
        SketchOptions options = kNoSnap;
        options.closed = false;
        const DrawnContour again = draw_contour(sketch_of(line), kPlane, edges, options);
        EXPECT_TRUE(again.control == line.control);
        EXPECT_TRUE(again.points == line.points);
        EXPECT_FALSE(again.closed);
    }
}

TEST_F(LineEnds, AnOpenLineNeedsTwoPoints) {
    const SketchOptions open{.closed = false, .snap = false};
    EXPECT_EQ(draw_contour(through({{0, 0}, {5, 0}}), kPlane, edges, open).points.size(), 2u) << "a straight one will do";
    EXPECT_KONTUR_ERROR(draw_contour(through({{0, 0}}), kPlane, edges, open), ErrorKind::invalid_input,
                        "at least two points");
}

TEST_F(LineEnds, AContourIsOpenedAtTheStretchThatIsPointedAt) {
    ASSERT_FALSE(arc.closed);
    EXPECT_EQ(arc.control.size(), 8u);
    EXPECT_EQ(arc.control.front().at, circle(8)[0]) << "between the last point and the first one";
    EXPECT_EQ(arc.points.back(), circle(8)[7]);
    EXPECT_EQ(arc.points.size(), round.control.back().index + 1) << "the rest stays as it was";
    const DrawnContour top = opened(round, kPlane.from_uv(4, 9), edges);
    EXPECT_EQ(top.points.front(), circle(8)[2]);
    EXPECT_EQ(top.points.back(), circle(8)[1]);
    const DrawnContour last = opened(round, {}, edges);
    EXPECT_EQ(last.points.back(), circle(8)[7]) << "without a place: where it was closed";
}

TEST_F(LineEnds, AHandsContourIsOpenedAtAnEdgeAndHasEndsThen) {
    const DrawnContour free = freehand_circle(60);
    const DrawnContour open = opened(free, kPlane.from_uv(0, 10), edges);
    EXPECT_FALSE(open.closed);
    ASSERT_EQ(open.control.size(), 2u);
    EXPECT_LT(distance(open.control[0].at, kPlane.from_uv(0, 10)), 1.1);
    EXPECT_LT(distance(open.control[1].at, kPlane.from_uv(0, 10)), 1.1);
    EXPECT_EQ(open.points.size(), 60u);
    EXPECT_EQ(opened(free, {}, edges).points.front(), free.points.front());
}

TEST_F(LineEnds, AHoleThatIsOpenedIsNoneAnyMore) {
    DrawnContour hole = round;
    hole.hole = true;
    EXPECT_FALSE(opened(hole, {}, edges).hole);
}

TEST_F(LineEnds, ClosingMakesTheContourThatWasOpened) {
    const DrawnContour ring = closed(arc, edges);
    EXPECT_TRUE(ring.closed);
    EXPECT_TRUE(ring.control == round.control);
    ASSERT_EQ(ring.points.size(), round.points.size());
    for (std::size_t i = 0; i < ring.points.size(); ++i) EXPECT_LT(distance(ring.points[i], round.points[i]), 1e-9);
    DrawnContour told = arc;
    told.inside = Hand::left;
    EXPECT_FALSE(closed(told, edges).inside);
    EXPECT_KONTUR_ERROR(closed(straight, edges), ErrorKind::invalid_input, "do not lie on one line");
}

TEST_F(LineEnds, AnEndThatIsMovedTakesTheLineWithItAndLeavesTheOtherEnd) {
    const DrawnContour hand = move_point(straight, 1, kPlane.from_uv(9, 3), edges, kNoSnap);
    expect_sound(hand, straight);
    EXPECT_LT(distance(hand.points.back(), kPlane.from_uv(9, 3)), 1e-9);
    EXPECT_EQ(hand.points.front(), straight.points.front());
    const DrawnContour curve = move_point(arc, 0, kPlane.from_uv(13, 2), edges, kNoSnap);
    expect_sound(curve, arc);
    EXPECT_EQ(curve.points.front(), kPlane.from_uv(13, 2));
    EXPECT_EQ(curve.points.back(), arc.points.back());
    EXPECT_EQ(curve.points[curve.points.size() - 2], arc.points[arc.points.size() - 2]) << "no neighbour across the gap";
}

TEST_F(LineEnds, APullDoesNotReachAcrossTheGap) {
    const DrawnContour almost = opened(freehand_circle(60), kPlane.from_uv(10, -0.5), edges);
    const DrawnContour pulled = pull(almost, almost.points.front(), almost.points.front() + Vec3{3, 0, 0}, {}, edges);
    EXPECT_EQ(pulled.points.back(), almost.points.back());
    EXPECT_LT(distance(pulled.points.front(), almost.points.front() + Vec3{3, 0, 0}), 1e-9);
}

TEST_F(LineEnds, WithoutItsLastPointALineEndsAtTheOneBefore) {
    const DrawnContour shorter = delete_point(arc, 7, edges);
    expect_sound(shorter, arc);
    EXPECT_EQ(shorter.points.back(), circle(8)[6]);
    EXPECT_EQ(delete_point(arc, 0, edges).points.front(), circle(8)[1]);
    EXPECT_EQ(delete_point(arc, 3, edges).control.size(), 7u);
    DrawnContour cut = insert_point(straight, kPlane.from_uv(4, 0), edges);
    expect_sound(cut, straight);
    cut = delete_point(cut, 2, edges);
    EXPECT_EQ(cut.points.back(), kPlane.from_uv(4, 0));
    EXPECT_KONTUR_ERROR(delete_point(cut, 0, edges), ErrorKind::invalid_input, "2 control points, which it needs");
}

TEST_F(LineEnds, AStrokeFromNearAnEndLeadsTheLineOn) {
    for (const bool forwards : {true, false}) {
        DrawnContour line = straight;
        if (!forwards) line = hand_line({{8, 0}, {6, 0}, {4, 0}, {2, 0}, {0, 0}});
        const DrawnContour longer = redraw(line, on_plane({{6, 0}, {8, 1}, {10, 2}, {12, 5}}), edges);
        expect_sound(longer, line);
        const Vec3 end = forwards ? longer.points.back() : longer.points.front();
        const Vec3 start = forwards ? longer.points.front() : longer.points.back();
        EXPECT_LT(distance(end, kPlane.from_uv(12, 5)), 1e-9);
        EXPECT_EQ(start, kPlane.from_uv(0, 0));
        EXPECT_FALSE(has(longer.points, kPlane.from_uv(8, 0)));
    }
}

TEST_F(LineEnds, AStrokeFromTheLineToTheLineReplacesWhatIsBetween) {
    const DrawnContour bent = redraw(straight, on_plane({{6, 0}, {4, 2}, {2, 0}}), edges);
    expect_sound(bent, straight);
    EXPECT_EQ(bent.points.front(), straight.points.front());
    EXPECT_EQ(bent.points.back(), straight.points.back());
    EXPECT_TRUE(has(bent.points, kPlane.from_uv(4, 2)));
    EXPECT_FALSE(has(bent.points, kPlane.from_uv(4, 0)));
}

TEST_F(LineEnds, AShortStrokeFromEndToEndClosesTheLineAndALongOneIsTheLine) {
    const std::vector<Vec3> gap{arc.points.front(), kPlane.from_uv(9, -3), arc.points.back()};
    for (const bool forwards : {true, false}) {
        const DrawnContour ring = redraw(arc, forwards ? std::vector<Vec3>(gap.rbegin(), gap.rend()) : gap, edges);
        EXPECT_TRUE(ring.closed);
        EXPECT_TRUE(has(ring.points, gap[1]));
        EXPECT_TRUE(has(ring.points, circle(8)[4]));
    }
    const DrawnContour other = redraw(straight, on_plane({{0, 0}, {4, 3}, {8, 0}}), edges);
    expect_sound(other, straight);
    EXPECT_TRUE(has(other.points, kPlane.from_uv(4, 3)));
    EXPECT_FALSE(has(other.points, kPlane.from_uv(4, 0)));
}

TEST_F(LineEnds, TheEdgeThatIsNotDrawnCrossesNothing) {
    const std::vector<Point2> four{
        {-4, -3}, {4, 3}, {-4, 3}, {4, -3}};  // the edge from the last one back crosses nothing drawn
    const std::vector<Point2> eight{{-4, -3}, {4, -3}, {-4, 3}, {4, 3}};  // that from the last one back crosses one
    EXPECT_EQ(self_crossings(hand_line(four)).size(), 1u);
    EXPECT_TRUE(self_crossings(hand_line(eight)).empty());
    DrawnContour ring = hand_line(eight);
    ring.closed = true;
    EXPECT_EQ(self_crossings(ring).size(), 1u);
}

TEST_F(LineEnds, ACopyAndAMoveStayOpen) {
    expect_sound(translate(straight, {1, 2, 3}), straight);
    expect_sound(offset(straight, 4), straight);
}

TEST_F(LineEnds, AKindIsThatOfTheStretchesThereAre) {
    DrawnContour line = insert_point(straight, kPlane.from_uv(4, 0), edges);
    line.control.back().kind = Stretch::wire;
    EXPECT_EQ(kind_name(line), "freehand");
}

}  // namespace
}  // namespace kontur::viewer
