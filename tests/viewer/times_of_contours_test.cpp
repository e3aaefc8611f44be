// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/times_of_contours.h"

#include <gtest/gtest.h>

#include "support/contour_sets.h"
#include "support/expect_error.h"

namespace kontur::viewer {
namespace {

ContourSet at_frames(std::vector<double> frames) {
    ContourSet set = test::ball_slices({}, 30, 5, 10);
    set.contours.resize(frames.size());
    for (std::size_t n = 0; n < frames.size(); ++n) set.contours[n].frame = frames[n];
    return set;
}

TEST(TimesOfContours, FramesCountFrom1AndTheOpenedOneNeedsNone) {
    ContourSet set = at_frames({1, 3, 4});
    const FramesOfImage frames{.count = 4, .opened = 2};
    EXPECT_TRUE(put_into_frames(set, frames).empty());
    EXPECT_EQ(time_of(set.contours[0], frames), 0);
    EXPECT_EQ(time_of(set.contours[1], frames), std::nullopt);
    EXPECT_EQ(time_of(set.contours[2], frames), 3);
}

TEST(TimesOfContours, SecondsBecomeTheNearestFrame) {
    ContourSet set = at_frames({1, 1});
    set.contours[0].time_s = 0.05;
    set.contours[1].time_s = 0.13;
    for (Contour& contour : set.contours) contour.frame.reset();
    set.cycle_s = 0.8;
    const auto notes = put_into_frames(set, {.count = 16, .step_s = 0.05});
    EXPECT_EQ(set.contours[0].frame, 2);
    EXPECT_EQ(set.contours[1].frame, 4);
    EXPECT_DOUBLE_EQ(*set.cycle_frames, 16);
    ASSERT_EQ(notes.size(), 1);
    EXPECT_EQ(notes[0], "1 contour between two frames was moved to the nearer one");
}

TEST(TimesOfContours, WhatTheImageDoesNotHaveIsRefused) {
    ContourSet set = at_frames({1, 5});
    EXPECT_KONTUR_ERROR(put_into_frames(set, {.count = 4}), ErrorKind::invalid_input,
                        "contour 2 lies in frame 5, and the image's frames go from 1 to 4");
    EXPECT_KONTUR_ERROR(put_into_frames(set, {}), ErrorKind::invalid_input, "the image has 1 frame");
    for (Contour& contour : set.contours) contour.frame.reset(), contour.time_s = 0.2;
    EXPECT_KONTUR_ERROR(put_into_frames(set, {.count = 4}), ErrorKind::invalid_input, "give contours a frame");
}

TEST(TimesOfContours, OnAnImageOfOneFrameOneMomentIsNone) {
    ContourSet set = at_frames({7, 7});
    EXPECT_TRUE(put_into_frames(set, {}).empty());
    EXPECT_EQ(set.contours[0].frame, std::nullopt);
}

}  // namespace
}  // namespace kontur::viewer
