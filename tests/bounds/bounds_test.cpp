// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "kontur/bounds/end_bounds.h"
#include "kontur/bounds/plane_bounds.h"
#include "support/contour_sets.h"
#include "support/random.h"

namespace kontur {
namespace {

const Vec3 kNormal = normalized({0.3, -0.5, 0.8});

/// Equal circles in planes at these heights along kNormal.
ContourSet stack(const std::vector<double>& heights) {
    ContourSet set;
    for (const double h : heights) set.contours.push_back(test::circle(make_plane(h * kNormal, kNormal), 10, 60));
    return set;
}

std::vector<Bound> bounds_of(const ContourSet& set) { return find_bounds(DrawnPlanes(set)).bounds; }

/// How high domes rise beyond the last plane of a stack.
double highest(const ContourSet& set, double last) {
    double height = 0;
    for (const Bound& bound : bounds_of(set))
        if (bound.most_mm == 0) height = std::max(height, dot(bound.position, kNormal) - last);
    return height;
}

double end_of(const std::vector<double>& heights) {
    const ContourSet set = stack(heights);
    const DrawnPlanes planes(set);
    return end_height(planes, planes.sections.back(), 1, 10).height_mm;
}

TEST(Bounds, AreFromAboveOutsideOfWhatWasDrawnAndFromBelowInside) {
    const ContourSet set = stack({0, 4, 8, 12});
    for (const Bound& bound : bounds_of(set)) {
        EXPECT_GT(bound.noise_mm, 0);
        if (bound.least_mm > 0) {
            EXPECT_EQ(bound.most_mm, std::numeric_limits<double>::infinity());
            continue;
        }
        EXPECT_LE(bound.most_mm, 0);
        const double height = dot(bound.position, kNormal), aside = norm(bound.position - height * kNormal);
        EXPECT_TRUE(height < 0 || height > 12 || aside > 9.9)
            << height << " " << aside << " " << bound.most_mm << " " << bound.noise_mm;
    }
}

TEST(EndHeight, IsAboutTheGapBeforeAndNeverMoreThanOneAndAHalfRadii) {
    EXPECT_NEAR(end_of({0, 4, 8, 12}), 4, 1.2);
    EXPECT_NEAR(end_of({0, 4, 8, 12}), highest(stack({0, 4, 8, 12}), 12), 0.1);
    EXPECT_NEAR(end_of({0}), 10, 1e-9) << "as high as wide where nothing tells";
    EXPECT_LE(end_of({0, 100}), 15);
}

TEST(EndHeight, TwoClosePlanesSayLittleAndMoreTheMoreThereAre) {
    EXPECT_GT(end_of({0, 0.5}), 9.5);
    EXPECT_LT(end_of({0, 0.5, 1, 1.5}), 4) << "that several are alike tells that planes were drawn across all of it";
    EXPECT_LT(end_of({0, 0.5, 1, 1.5, 2}), 1);
    std::vector<double> all;
    for (double at = 0; at < 20; at += 0.5) all.push_back(at);
    EXPECT_NEAR(end_of(all), 0.85 * 0.5, 0.01);
    EXPECT_LT(end_of({0, 0.1, 0.2, 5, 10, 15, 20}), 5) << "planes drawn again do not count";
    EXPECT_NEAR(end_of({0, 5, 10, 15, 20}), end_of({0, 0, 5, 5, 10, 10, 15, 15, 20, 20}), 0.01);
}

TEST(EndHeight, FollowsTheDistanceOfPlanesContinuously) {
    double last = end_of({0, 10});
    for (double gap = 0; gap <= 10; gap += 0.05) {  // from a plane drawn twice to an even stack
        const double height = end_of({0, 10, 10 + gap + 1e-9});
        if (gap > 0) {
            EXPECT_NEAR(height, last, 0.06) << gap;
        } else {
            EXPECT_NEAR(height, last, 0.01) << "a plane drawn twice says nothing new";
        }
        last = height;
    }
}

TEST(EndHeight, FollowsTheTiltOfPlanesContinuously) {
    double last = 0;
    for (double degrees = 0; degrees <= 40; degrees += 0.5) {
        const double angle = degrees * M_PI / 180;
        ContourSet set = stack({0});
        const Vec3 up = std::cos(angle) * kNormal + std::sin(angle) * make_plane({}, kNormal).u;
        set.contours.insert(set.contours.begin(), test::circle(make_plane(-4.0 * kNormal, up), 10, 60));
        const DrawnPlanes planes(set);
        const double height = end_height(planes, planes.sections.back(), 1, 10).height_mm;
        if (degrees > 0) {
            EXPECT_NEAR(height, last, 0.5) << degrees;
        }
        last = height;
    }
    EXPECT_NEAR(last, 10, 1e-9) << "a plane that is tilted so much tells no gap";
}

TEST(EndHeight, ReachesBeyondSinglePoints) {
    ContourSet set = stack({0, 4});
    set.interior = {20.0 * kNormal};
    const DrawnPlanes planes(set);
    EXPECT_NEAR(end_height(planes, planes.sections.back(), 1, 10).height_mm, 1.25 * 16, 1e-9);
}

TEST(EndBounds, AreNoneWhereContoursOfOtherDirectionsLeadOn) {
    for (const Bound& bound : bounds_of(test::three_great_circles()))
        EXPECT_NE(bound.most_mm, 0) << "of planes, not of ends";
}

/// However near the planes are.
TEST(EndBounds, AreNoneTowardsAPlaneThatShowsTheObjectThere) {
    for (const double gap : {4.0, 1.0, 0.3}) {
        const double top = 8 * gap;
        for (const Bound& bound : bounds_of(stack({0, gap, 2 * gap, 3 * gap, 4 * gap, 5 * gap, 6 * gap, 7 * gap, top}))) {
            const double height = dot(bound.position, kNormal), aside = norm(bound.position - height * kNormal);
            if (bound.least_mm > 0 || aside > 9.5 || height < 1e-9 || height > top - 1e-9) continue;
            EXPECT_GT(bound.noise_mm, 100) << gap << " " << height << " " << bound.most_mm;
        }
    }
}

TEST(EndBounds, EndABranchThatTheNextPlaneDoesNotShow) {
    ContourSet set = stack({0, 4, 8});
    Contour branch = test::circle(set.contours[1].plane, 3, 30);
    for (Vec3& p : branch.points) p += 30 * set.contours[1].plane.u;
    set.contours.push_back(branch);
    const Vec3 middle = set.contours[1].plane.from_uv(30, 0);
    int above = 0, below = 0;
    for (const Bound& bound : bounds_of(set)) {
        const double height = dot(bound.position - middle, kNormal);
        if (bound.most_mm != 0 || norm(bound.position - middle) > 6) continue;
        EXPECT_LE(std::abs(height), 4.5 + 1e-9) << "1.5 radii of the branch";
        (height > 0 ? above : below)++;
    }
    EXPECT_GT(above, 2);
    EXPECT_GT(below, 2);
}

TEST(PlaneBounds, ReachBeyondTheObjectAndGrowWithTheDistance) {
    const ContourSet set = test::three_great_circles();
    const DrawnPlanes planes(set);
    const std::vector<DrawnRegion> regions = drawn_regions(planes);
    double farthest = 0;
    for (const Bound& bound : plane_bounds(planes, regions, 2)) {
        EXPECT_NEAR(bound.position.z, 0, 1e-9);
        if (bound.least_mm > 0) continue;
        const double outside = norm(bound.position) - 10;
        EXPECT_NEAR(bound.most_mm, -0.25 * outside, 0.05) << outside;
        farthest = std::max(farthest, outside);
    }
    EXPECT_GT(farthest, 2);
}

TEST(PlaneBounds, SeeAnIslandOfATenthOfTheSectionBesideIt) {
    const ContourSet set = stack({0, 4, 8});
    const DrawnPlanes planes(set);
    const std::vector<Bound> bounds = plane_bounds(planes, drawn_regions(planes), 1);
    for (double angle = 0; angle < 6; angle += 0.1) {
        const Vec3 island = planes.sections[1].plane.from_uv(12.5 * std::cos(angle), 12.5 * std::sin(angle));
        EXPECT_TRUE(std::ranges::any_of(bounds, [&](const Bound& bound) { return distance(bound.position, island) < 1; }))
            << angle;
    }
}

TEST(PlaneBounds, KeepAwayFromWhereOtherPlanesShowTheObject) {
    // The second plane shows two parts, the first was drawn with one of them only.
    ContourSet set;
    const Plane first = make_plane({}, {0, 0, 1}), second = make_plane({}, {0, 1, 0});
    set.contours.push_back(test::circle(first, 10, 60));
    for (const double x : {0.0, 40.0}) {
        Contour part = test::circle(second, 10, 60);
        for (Vec3& p : part.points) p.x += x;
        set.contours.push_back(part);
    }
    const DrawnPlanes planes(set);
    for (const Bound& bound : plane_bounds(planes, drawn_regions(planes), 0))
        if (distance(bound.position, {40, 0, 0}) < 9 && bound.most_mm < 0) {
            EXPECT_GT(bound.noise_mm, 4) << bound.position.x << " " << bound.position.y;
        }
}

TEST(PlaneBounds, SayNothingOfATubeBetweenRingsOfOtherPlanes) {
    // Two rings of a turn of a vessel; the plane half-way between them shows the next turn alone.
    ContourSet set;
    const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
    set.contours.push_back(test::circle(make_plane({0, 0, -3.5}, {c, 0, s}), 5, 40));
    set.contours.push_back(test::circle(make_plane({28, 0, -3.5}, {c, 0, -s}), 5, 40));
    set.contours.push_back(test::circle(make_plane({14, 40, 0}, {1, 0, 0}), 5, 40));
    const DrawnPlanes planes(set);
    const std::vector<DrawnRegion> regions = drawn_regions(planes);
    const auto in_the_tube = [](const std::vector<Bound>& bounds) {
        return std::ranges::count_if(bounds,
                                     [](const Bound& bound) { return std::hypot(bound.position.y, bound.position.z) < 5; });
    };
    EXPECT_GT(in_the_tube(plane_bounds(planes, regions, 2)), 2);
    std::vector<TubeWay> ways = tube_ways(regions);
    ASSERT_EQ(ways.size(), 1u);
    EXPECT_GT(in_the_tube(plane_bounds(planes, regions, 2, ways)), 2) << "two rings are no tube for sure";
    ways[0].chain = 1;
    const std::vector<Bound> bounds = plane_bounds(planes, regions, 2, ways);
    EXPECT_EQ(in_the_tube(bounds), 0);
    for (const Bound& bound : bounds)
        if (bound.most_mm < 0 && bound.position.y < 0 && std::abs(bound.position.z) < 9) {
            const double from_axis = std::hypot(bound.position.y, bound.position.z);
            EXPECT_GE(bound.most_mm, -0.25 * (from_axis - 5) - 0.01);
        }
    ways[0].length_mm = 100;  // the ring is near beside it: the plane was looked at there
    EXPECT_GT(in_the_tube(plane_bounds(planes, regions, 2, ways)), 2);
}

std::vector<std::string> notes_of(const ContourSet& set) { return find_bounds(DrawnPlanes(set)).notes; }

TEST(WideGaps, AreSpokenOfWhereOneGapIsMuchWiderThanThoseBesideIt) {
    const std::vector<std::string> notes = notes_of(stack({0, 3, 6, 9, 18, 21, 24, 27}));
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(
        notes[0],
        "contours 4 and 5 lie 9 mm apart, 3.0 times as far as the planes beside them; an empty plane between them would say "
        "that they are two bodies, a contour that they are one");
}

TEST(WideGaps, AreNoneInAnEvenOrGrowingStackNorWhereTheDrawingSaysMore) {
    EXPECT_TRUE(notes_of(stack({0, 3, 6, 9, 12, 15, 18})).empty());
    EXPECT_TRUE(notes_of(stack({0, 3, 6, 9, 18, 27, 36})).empty());
    EXPECT_TRUE(notes_of(stack({0, 3, 6, 9, 16, 19, 22, 25})).empty()) << "2.3 times";
    ContourSet parted = stack({0, 3, 6, 9, 18, 21, 24, 27});
    parted.empty_planes.push_back(make_plane(13.0 * kNormal, kNormal));
    EXPECT_TRUE(notes_of(parted).empty());
    ContourSet tilted = stack({0, 3, 6, 9, 18, 21, 24, 27});
    tilted.contours.push_back(test::circle(make_plane(13.5 * kNormal, kNormal + Vec3{0.2, 0, 0}), 10, 60));
    EXPECT_TRUE(notes_of(tilted).empty());
}

TEST(WideGaps, OfThreeSlicesAreSpokenOfWhereAPlaneMayHaveShownNothing) {
    const std::vector<std::string> notes = notes_of(stack({0, 5, 15}));
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("contours 2 and 3 lie 10 mm apart, 2.0 times as far as the planes beside them"),
              std::string::npos)
        << notes[0];
    EXPECT_EQ(notes_of(stack({0, 10, 15})).size(), 1u);
    EXPECT_TRUE(notes_of(stack({0, 5, 10})).empty());
    EXPECT_TRUE(notes_of(stack({0, 5, 14})).empty()) << "1.8 times";
    EXPECT_TRUE(notes_of(stack({0, 5, 10, 20})).empty()) << "of four, the other two tell that the last one was left out";
    EXPECT_EQ(notes_of(stack({0, 5, 10, 23})).size(), 1u);
}

/// Both sections of a ring about z, 40 mm from it, by each plane through z that stands at one of these angles.
ContourSet ring_sections(const std::vector<double>& angles) {
    ContourSet set;
    for (const double angle : angles)
        for (const double side : {-40.0, 40.0})
            set.contours.push_back(test::circle(
                {{}, {std::cos(angle), std::sin(angle), 0}, {-std::sin(angle), std::cos(angle), 0}, {0, 0, 1}}, 4, side, 0));
    return set;
}

/// The same with two circles that cross each other far above.
ContourSet with_a_ball(ContourSet set, double radius_mm) {
    for (const Vec3& normal : {Vec3{1, 0, 0}, Vec3{0, 1, 0}})
        set.contours.push_back(test::circle(make_plane({0, 0, 200}, normal), radius_mm, 60));
    return set;
}

TEST(LoneOutlines, AreSpokenOfWhereTheyAreMoreThanASmallPart) {
    const ContourSet two = ring_sections({0, 1.5});
    const std::vector<std::string> notes = notes_of(two);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(
        notes[0],
        "4 of 4 outlines stand alone, the first of them contour 1: no other lies near, and how the object goes on from "
        "there is a guess; a contour across them would say it");
    EXPECT_EQ(notes_of(with_a_ball(two, 15)).size(), 1u);
    EXPECT_TRUE(notes_of(with_a_ball(two, 20)).empty()) << "they are 7 % of what was drawn";
}

TEST(LoneOutlines, AreNoneWhereOthersCrossThemLieNearOrLeadOn) {
    EXPECT_TRUE(notes_of(test::three_great_circles()).empty());
    EXPECT_TRUE(notes_of(stack({0, 60, 120})).empty()) << "rings of a tube";
    EXPECT_TRUE(notes_of(ring_sections({0, 0.3, 0.6, 0.9, 1.2, 1.5, 1.8, 2.1, 2.4, 2.7, 3})).empty());
}

TEST(GroupedPlaces, FindThoseThatLookingAtEachOneFinds) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> number(-10, 10);
    const auto comes_before = [](const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); };
    for (const std::size_t count : {0u, 1u, 16u, 17u, 300u}) {
        std::vector<Vec3> places(count);
        for (Vec3& p : places) p = {number(random), 3 * number(random), 0.3};
        const GroupedPlaces grouped(places);
        for (int query = 0; query < 100; ++query) {
            const Vec3 at{2 * number(random), 4 * number(random), number(random)};
            // Now and then just as far as one of them, which is not near then.
            const double reach = count > 0 && query % 4 == 0 ? distance(places[0], at) : std::abs(number(random));
            std::vector<Vec3> near, found;
            for (const Vec3& p : places)
                if (dot(p - at, p - at) < reach * reach) near.push_back(p);
            grouped.visit_within(at, reach, [&](const Vec3& p) { found.push_back(p); });
            std::ranges::sort(near, comes_before);
            std::ranges::sort(found, comes_before);
            ASSERT_EQ(found, near) << count << " places, " << reach << " mm";
        }
    }
}

TEST(Bounds, MoveAndScaleWithTheContours) {
    const ContourSet set = stack({0, 4, 8});
    ContourSet large = set;
    const Vec3 by{900, -500, 100};
    for (Contour& contour : large.contours) {
        contour.plane.origin = 3.0 * contour.plane.origin + by;
        for (Vec3& p : contour.points) p = 3.0 * p + by;
    }
    const std::vector<Bound> here = bounds_of(set), there = bounds_of(large);
    ASSERT_EQ(here.size(), there.size());
    for (std::size_t i = 0; i < here.size(); ++i) {
        EXPECT_LT(distance(3.0 * here[i].position + by, there[i].position), 1e-6);
        if (here[i].least_mm > 0) {
            EXPECT_NEAR(3 * here[i].least_mm, there[i].least_mm, 1e-6);
        } else {
            EXPECT_NEAR(3 * here[i].most_mm, there[i].most_mm, 1e-6);
        }
        EXPECT_NEAR(there[i].noise_mm / here[i].noise_mm, 3, 1e-6);
    }
}

TEST(Bounds, AreTheSameForAnyNumberOfThreads) {
    const ContourSet set = stack({0, 4, 8, 12, 16});
    const DrawnPlanes planes(set);
    const std::vector<Bound> one = find_bounds(planes, {.threads = 1}).bounds,
                             three = find_bounds(planes, {.threads = 3}).bounds;
    ASSERT_EQ(one.size(), three.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].position, three[i].position);
        EXPECT_EQ(one[i].most_mm, three[i].most_mm);
        EXPECT_EQ(one[i].noise_mm, three[i].noise_mm);
    }
}

TEST(Bounds, SayWhereAThicknessIsAGuess) {
    EXPECT_EQ(find_bounds(DrawnPlanes(stack({0}))).notes.size(), 1u);
    EXPECT_TRUE(find_bounds(DrawnPlanes(stack({0, 8, 16}))).notes.empty());
}

}  // namespace
}  // namespace kontur
