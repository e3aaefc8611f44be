// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/crossings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kontur/phantom/cases.h"
#include "support/contour_sets.h"
#include "support/polygons.h"
#include "support/random.h"

namespace kontur {
namespace {

using test::Point2;

const Plane kAxial{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
const Plane kSagittal{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // shares the y axis with the axial plane

Contour rectangle(const Plane& plane, double u0, double u1, double v0, double v1) {
    return test::contour_in(plane, std::vector<Point2>{{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}});
}

ContourSet set_of(std::vector<Contour> contours) { return {{}, std::move(contours), {}, {}}; }

ContourSet moved(ContourSet set, const Plane& frame, double scale) {
    const auto turn = [&](const Vec3& v) { return v.x * frame.u + v.y * frame.v + v.z * frame.normal; };
    for (Contour& contour : set.contours) {
        for (Vec3& p : contour.points) p = frame.origin + scale * turn(p);
        Plane& plane = contour.plane;
        plane = {frame.origin + scale * turn(plane.origin), turn(plane.normal), turn(plane.u), turn(plane.v)};
    }
    return set;
}

TEST(Crossings, DistanceAlongTheCommonLineWithSignAndPositions) {
    const std::vector<Crossing> found =
        find_crossings(set_of({rectangle(kAxial, -10, 10, -10, 10), rectangle(kSagittal, -9, 12, -8, 8)}));
    ASSERT_EQ(found.size(), 2u);
    const auto [low, high] = std::minmax_element(
        found.begin(), found.end(), [](const Crossing& a, const Crossing& b) { return a.position.y < b.position.y; });
    for (const Crossing* c : {&*low, &*high}) {
        EXPECT_EQ(c->contour, 0u);
        EXPECT_EQ(c->other, 1u);
        EXPECT_TRUE(c->matched);
        EXPECT_NEAR(c->disagreement_mm, std::abs(c->distance_mm), 1e-12);
    }
    EXPECT_NEAR(low->distance_mm, 1, 1e-12);  // the first contour passes outside of the second
    EXPECT_NEAR(distance(low->position, {0, -10, 0}), 0, 1e-12);
    EXPECT_NEAR(distance(low->other_position, {0, -9, 0}), 0, 1e-12);
    EXPECT_NEAR(high->distance_mm, -2, 1e-12);
    EXPECT_NEAR(distance(high->other_position, {0, 12, 0}), 0, 1e-12);
}

TEST(Crossings, SumUpOverallAndByContour) {
    const std::vector<Crossing> found =
        find_crossings(set_of({rectangle(kAxial, -10, 10, -10, 10), rectangle(kSagittal, -9, 12, -8, 8),
                               rectangle(make_plane({30, 0, 50}, {0, 0, 1}), -1, 1, -1, 1)}));
    const Disagreement all = disagreement(found);
    EXPECT_EQ(all.matched, 2u);
    EXPECT_EQ(all.unmatched, 0u);
    EXPECT_NEAR(all.mean_mm, 1.5, 1e-12);
    EXPECT_NEAR(all.rms_mm, std::sqrt(2.5), 1e-12);
    EXPECT_NEAR(all.max_mm, 2, 1e-12);
    const std::vector<Disagreement> each = disagreement_by_contour(found, 3);
    ASSERT_EQ(each.size(), 3u);
    for (const std::size_t c : {0u, 1u}) EXPECT_NEAR(each[c].max_mm, 2, 1e-12);
    EXPECT_EQ(each[2].matched, 0u);
    EXPECT_EQ(each[2].rms_mm, 0);
}

TEST(Crossings, SectionsOfABodyAgreeWithinTheirChords) {
    for (const char* name : {"liver_orthogonal14", "liver_oblique10", "kidney_radial6"}) {
        const PhantomCase drawn = phantom_case(name);
        const Disagreement all = disagreement(find_crossings(drawn.contours));
        EXPECT_GE(all.matched, 30u) << name;
        EXPECT_EQ(all.unmatched, 0u) << name;
        EXPECT_LT(all.max_mm, 0.02) << name;
    }
}

TEST(Crossings, FollowsTheHandThatDrew) {
    const Disagreement all = disagreement(find_crossings(phantom_case("liver_orthogonal14_hand").contours));
    EXPECT_EQ(all.matched, disagreement(find_crossings(phantom_case("liver_orthogonal14").contours)).matched);
    // Two displacements of 0.6 mm rms in different directions; 1.4 times that if both were along the surface's normal.
    EXPECT_GT(all.rms_mm, 0.5);
    EXPECT_LT(all.rms_mm, 1.0);
}

TEST(Crossings, FlatAngleDoesNotExaggerate) {
    // Near the rim of a ball a displacement of 0.1 mm moves the end of the chord by far more.
    const Contour axial = test::circle(kAxial, 10, 2000);
    const double at = 9.9;
    const Contour sagittal = test::circle(make_plane({at, 0, 0}, {1, 0, 0}), std::sqrt(10.1 * 10.1 - at * at), 2000);
    const std::vector<Crossing> found = find_crossings(set_of({axial, sagittal}));
    ASSERT_EQ(found.size(), 2u);
    for (const Crossing& c : found) {
        EXPECT_LT(c.distance_mm, -0.5);
        EXPECT_NEAR(c.disagreement_mm, 0.1, 0.002);
    }
}

TEST(Crossings, WhatOnePlaneDoesNotShowStaysUnmatched) {
    // A second object that nobody drew in the sagittal plane.
    const std::vector<Crossing> found = find_crossings(
        set_of({rectangle(kAxial, -5, 5, -10, 10), rectangle(kAxial, -5, 5, 30, 36), rectangle(kSagittal, -10, 10, -8, 8)}));
    EXPECT_EQ(disagreement(found).matched, 2u);
    EXPECT_EQ(disagreement(found).max_mm, 0);
    int unmatched = 0;
    for (const Crossing& c : found) {
        if (c.matched) continue;
        ++unmatched;
        EXPECT_EQ(c.contour, 1u);
        EXPECT_EQ(c.other, 2u);
        EXPECT_NEAR(c.distance_mm, c.position.y - 10, 1e-12);  // outside of the contour that is there
        EXPECT_NEAR(c.disagreement_mm, 3, 1e-12);              // half of what is shown on the line
    }
    EXPECT_EQ(unmatched, 2);
}

TEST(Crossings, MissingHoleIsInsideOfTheOtherContour) {
    Contour hole = rectangle(kAxial, -2, 2, -3, 3);
    hole.hole = true;
    const std::vector<Crossing> found =
        find_crossings(set_of({rectangle(kAxial, -10, 10, -10, 10), hole, rectangle(kSagittal, -10, 10, -8, 8)}));
    ASSERT_EQ(found.size(), 4u);
    for (const Crossing& c : found) {
        EXPECT_EQ(c.matched, c.contour == 0);
        if (!c.matched) {
            EXPECT_NEAR(c.distance_mm, -7, 1e-12);
        }
    }
}

TEST(Crossings, TipThatJustReachesThroughAPlaneCountsLittle) {
    const Contour tip = test::contour_in(kAxial, std::vector<Point2>{{-20, -15}, {0.3, 0}, {-20, 15}});
    const std::vector<Crossing> found = find_crossings(set_of({tip, rectangle(kSagittal, 40, 50, -8, 8)}));
    ASSERT_EQ(found.size(), 4u);
    for (const Crossing& c : found) {
        EXPECT_FALSE(c.matched);
        if (c.contour == 0) {
            EXPECT_GT(c.distance_mm, 39);
            EXPECT_NEAR(c.disagreement_mm, 0.3 * 15 / 20.3, 1e-12);  // half the chord
        }
    }
}

TEST(Crossings, ParallelPlanesAndOpenContoursHaveNone) {
    EXPECT_TRUE(find_crossings(test::three_circles()).empty());
    EXPECT_TRUE(find_crossings({}).empty());
    ContourSet open = set_of({rectangle(kAxial, -10, 10, -10, 10), rectangle(kSagittal, -9, 12, -8, 8)});
    open.contours[1].closed = false;
    EXPECT_TRUE(find_crossings(open).empty());
}

TEST(Crossings, ContoursThatRunAlongTheCommonLineAgree) {
    // The sides lie in each other's planes: whichever way that is decided, nothing contradicts.
    const ContourSet set = set_of({rectangle(kAxial, 0, 10, -10, 10), rectangle(kSagittal, -10, 10, 0, 8)});
    for (const Crossing& c : find_crossings(set)) EXPECT_NEAR(c.disagreement_mm, 0, 1e-12);
}

TEST(Crossings, MoveAndScaleWithTheContours) {
    const ContourSet set = phantom_case("kidney_radial6_hand").contours;
    const std::vector<Crossing> original = find_crossings(set);
    ASSERT_GT(original.size(), 20u);
    for (const double scale : {1e-3, 1.0, 1e3}) {
        const std::vector<Crossing> turned =
            find_crossings(moved(set, make_plane({300, -200, 900}, {0.3, -0.5, 0.8}), scale));
        const Disagreement a = disagreement(original), b = disagreement(turned);
        EXPECT_EQ(a.matched, b.matched);
        EXPECT_EQ(a.unmatched, b.unmatched);
        EXPECT_NEAR(a.rms_mm, b.rms_mm / scale, 1e-6 * a.rms_mm);
        EXPECT_NEAR(a.max_mm, b.max_mm / scale, 1e-6 * a.max_mm);
    }
}

/// Length on which exactly one of two sets of intervals, given by their sorted ends, holds.
double contradiction(std::vector<double> ends, const std::vector<double>& others) {
    ends.insert(ends.end(), others.begin(), others.end());
    std::sort(ends.begin(), ends.end());
    double length = 0;
    for (std::size_t i = 0; i + 1 < ends.size(); i += 2) length += ends[i + 1] - ends[i];
    return length;
}

TEST(Crossings, MatchesExplainAllThatContradicts) {
    // Rectangles of random widths side by side in two planes: what is left out and the matches' distances add up to the
    // lengths on the y axis that one plane shows as inside and the other as outside, and ways in match ways in.
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> coordinate(0, 100);
    for (int round = 0; round < 300; ++round) {
        std::vector<double> ends[2];
        ContourSet set;
        for (const int plane : {0, 1}) {
            for (int i = 0; i < 2 * (1 + round % 4); ++i) ends[plane].push_back(coordinate(random));
            std::sort(ends[plane].begin(), ends[plane].end());
            for (std::size_t i = 0; i + 1 < ends[plane].size(); i += 2)
                set.contours.push_back(plane == 0 ? rectangle(kAxial, -50, 50, ends[0][i], ends[0][i + 1])
                                                  : rectangle(kSagittal, ends[1][i], ends[1][i + 1], -50, 50));
        }
        const std::vector<Crossing> found = find_crossings(set);
        double explained = 0;
        std::size_t passages = 0;
        for (const Crossing& c : found) {
            if (c.matched) explained += std::abs(c.distance_mm);
            passages += c.matched ? 2 : 1;
        }
        std::vector<double> left;
        for (const Crossing& c : found)
            if (!c.matched) left.push_back(c.position.y);
        std::sort(left.begin(), left.end());
        EXPECT_EQ(passages, ends[0].size() + ends[1].size());
        EXPECT_NEAR(explained + contradiction(left, {}), contradiction(ends[0], ends[1]), 1e-9) << round;
    }
}

}  // namespace
}  // namespace kontur
