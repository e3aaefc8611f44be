// SPDX-License-Identifier: Apache-2.0
#include "kontur/suggest_moving.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "kontur/segment_moving.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

constexpr int kFrames = 12;
const std::vector<double> kSlices{-18, -9, 0, 9, 18};

/// Of a ball that is `radius_mm` large at a frame, from 1.
Contour section(double z, double frame, double radius_mm) {
    Contour contour =
        test::circle({{0, 0, z}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, std::sqrt(radius_mm * radius_mm - z * z), 40);
    contour.frame = frame;
    return contour;
}

ContourSet whole(const std::vector<std::pair<double, double>>& frames_and_radii) {
    ContourSet set;
    for (const auto& [frame, radius_mm] : frames_and_radii)
        for (const double z : kSlices) set.contours.push_back(section(z, frame, radius_mm));
    set.cycle_frames = kFrames;
    return set;
}

struct Moving {
    explicit Moving(const ContourSet& set) {
        std::vector<double> frames(kFrames);
        std::iota(frames.begin(), frames.end(), 1);
        made.emplace(segment_moving(set, grid_around({{-34, -34, -34}, {34, 34, 34}}, {2, 2, 2}, 0), frames));
    }
    std::vector<MovingSuggestion> suggested(std::size_t count) const {
        return suggest_moving({made->times, made->volumes, made->function, made->moments}, count);
    }
    std::optional<MovingSegmentation> made;
};

TEST(SuggestMoving, TheFirstFramesLieBetweenMomentsAndApart) {
    const Moving moving(whole({{1, 30}, {6, 22}}));
    const std::vector<MovingSuggestion> found = moving.suggested(2);
    ASSERT_EQ(found.size(), 2U);
    const auto& intervals = moving.made->volumes.intervals;
    const auto width = [&](std::size_t n) { return intervals[n].high_ml - intervals[n].low_ml; };
    for (std::size_t n = 0; n < intervals.size(); ++n) EXPECT_LE(width(n), width(found[0].frame)) << n;
    EXPECT_GT(found[0].frame, 6U) << "the longer way";
    EXPECT_LT(found[1].frame, 6U) << "the first one tells of the frames beside it, too";
    for (const MovingSuggestion& one : found) {
        EXPECT_NEAR(norm(cross(one.plane.normal, {0, 0, 1})), 0, 1e-9) << "as something was drawn";
        EXPECT_NEAR(norm(one.plane.origin - Vec3{0, 0, one.plane.origin.z}), 0, 1);
    }
}

TEST(SuggestMoving, ThePlaneIsThatInWhichTheSurfaceMovesMost) {
    ContourSet set = whole({{1, 30}});
    for (const double z : kSlices) set.contours.push_back(section(z, 6, z > 5 ? 22 : 30));
    const std::vector<MovingSuggestion> found = Moving(set).suggested(1);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_GT(found[0].plane.origin.z, 5);
}

TEST(SuggestMoving, AMomentWithOneSliceGetsAnotherOfThePlanesThatAreLeft) {
    ContourSet set = whole({{1, 30}, {6, 22}});
    set.contours.push_back(section(0, 9, 25));
    const Moving moving(set);
    const std::vector<MovingSuggestion> found = moving.suggested(kFrames);
    const auto there = std::ranges::find(found, 8U, &MovingSuggestion::frame);
    ASSERT_NE(there, found.end());
    EXPECT_GT(std::abs(there->plane.origin.z), 5);
}

TEST(SuggestMoving, AFrameWithAllPlanesGetsAnotherOne) {
    std::vector<std::pair<double, double>> all;
    for (int frame = 1; frame <= kFrames; ++frame) all.emplace_back(frame, 28 + 2 * std::cos(0.5236 * frame));
    const std::vector<MovingSuggestion> found = Moving(whole(all)).suggested(1);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(std::abs(found[0].plane.normal.z), 0, 1e-6) << "across slices that are all parallel";
}

TEST(SuggestMoving, EachFrameOnceAndTheMomentOfTheFewestPlanesFirstWhereIntervalsAreNotKnown) {
    ContourSet set;
    for (const double z : {-9.0, 9.0}) set.contours.push_back(section(z, 1, 30));
    set.contours.push_back(section(-9, 6, 22));
    const Moving moving(set);
    const std::vector<MovingSuggestion> found = moving.suggested(50);
    std::set<std::size_t> frames;
    for (const MovingSuggestion& one : found) EXPECT_TRUE(frames.insert(one.frame).second) << one.frame;
    ASSERT_FALSE(found.empty());
    ASSERT_TRUE(moving.made->volumes.intervals.empty());
    EXPECT_EQ(found.front().frame, 5U);
}

}  // namespace
}  // namespace kontur
