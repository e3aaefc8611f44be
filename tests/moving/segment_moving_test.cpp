// SPDX-License-Identifier: Apache-2.0
#include "kontur/segment_moving.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>

#include "kontur/measure/compare.h"
#include "support/contour_sets.h"
#include "support/expect_error.h"

namespace kontur {
namespace {

constexpr int kFrames = 12;

/// A ball that beats: its radius and its middle at a frame, from 1.
double radius_mm(double frame) { return 27 + 4 * std::cos(2 * std::numbers::pi * (frame - 1) / kFrames); }
Vec3 middle(double frame) { return {3 * std::sin(2 * std::numbers::pi * (frame - 1) / kFrames), 0, 0}; }

const std::vector<double>& slices() {
    static const std::vector<double> at{-20, -12, -4, 4, 12, 20};
    return at;
}

Contour section(double z, double frame) {
    const Vec3 at = middle(frame) + Vec3{0, 0, z};
    Contour contour =
        test::circle({at, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, std::sqrt(std::pow(radius_mm(frame), 2) - z * z), 40);
    contour.frame = frame;
    return contour;
}

ContourSet whole(const std::vector<double>& frames) {
    ContourSet set;
    for (const double frame : frames)
        for (const double z : slices()) set.contours.push_back(section(z, frame));
    set.cycle_frames = kFrames;
    return set;
}

/// In each frame one slice, another one each time.
ContourSet single_slices() {
    constexpr std::array kOrder{0, 5, 2, 4, 1, 3};
    ContourSet set;
    for (int frame = 1; frame <= kFrames; ++frame) set.contours.push_back(section(slices()[kOrder[(frame - 1) % 6]], frame));
    set.cycle_frames = kFrames;
    return set;
}

Grid grid() { return grid_around({{-36, -34, -34}, {36, 34, 34}}, {3, 3, 3}, 0); }

std::vector<double> all_frames() {
    std::vector<double> frames(kFrames);
    std::iota(frames.begin(), frames.end(), 1);
    return frames;
}

Mask truth(double frame) {
    Mask mask{grid(), {}};
    for (std::size_t n = 0; n < static_cast<std::size_t>(mask.grid.voxel_count()); ++n) {
        const Index3 at = index_at(n, mask.grid.size);
        mask.values.push_back(distance(mask.grid.center_mm(at.i, at.j, at.k), middle(frame)) < radius_mm(frame));
    }
    return mask;
}

MovingSegmentation made(const ContourSet& set, const Work& work = {}) {
    return segment_moving(set, grid(), all_frames(), {}, work);
}

double dice(const Mask& a, const Mask& b) { return compare(a, b).dice; }

/// Half of the way between the functions of two moments.
Mask half_way(const MovingSegmentation& moving, std::size_t first, std::size_t second) {
    Mask mask{grid(), {}};
    for (std::size_t n = 0; n < static_cast<std::size_t>(mask.grid.voxel_count()); ++n) {
        const Index3 at = index_at(n, mask.grid.size);
        const Vec3 place = mask.grid.center_mm(at.i, at.j, at.k);
        const auto& functions = moving.function.functions();
        mask.values.push_back(functions[first].value(place) + functions[second].value(place) > 0);
    }
    return mask;
}

TEST(SegmentMoving, ABallThatBeatsIsNearlyItselfInFramesLeftOut) {
    const MovingSegmentation moving = made(whole({1, 4, 7, 10}));
    ASSERT_EQ(moving.masks.size(), kFrames);
    for (int frame = 1; frame <= kFrames; ++frame) EXPECT_GT(dice(moving.masks[frame - 1], truth(frame)), 0.955) << frame;
    EXPECT_EQ(moving.volumes.largest, 0);
    EXPECT_EQ(moving.volumes.smallest, 6);
    const double fraction = 1 - std::pow(23.0 / 31, 3);
    EXPECT_NEAR(moving.volumes.ejection_fraction(), fraction, 0.02);
    EXPECT_TRUE(moving.warnings.empty()) << moving.warnings.front();
}

TEST(SegmentMoving, FromSixMomentsABallIsNearerToItselfThanHalfTheWayBetweenThem) {
    const MovingSegmentation moving = made(whole({1, 3, 5, 7, 9, 11}));
    for (std::size_t k = 0; k < 6; ++k) {
        const int frame = static_cast<int>(2 * k + 2);
        EXPECT_GT(dice(moving.masks[frame - 1], truth(frame)), dice(half_way(moving, k, (k + 1) % 6), truth(frame)))
            << frame;
    }
}

/// Of single slices in turn.
const MovingSegmentation& made_of_slices() {
    static const MovingSegmentation moving = made(single_slices());
    return moving;
}

TEST(SegmentMoving, SingleSlicesInTurnShowAllFrames) {
    const MovingSegmentation& moving = made_of_slices();
    for (int frame = 1; frame <= kFrames; ++frame) EXPECT_GT(dice(moving.masks[frame - 1], truth(frame)), 0.95) << frame;
    EXPECT_NEAR(moving.volumes.ejection_fraction(), 1 - std::pow(23.0 / 31, 3), 0.05);
    ASSERT_EQ(moving.moments.size(), kFrames);
    EXPECT_EQ(moving.moments[0].contours, 1);
    EXPECT_EQ(moving.moments[0].carried, 5);
    ASSERT_FALSE(moving.warnings.empty());
    EXPECT_NE(moving.warnings.back().find("at 12 moments little was drawn"), std::string::npos) << moving.warnings.back();
}

TEST(SegmentMoving, ASingleMomentGivesTheMaskOfSegmentAtAllTimes) {
    ContourSet set = whole({5});
    const MovingSegmentation moving = made(set);
    for (Contour& contour : set.contours) contour.frame.reset();
    const Mask alone = segment(set, grid()).mask;
    for (const Mask& mask : moving.masks) EXPECT_EQ(mask.values, alone.values);
    for (Contour& contour : set.contours) contour.frame = 5;
    EXPECT_EQ(segment(set, grid()).mask.values, alone.values);
}

TEST(SegmentMoving, EachWholeMomentIsSegmentedByItself) {
    const MovingSegmentation moving = made(whole({1, 6}));
    ContourSet alone = whole({6});
    for (Contour& contour : alone.contours) contour.frame.reset();
    EXPECT_EQ(moving.masks[5].values, segment(alone, grid()).mask.values);
}

TEST(SegmentMoving, MasksAreWhereTheFunctionIsPositive) {
    const MovingSegmentation& moving = made_of_slices();
    const Mask& mask = moving.masks[3];
    const double time = 4;
    std::vector<Vec3> places;
    for (std::size_t n = 0; n < mask.values.size(); ++n) {
        const Index3 at = index_at(n, mask.grid.size);
        places.push_back(mask.grid.center_mm(at.i, at.j, at.k));
    }
    std::vector<double> values(places.size());
    moving.function.values(places, time, values);
    std::size_t differ = 0;
    for (std::size_t n = 0; n < values.size(); ++n) differ += (values[n] > 0) != (mask.values[n] != 0);
    EXPECT_EQ(differ, 0);
    EXPECT_EQ(moving.function.value(places[700], 2.5), moving.function.value(places[700], 2.5 + kFrames));
}

TEST(SegmentMoving, TheOrderOfContoursDoesNotMatter) {
    ContourSet set = single_slices();
    const MovingSegmentation& before = made_of_slices();
    std::rotate(set.contours.begin(), set.contours.begin() + 5, set.contours.end());
    std::swap(set.contours[0], set.contours[3]);
    const MovingSegmentation after = made(set);
    for (int n = 0; n < kFrames; ++n) EXPECT_EQ(before.masks[n].values, after.masks[n].values) << n;
}

TEST(SegmentMoving, TheUnitOfTimeDoesNotMatter) {
    ContourSet set = single_slices();
    const MovingSegmentation& in_frames = made_of_slices();
    std::vector<double> times;
    for (int n = 0; n < kFrames; ++n) times.push_back(0.0625 * n);
    for (Contour& contour : set.contours) {
        contour.time_s = 0.0625 * (*contour.frame - 1);
        contour.frame.reset();
    }
    set.cycle_frames.reset();
    set.cycle_s = 0.0625 * kFrames;
    const MovingSegmentation in_seconds = segment_moving(set, grid(), times);
    for (int n = 0; n < kFrames; ++n) EXPECT_EQ(in_frames.masks[n].values, in_seconds.masks[n].values) << n;
}

TEST(SegmentMoving, ACycleHasNoSeam) {
    const MovingSegmentation moving = made(whole({1, 5, 9}));
    const Vec3 at{27, 0, 0};
    const double seam = kFrames + 1, step = 1e-4;
    EXPECT_NEAR(moving.function.value(at, seam - step), moving.function.value(at, 1), 1e-3);
    const double before = moving.function.value(at, seam) - moving.function.value(at, seam - step);
    const double after = moving.function.value(at, 1 + step) - moving.function.value(at, 1);
    EXPECT_NEAR(before / step, after / step, 0.01);
}

TEST(SegmentMoving, AContourMovedInTimeByALittleChangesLittle) {
    const ContourSet set = single_slices();
    ContourSet moved = set;
    *moved.contours[4].frame += 0.1;
    const MovingSegmentation &before = made_of_slices(), after = made(moved);
    for (int n = 0; n < kFrames; ++n) EXPECT_GT(dice(before.masks[n], after.masks[n]), 0.985) << n;
}

TEST(SegmentMoving, OneMoreContourWhereOthersForetoldItChangesLittle) {
    ContourSet set = single_slices();
    set.contours.push_back(section(slices()[3], 4));
    const MovingSegmentation more = made(set);
    for (int n = 0; n < kFrames; ++n) EXPECT_GT(dice(made_of_slices().masks[n], more.masks[n]), 0.97) << n;
}

/// Two whole frames, and in a third one so many contours.
ContourSet with_some_in_frame_4(std::size_t count) {
    constexpr std::array kOrder{2, 4, 0, 3, 5, 1};
    ContourSet set = whole({1, 7});
    for (std::size_t n = 0; n < count; ++n) set.contours.push_back(section(slices()[kOrder[n]], 4));
    return set;
}

TEST(SegmentMoving, AMomentBecomesWholeContourByContourWithoutAStep) {
    // The first contour tells most. None of the others does more than a few voxels' layer, that which makes it whole
    // neither.
    MovingSegmentation before = made(with_some_in_frame_4(1));
    for (std::size_t count = 2; count <= 6; ++count) {
        MovingSegmentation after = made(with_some_in_frame_4(count));
        for (int n = 0; n < kFrames; ++n) EXPECT_GT(dice(before.masks[n], after.masks[n]), 0.97) << count << ": " << n;
        before = std::move(after);
    }
}

/// Bright inside, dark outside.
std::shared_ptr<const Image> image_at(double frame) {
    const Mask inside = truth(frame);
    std::vector<std::int16_t> values;
    for (const std::uint8_t v : inside.values) values.push_back(v ? 900 : 100);
    return std::make_shared<const Image>(Image{inside.grid, values});
}

TEST(SegmentMoving, AWholeMomentFollowsTheImageOfItsFrameAsSegmentDoes) {
    const ContourSet set = whole({1, 6});
    std::vector<double> asked;
    const auto source = [&](double frame) {
        asked.push_back(frame);
        return image_at(frame);
    };
    const MovingSegmentation moving = segment_moving(set, {grid(), source}, all_frames());
    EXPECT_EQ(asked, (std::vector<double>{1, 6}));
    ContourSet alone = whole({6});
    for (Contour& contour : alone.contours) contour.frame.reset();
    const auto image = image_at(6);
    const Segmentation still = segment(alone, grid(), &*image);
    EXPECT_NE(still.report.image.verdict, ImageVerdict::none);
    EXPECT_EQ(moving.masks[5].values, still.mask.values);
    asked.clear();
    segment_moving(set, {grid(), source}, all_frames(), {.use_image = UseImage::off});
    EXPECT_TRUE(asked.empty());
}

TEST(SegmentMoving, WithMeshEachFrameHasItsSurface) {
    const MovingSegmentation moving = segment_moving(whole({1, 7}), grid(), all_frames(), {.mesh = true});
    ASSERT_EQ(moving.meshes.size(), kFrames);
    for (int n = 0; n < kFrames; ++n)
        EXPECT_NEAR(signed_volume_mm3(moving.meshes[n]) / 1000, moving.volumes.volumes_ml[n],
                    0.02 * moving.volumes.volumes_ml[n])
            << n;
    EXPECT_TRUE(made(whole({1, 7})).meshes.empty());
}

TEST(SegmentMoving, IntervalsHoldTheTruthBetweenMoments) {
    const MovingSegmentation moving = made(whole({1, 4, 7, 10}));
    ASSERT_EQ(moving.volumes.intervals.size(), kFrames);
    for (int n = 0; n < kFrames; ++n) {
        if (n % 3 == 0) continue;  // drawn: nine of ten hold
        const double truth_ml = 4.0 / 3 * std::numbers::pi * std::pow(radius_mm(n + 1), 3) / 1000;
        EXPECT_LT(moving.volumes.intervals[n].low_ml, truth_ml) << n;
        EXPECT_GT(moving.volumes.intervals[n].high_ml, truth_ml) << n;
    }
    const auto interval = moving.volumes.ejection_interval();
    ASSERT_TRUE(interval.has_value());
    EXPECT_LT(interval->low, 1 - std::pow(23.0 / 31, 3));
    EXPECT_GT(interval->high, 1 - std::pow(23.0 / 31, 3));
    EXPECT_LT(interval->high - interval->low, 0.3);
}

TEST(SegmentMoving, ItMakesTheSameBytesForAnyNumberOfThreads) {
    const ContourSet set = single_slices();
    const MovingSegmentation one = made(set, {.threads = 1}), three = made(set, {.threads = 3});
    for (int n = 0; n < kFrames; ++n) EXPECT_EQ(one.masks[n].values, three.masks[n].values) << n;
    EXPECT_EQ(one.function.value({1, 2, 3}, 2.3), three.function.value({1, 2, 3}, 2.3));
}

TEST(SegmentMoving, WithoutACycleNothingMovesOutsideOfTheMomentsAndAWarningSaysSo) {
    ContourSet set = whole({3, 7});
    set.cycle_frames.reset();
    const MovingSegmentation moving = made(set);
    EXPECT_EQ(moving.masks[0].values, moving.masks[2].values);
    EXPECT_EQ(moving.masks[11].values, moving.masks[6].values);
    ASSERT_EQ(moving.warnings.size(), 2);
    EXPECT_NE(moving.warnings[0].find("nothing moves before the first and after the last"), std::string::npos);
    EXPECT_EQ(
        moving.warnings[1],
        "the volume is largest in 3 frames, of which frame 1 is the first; the volume is smallest in 6 frames, of which "
        "frame 7 is the first");
}

TEST(SegmentMoving, AFrameBeyondTheImageIsRefused) {
    ContourSet set = whole({1, 14});
    set.cycle_frames.reset();
    EXPECT_KONTUR_ERROR(made(set), ErrorKind::invalid_input,
                        "contour 7 lies at frame 14, and the image's frames go from 1 to 12");
    EXPECT_KONTUR_ERROR(segment_moving(set, grid(), {}), ErrorKind::invalid_input, "there is no time to make a mask at");
    EXPECT_KONTUR_ERROR(made({}), ErrorKind::invalid_input, "there is no contour");
    set = whole({1, 5});
    set.contours[3].points.resize(2);
    EXPECT_KONTUR_ERROR(made(set), ErrorKind::invalid_input, "contour 4 has 2 points");
}

}  // namespace
}  // namespace kontur
