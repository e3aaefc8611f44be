// SPDX-License-Identifier: Apache-2.0
#include "kontur/moving/moments.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "kontur/moving/carried_sections.h"
#include "kontur/shape/provenance.h"
#include "support/contour_sets.h"
#include "support/expect_error.h"

namespace kontur {
namespace {

ContourSet slices_in_frames(const std::vector<double>& frames) {
    ContourSet set = test::ball_slices({}, 30, 5, 10);
    for (std::size_t n = 0; n < set.contours.size(); ++n) set.contours[n].frame = frames[n % frames.size()];
    return set;
}

TEST(Moments, AreThoseOfTheContoursInOrder) {
    const Moments moments = moments_of(slices_in_frames({7, 1}));
    EXPECT_EQ(moments.course.times(), (std::vector<double>{1, 7}));
    EXPECT_EQ(moments.contours, (std::vector<std::vector<std::size_t>>{{1, 3, 5}, {0, 2, 4}}));
    EXPECT_FALSE(moments.in_seconds);
}

TEST(Moments, OneThatIsNotClearIsRefused) {
    ContourSet set = slices_in_frames({1, 7});
    set.contours[2].frame.reset();
    EXPECT_KONTUR_ERROR(moments_of(set), ErrorKind::invalid_input, "contour 3 has no frame, and contour 1 has one");
    set.contours[2].time_s = 0.5;
    EXPECT_KONTUR_ERROR(moments_of(set), ErrorKind::invalid_input, "contour 3 has no frame");
    set = slices_in_frames({1, 7});
    set.cycle_s = 1;
    EXPECT_KONTUR_ERROR(moments_of(set), ErrorKind::invalid_input, "it has to be in frames, too (cycle_frames)");
    set.cycle_s.reset();
    set.cycle_frames = 6;
    EXPECT_KONTUR_ERROR(moments_of(set), ErrorKind::invalid_input,
                        "contour 2 lies at frame 7, and a cycle of 6 goes from 1");
    set.cycle_frames = -1;
    EXPECT_KONTUR_ERROR(moments_of(set), ErrorKind::invalid_input, "the cycle is -1 long");
}

TEST(Moments, WhatDoesNotMoveCannotTakeContoursOfSeveral) {
    const ContourSet set = slices_in_frames({1, 7});
    EXPECT_TRUE(is_moving(set));
    EXPECT_KONTUR_ERROR(check_contours(set), ErrorKind::invalid_input,
                        "contour 1 was drawn in frame 1 and contour 2 in frame 7");
    EXPECT_FALSE(is_moving(slices_in_frames({3})));
    EXPECT_NO_THROW(check_contours(slices_in_frames({3})));
    ContourSet both = slices_in_frames({3});
    both.contours[1].time_s = 1;
    EXPECT_KONTUR_ERROR(check_contours(both), ErrorKind::invalid_input, "contour 2 has a frame and a time");
    EXPECT_KONTUR_ERROR(check_contours(slices_in_frames({0})), ErrorKind::invalid_input, "frames count from 1");
}

TEST(Moments, ADigestOfContoursKnowsThem) {
    const ContourSet still = test::ball_slices({}, 30, 5, 10);
    ContourSet set = still;
    std::set<std::string> digests{contours_sha256(set)};
    const auto expect_another = [&] { EXPECT_TRUE(digests.insert(contours_sha256(set)).second); };
    set.contours[0].frame = 2;
    expect_another();
    set.contours[0].frame = 3;
    expect_another();
    std::swap(set.contours[0].frame, set.contours[0].time_s);
    expect_another();
    set.cycle_s = 1;
    expect_another();
}

TEST(Moments, WhereLittleWasDrawnPlanesOfOthersAreMissing) {
    ContourSet set = slices_in_frames({1});
    const ContourSet other = slices_in_frames({5});
    set.contours.push_back(other.contours[2]);
    const DrawnMoments drawn = drawn_moments(set, moments_of(set));
    EXPECT_EQ(drawn.weights, (std::vector<double>{1, 0}));
    EXPECT_EQ(drawn.missing[0].size(), 0);
    EXPECT_EQ(drawn.missing[1].size(), 5);
    EXPECT_FALSE(drawn.sets[1].contours.front().frame.has_value());
}

}  // namespace
}  // namespace kontur
