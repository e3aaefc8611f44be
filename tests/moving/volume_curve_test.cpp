// SPDX-License-Identifier: Apache-2.0
#include "kontur/volume_curve.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kontur {
namespace {

constexpr std::int64_t kSide = 20;

/// So many voxels of 1 ml in each direction.
Mask cube(std::int64_t side) {
    Mask mask{{{kSide, kSide, kSide}, {}}, {}};
    for (int axis = 0; axis < 3; ++axis) mask.grid.index_to_mm.linear[axis][axis] = 10;
    for (std::int64_t k = 0; k < kSide; ++k)
        for (std::int64_t j = 0; j < kSide; ++j)
            for (std::int64_t i = 0; i < kSide; ++i) mask.values.push_back(i < side && j < side && k < side);
    return mask;
}

/// Of 10^3 ml in frame 1 and 6^3 ml in frame 6 of 10; f does not matter here.
MaskCourse course() {
    return {MovingFunction(TimeCourse({1, 6}, 10), {ImplicitFunction(), ImplicitFunction()}), {cube(10), cube(6)}};
}

constexpr MomentSureness kSure{0.9, 1.2, 0};

TEST(VolumeCurve, TheFirstOfSeveralExtremesIsNamedAndTheTieSaid) {
    const VolumeCurve curve = volume_curve({5, 9, 3, 9, 3, 3});
    EXPECT_EQ(curve.largest, 1);
    EXPECT_EQ(curve.smallest, 2);
    EXPECT_EQ(
        note_of_ties(curve),
        "the volume is largest in 2 frames, of which frame 2 is the first; the volume is smallest in 3 frames, of which "
        "frame 3 is the first");
    EXPECT_EQ(note_of_ties(volume_curve({5, 9, 3})), "");
    EXPECT_DOUBLE_EQ(curve.ejection_fraction(), 1 - 3.0 / 9);
}

TEST(VolumeCurve, AtAMomentTheIntervalIsThatOfItsSurface) {
    const std::vector<VolumeInterval> all =
        volume_intervals(course(), {kSure, kSure}, std::vector<double>{1, 6}, {1000, 216});
    ASSERT_EQ(all.size(), 2);
    EXPECT_DOUBLE_EQ(all[0].low_ml, 900);
    EXPECT_DOUBLE_EQ(all[0].high_ml, 1200);
    EXPECT_DOUBLE_EQ(all[1].low_ml, 0.9 * 216);
    EXPECT_DOUBLE_EQ(all[1].high_ml, 1.2 * 216);
}

TEST(VolumeCurve, BetweenMomentsTheIntervalIsWiderAndNotAtThem) {
    std::vector<double> times;
    for (int n = 0; n <= 100; ++n) times.push_back(1 + 0.1 * n);
    const std::vector<VolumeInterval> all =
        volume_intervals(course(), {kSure, kSure}, times, std::vector<double>(times.size(), 500));
    const auto width = [&](std::size_t n) { return all[n].high_ml - all[n].low_ml; };
    EXPECT_NEAR(width(0), 0.3 * 500, 1e-9);
    EXPECT_NEAR(width(50), 0.3 * 500, 1e-9);
    EXPECT_NEAR(width(100), 0.3 * 500, 1e-9);
    EXPECT_GT(width(25), 1.5 * width(0));
    for (std::size_t n = 1; n < times.size(); ++n) EXPECT_NEAR(width(n), width(n - 1), 40) << "no step at " << times[n];
}

TEST(VolumeCurve, CarriedContoursMakeTheIntervalWider) {
    const std::vector<double> times{1, 6}, volumes{1000, 216};
    const auto all = volume_intervals(course(), {{0.9, 1.2, 0.5}, kSure}, times, volumes);
    EXPECT_LT(all[0].low_ml, 890);
    EXPECT_GT(all[0].high_ml, 1204);
    EXPECT_DOUBLE_EQ(all[1].low_ml, 0.9 * 216);
}

TEST(VolumeCurve, NothingIsSaidWhereAMomentDoesNotTell) {
    EXPECT_TRUE(volume_intervals(course(), {}, std::vector<double>{1, 6}, {1000, 216}).empty());
    DrawnMoment known, unknown;
    SurfaceUncertainty& sure = known.segmentation.report.uncertainty;
    sure.is_known = true;
    sure.volume_ml = 10;
    sure.volume_low_ml = 9;
    sure.volume_high_ml = 12;
    known.contours = 3;
    EXPECT_EQ(sureness_of({known}).size(), 1);
    EXPECT_DOUBLE_EQ(sureness_of({known})[0].high, 1.2);
    EXPECT_TRUE(sureness_of({known, unknown}).empty());
    EXPECT_FALSE(volume_curve({10, 5}).ejection_interval().has_value());
}

TEST(VolumeCurve, TheFractionsIntervalHoldsIt) {
    const VolumeCurve curve = volume_curve({100, 40}, {{90, 115}, {36, 46}});
    const auto interval = curve.ejection_interval();
    ASSERT_TRUE(interval.has_value());
    EXPECT_NEAR(interval->low, 1 - 0.4 * std::exp(std::hypot(std::log(46.0 / 40), std::log(100.0 / 90))), 1e-12);
    EXPECT_NEAR(interval->high, 1 - 0.4 * std::exp(-std::hypot(std::log(40.0 / 36), std::log(115.0 / 100))), 1e-12);
    const VolumeCurve between = volume_curve({100, 80, 40}, {{90, 115}, {60, 130}, {36, 46}});
    EXPECT_GT(between.ejection_interval()->high, interval->high) << "the largest may lie between";
    EXPECT_EQ(volume_curve({100, 99}, {{0, 300}, {90, 110}}).ejection_interval()->low, 0) << "log of nothing";
}

}  // namespace
}  // namespace kontur
