// SPDX-License-Identifier: Apache-2.0
#include "kontur/moving_sureness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kontur/evidence.h"
#include "kontur/segment_moving.h"
#include "kontur/sureness/surface_uncertainty.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

constexpr int kFrames = 12;

/// A ball of 30 mm in frame 1, and of `radius_mm` in another one.
ContourSet balls(double frame, double radius_mm, const std::vector<double>& slices = {-18, -9, 0, 9, 18}) {
    ContourSet set;
    for (const auto& [at, radius] : {std::pair{1.0, 30.0}, std::pair{frame, radius_mm}})
        for (const double z : slices) {
            set.contours.push_back(
                test::circle({{0, 0, z}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, std::sqrt(radius * radius - z * z), 40));
            set.contours.back().frame = at;
        }
    set.cycle_frames = kFrames;
    return set;
}

MovingSegmentation made(const ContourSet& set) {
    std::vector<double> frames(kFrames);
    std::iota(frames.begin(), frames.end(), 1);
    return segment_moving(set, grid_around({{-34, -34, -34}, {34, 34, 34}}, {2, 2, 2}, 0), frames, {.mesh = true});
}

std::vector<double> widths(const MovingSegmentation& moving, double time, int threads = 0) {
    const std::vector<Vec3>& points = moving.meshes[static_cast<std::size_t>(time) - 1].points;
    return half_widths_mm(moving.function, moving.moments, points, time, {.threads = threads});
}

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(MovingSureness, AtAMomentTheBandIsThatOfItsSurface) {
    const MovingSegmentation moving = made(balls(7, 22));
    const DrawnMoment& moment = moving.moments[1];
    EXPECT_EQ(widths(moving, 7), half_widths_mm(gather_evidence(moment.segmentation, moment.set), moving.meshes[6].points));
    EXPECT_EQ(widths(moving, 7), widths(moving, 7, 1)) << "for any number of threads";
}

TEST(MovingSureness, BetweenMomentsItIsWiderWhereMoreMovesAndNextToThemItIsTheSame) {
    const MovingSegmentation much = made(balls(7, 22)), little = made(balls(7, 29));
    EXPECT_GT(mean(widths(much, 4)), mean(widths(much, 2)));
    EXPECT_GT(mean(widths(much, 2)), 0.9 * mean(widths(much, 1)));
    EXPECT_GT(mean(widths(much, 4)), mean(widths(little, 4)) + 0.5);
    const std::vector<Vec3>& points = much.meshes[0].points;
    const auto at = [&](double time) { return half_widths_mm(much.function, much.moments, points, time); };
    const std::vector<double> there = at(1), beside = at(1 + 1e-6);
    for (std::size_t n = 0; n < points.size(); ++n) EXPECT_NEAR(there[n], beside[n], 1e-3) << n;
}

TEST(MovingSureness, WhatIsKeptOfMomentsTellsTheSameAtAnyTime) {
    const MovingSegmentation moving = made(balls(7, 22));
    const MovingSureness kept(moving.function.course(), moving.moments);
    for (const double time : {1.0, 4.0, 7.0, 11.0}) {
        const std::vector<Vec3>& points = moving.meshes[static_cast<std::size_t>(time) - 1].points;
        EXPECT_EQ(kept.half_widths_mm(points, moving.function.changes(points, time), time), widths(moving, time)) << time;
    }
}

TEST(MovingSureness, NothingIsSaidWhereAMomentDoesNotTell) {
    const MovingSegmentation moving = made(balls(7, 22, {-9, 9}));
    EXPECT_TRUE(widths(moving, 1).empty());
    EXPECT_TRUE(widths(moving, 4).empty());
}

}  // namespace
}  // namespace kontur
