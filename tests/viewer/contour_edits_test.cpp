// SPDX-License-Identifier: Apache-2.0
#include "viewer/edits/contour_edits.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/expect_error.h"
#include "viewer/drawn_contours.h"
#include "viewer/edits/contour_lines.h"

namespace kontur::viewer {
namespace {

using test::circle;
using test::circle_of;
using test::freehand_circle;
using test::kPlane;

constexpr SketchOptions kNoSnap{.closed = true, .snap = false, .snap_radius_mm = 3, .spline_step_mm = 1};

/// What every edit must leave behind.
void expect_sound(const DrawnContour& contour, const DrawnContour& before) {
    EXPECT_EQ(contour.id, before.id);
    EXPECT_EQ(contour.structure, before.structure);
    ASSERT_FALSE(contour.control.empty());
    EXPECT_EQ(contour.control.front().index, 0u);
    for (std::size_t i = 0; i < contour.control.size(); ++i) {
        EXPECT_EQ(contour.points.at(contour.control[i].index), contour.control[i].at);
        EXPECT_TRUE(i == 0 || contour.control[i - 1].index < contour.control[i].index);
    }
    for (std::size_t i = 0; i < contour.points.size(); ++i) {
        EXPECT_LT(std::abs(contour.plane.distance_to(contour.points[i])), 1e-9);
        EXPECT_GT(distance(contour.points[i], contour.points[(i + 1) % contour.points.size()]), 1e-9);
    }
}

std::size_t unchanged(const DrawnContour& a, const DrawnContour& b) {
    return static_cast<std::size_t>(std::count_if(a.points.begin(), a.points.end(), [&](const Vec3& p) {
        return std::any_of(b.points.begin(), b.points.end(), [&](const Vec3& q) { return distance(p, q) < 1e-12; });
    }));
}

class ContourEdits : public testing::Test {
protected:
    SliceEdges edges{test::flat_image()};
    const DrawnContour round = circle_of(8, Stretch::spline, edges);
    const DrawnContour free = freehand_circle(60);
};

TEST_F(ContourEdits, ASketchDrawsItsContourAgain) {
    for (const DrawnContour& contour :
         {round, free, circle_of(5, Stretch::wire, edges), circle_of(5, Stretch::line, edges)}) {
        const DrawnContour again = draw_contour(sketch_of(contour), kPlane, edges, kNoSnap);
        EXPECT_TRUE(again.control == contour.control);
        EXPECT_TRUE(again.points == contour.points);
    }
}

TEST_F(ContourEdits, AMovedPointArrivesAndFarPointsStay) {
    const Vec3 to = kPlane.from_uv(14, 1);
    const DrawnContour moved = move_point(round, 0, to, edges, kNoSnap);
    expect_sound(moved, round);
    EXPECT_EQ(moved.control[0].at, to);
    EXPECT_EQ(moved.control.size(), 8u);
    // A point of a Catmull-Rom curve bends two stretches on either side: half of this circle.
    EXPECT_GE(unchanged(round, moved), round.points.size() / 3);
    EXPECT_LT(unchanged(round, moved), round.points.size());
}

TEST_F(ContourEdits, AMovedPointLeavesThePlaneOutOfIt) {
    const DrawnContour moved = move_point(round, 2, kPlane.from_uv(0, 13) + Vec3{0, 0, 5}, edges, kNoSnap);
    expect_sound(moved, round);
}

TEST_F(ContourEdits, MovingTheOnlyPointOfAFreehandContourPullsIt) {
    const DrawnContour moved = move_point(free, 0, kPlane.from_uv(13, 0), edges, kNoSnap);
    expect_sound(moved, free);
    EXPECT_LT(distance(moved.control[0].at, kPlane.from_uv(13, 0)), 1e-9);
    EXPECT_GE(unchanged(free, moved), 40u);
}

TEST_F(ContourEdits, InsertingAndDeletingAPointComesBackToTheSamePoints) {
    const DrawnContour more = insert_point(round, kPlane.from_uv(9.3, 3.9), edges);
    expect_sound(more, round);
    ASSERT_EQ(more.control.size(), 9u);
    EXPECT_EQ(more.control[1].at, kPlane.from_uv(9.3, 3.9));
    const DrawnContour back = delete_point(more, 1, edges);
    expect_sound(back, round);
    EXPECT_TRUE(back.points == round.points);
}

TEST_F(ContourEdits, PointsOnAFreehandLineChangeNothingOfIt) {
    const DrawnContour more = insert_point(free, kPlane.from_uv(0, 10), edges);
    expect_sound(more, free);
    EXPECT_TRUE(more.points == free.points);
    EXPECT_EQ(more.control.size(), 2u);
    const DrawnContour back = delete_point(more, 1, edges);
    EXPECT_TRUE(back.points == free.points);
    EXPECT_TRUE(back.control == free.control);
}

TEST_F(ContourEdits, TheFirstPointCanBeDeletedToo) {
    const DrawnContour less = delete_point(round, 0, edges);
    expect_sound(less, round);
    EXPECT_EQ(less.control.size(), 7u);
    DrawnContour both = insert_point(free, kPlane.from_uv(0, 10), edges);
    const DrawnContour second = delete_point(both, 0, edges);
    expect_sound(second, both);
    EXPECT_EQ(second.control.size(), 1u);
    EXPECT_EQ(second.points.size(), free.points.size());
}

TEST_F(ContourEdits, TheLastPointsCannotBeDeleted) {
    const DrawnContour triangle = circle_of(3, Stretch::spline, edges);
    EXPECT_KONTUR_ERROR(delete_point(triangle, 0, edges), ErrorKind::invalid_input, "delete the contour instead");
    EXPECT_KONTUR_ERROR(delete_point(free, 0, edges), ErrorKind::invalid_input, "delete the contour instead");
    EXPECT_KONTUR_ERROR(delete_point(round, 8, edges), ErrorKind::invalid_input, "number 8 is none of them");
}

TEST_F(ContourEdits, APullBendsTheLineWithinItsRadiusOnly) {
    const DrawnContour bent = pull(free, kPlane.from_uv(10, 0), kPlane.from_uv(12, 0), 5.0, edges);
    expect_sound(bent, free);
    double farthest = 0;
    for (const Vec3& p : free.points) {
        const double moved = distance(bent.points[nearest_point(bent.points, p)], p);
        EXPECT_TRUE(distance(p, free.points[0]) <= 5 || moved < 1e-12);
    }
    for (const Vec3& p : bent.points) farthest = std::max(farthest, p.x);
    EXPECT_NEAR(farthest, free.points[0].x + 2, 1e-9);
}

TEST_F(ContourEdits, AStraightSideWithoutPointsIsPulledWhereItIsTaken) {
    const std::vector<Vec3> corners{kPlane.from_uv(0, -10), kPlane.from_uv(0, 10), kPlane.from_uv(-15, 0)};
    const DrawnContour triangle = as_drawn({kPlane, corners, true, false});
    const DrawnContour bent = pull(triangle, kPlane.from_uv(0, 1), kPlane.from_uv(3, 1), 5.0, edges);
    double farthest = 0;
    for (const Vec3& p : bent.points) farthest = std::max(farthest, (p - kPlane.origin).x);
    EXPECT_NEAR(farthest, 3, 1e-9);
    for (const Vec3& corner : corners) EXPECT_EQ(bent.points[nearest_point(bent.points, corner)], corner);
    EXPECT_KONTUR_ERROR(pull(free, {}, {}, 0.0, edges), ErrorKind::invalid_input, "radius");
}

TEST_F(ContourEdits, APulledSplineStretchBecomesFree) {
    const DrawnContour bent = pull(round, kPlane.from_uv(10, 0.1), kPlane.from_uv(11, 0.1), 3.0, edges);
    expect_sound(bent, round);
    EXPECT_EQ(kind_name(round), "spline");
    EXPECT_EQ(kind_name(bent), "mixed");
}

TEST_F(ContourEdits, ARedrawnPartReplacesTheShorterSide) {
    const std::vector<Vec3> path{kPlane.from_uv(7.1, 7.1), kPlane.from_uv(14, 0), kPlane.from_uv(7.1, -7.1)};
    for (const bool backward : {false, true}) {
        std::vector<Vec3> drawn = path;
        if (backward) std::reverse(drawn.begin(), drawn.end());
        for (const DrawnContour& contour : {free, round}) {
            const DrawnContour changed = redraw(contour, drawn, edges);
            expect_sound(changed, contour);
            double right = -100, left = 100;
            for (const Vec3& p : changed.points) right = std::max(right, p.x), left = std::min(left, p.x);
            EXPECT_NEAR(right, kPlane.from_uv(14, 0).x, 1e-9);
            EXPECT_NEAR(left, kPlane.from_uv(-10, 0).x, 1e-6);
        }
    }
    EXPECT_KONTUR_ERROR(redraw(free, {kPlane.from_uv(10, 0), kPlane.from_uv(10.01, 0)}, edges), ErrorKind::invalid_input,
                        "same place");
}

TEST_F(ContourEdits, AWholeLineIsReplacedByTheOneThatIsGiven) {
    std::vector<Vec3> square;
    for (const auto& [u, v] : {std::pair{-9., -9.}, {0., -9.}, {9., -9.}, {9., 9.}, {-9., 9.}})
        square.push_back(kPlane.from_uv(u, v));
    for (const DrawnContour& contour : {free, round}) {
        const DrawnContour changed = redraw_whole(contour, square, edges);
        expect_sound(changed, contour);
        EXPECT_EQ(kind_name(changed), "freehand");
        for (const Vec3& corner : square)
            EXPECT_LT(distance(changed.points[nearest_point(changed.points, corner)], corner), 0.11);
        for (const Vec3& p : changed.points) EXPECT_LT(distance(p, kPlane.origin), 13);
    }
    EXPECT_KONTUR_ERROR(redraw_whole(free, {square[0], square[1]}, edges), ErrorKind::invalid_input, "fewer than 3");
}

TEST_F(ContourEdits, TranslationStaysInThePlaneAndAnOffsetLeavesIt) {
    const DrawnContour moved = translate(round, {1, 2, 3});
    expect_sound(moved, round);
    EXPECT_EQ(moved.points[5], (round.points[5] + Vec3{1, 2, 0}));
    const DrawnContour copy = offset(round, -2.5);
    expect_sound(copy, round);
    EXPECT_EQ(copy.plane.origin, (kPlane.origin - Vec3{0, 0, 2.5}));
}

TEST_F(ContourEdits, WhatHasNoAreaIsNoContour) {
    const std::vector<SketchPoint> line{
        {{1, 1, 20}, Stretch::line, {}}, {{5, 1, 20}, Stretch::line, {}}, {{9, 1, 20}, Stretch::line, {}}};
    EXPECT_KONTUR_ERROR(draw_contour(line, kPlane, edges, kNoSnap), ErrorKind::invalid_input, "three points");
    const std::vector<SketchPoint> point(5, {{1, 1, 20}, Stretch::spline, {}});
    EXPECT_KONTUR_ERROR(draw_contour(point, kPlane, edges, kNoSnap), ErrorKind::invalid_input, "three points");
}

TEST(SelfCrossings, AreTheCrossingOfAFigureOfEightAndNoneOfACircleOrATouch) {
    const auto drawn = [](const std::vector<std::array<double, 2>>& corners) {
        DrawnContour contour = freehand_circle(20);
        contour.points.clear();
        for (const auto& [u, v] : corners) contour.points.push_back(kPlane.from_uv(u, v));
        return contour;
    };
    EXPECT_TRUE(self_crossings(freehand_circle(100)).empty());
    const std::vector<Vec3> eight = self_crossings(drawn({{-4, -3}, {4, 3}, {4, -3}, {-4, 3}}));
    ASSERT_EQ(eight.size(), 1u);
    EXPECT_LT(distance(eight[0], kPlane.origin), 1e-12);
    EXPECT_TRUE(self_crossings(drawn({{-4, -3}, {0, 0}, {4, -3}, {4, 3}, {0, 0}, {-4, 3}})).empty()) << "a touch";
    // What was read from a file may repeat points, also the first one at the end.
    EXPECT_EQ(self_crossings(drawn({{-4, -3}, {-4, -3}, {4, 3}, {4, -3}, {4, -3}, {-4, 3}, {-4, -3}})).size(), 1u);
    EXPECT_TRUE(self_crossings(drawn({{0, 0}, {0, 0}, {0, 0}, {1, 0}, {1, 0}})).empty());
}

TEST(SelfCrossings, AreNoMoreThanWereAskedFor) {
    std::vector<Vec3> zigzag;
    for (int i = 0; i < 40; ++i) zigzag.push_back(kPlane.from_uv(i, i % 2 == 0 ? -5 : 5));
    zigzag.push_back(kPlane.from_uv(50, 0));
    zigzag.push_back(kPlane.from_uv(-9, 0.3));
    DrawnContour contour = freehand_circle(20);
    contour.points = zigzag;
    EXPECT_GT(self_crossings(contour, 1000).size(), 20u);
    EXPECT_EQ(self_crossings(contour).size(), 20u);
}

TEST(Thinned, KeepsEndsAndStaysWithinItsTolerance) {
    std::vector<Vec3> line;
    for (int i = 0; i <= 500; ++i) line.push_back({0.1 * i, 3 * std::sin(0.02 * i), 0});
    const std::vector<Vec3> thin = thinned(line);
    EXPECT_EQ(thin.front(), line.front());
    EXPECT_EQ(thin.back(), line.back());
    EXPECT_LT(thin.size(), 40u);
    for (const Vec3& p : line) {
        double nearest = 1e9;
        for (std::size_t i = 1; i < thin.size(); ++i) {
            const Vec3 along = thin[i] - thin[i - 1];
            const double t = std::clamp(dot(p - thin[i - 1], along) / dot(along, along), 0.0, 1.0);
            nearest = std::min(nearest, distance(p, thin[i - 1] + t * along));
        }
        EXPECT_LE(nearest, 0.1 + 1e-12);
    }
}

TEST(Thinned, OfALineOfAMicrometreKeepsItsShape) {
    std::vector<Vec3> line;
    for (int i = 0; i <= 200; ++i) line.push_back({1e-3 * std::cos(0.03 * i), 1e-3 * std::sin(0.03 * i), 0});
    const std::size_t small = thinned(line).size();
    for (Vec3& p : line) p = 1e4 * p;  // 10 mm
    EXPECT_GE(small, thinned(line).size());
    EXPECT_GT(small, 12u);
}

}  // namespace
}  // namespace kontur::viewer
