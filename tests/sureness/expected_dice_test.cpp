// SPDX-License-Identifier: Apache-2.0
#include "kontur/sureness/expected_dice.h"

#include <gtest/gtest.h>

#include "kontur/measure/compare.h"
#include "kontur/phantom/cases.h"
#include "kontur/phantom/phantom.h"
#include "kontur/sureness/surface_evidence.h"
#include "support/coarse_grid.h"
#include "support/drawn_bodies.h"

namespace kontur {
namespace {

TEST(ExpectedDice, IsNoneWithoutASurface) {
    const ExpectedDice none = expected_dice(SurfaceEvidence{});
    EXPECT_EQ(none.value, 0);
    EXPECT_EQ(planes_to(none, 3, 0.95), 0u);
}

TEST(ExpectedDice, RisesAsDistancesFall) {
    const Body ball = test::ball_solid({}, 20);
    const SurfaceEvidence evidence = test::fitted(ball, test::three_planes({})).evidence;
    std::vector<double> half = evidence.distances_mm;
    for (double& distance : half) distance /= 2;
    const ExpectedDice now = expected_dice(evidence), later = expected_dice(evidence, half);
    EXPECT_GT(later.value, now.value);
    EXPECT_LT(now.low, now.value);
    EXPECT_LT(now.value, now.high);
    EXPECT_LT(now.high, 1);
}

TEST(ExpectedDice, PlanesToATargetGrowWithIt) {
    const ExpectedDice now{0.9, 0.85, 0.93};
    EXPECT_EQ(planes_to(now, 4, 0.9), 0u);
    EXPECT_GE(planes_to(now, 4, 0.901), 1u);
    EXPECT_GT(planes_to(now, 4, 0.98), planes_to(now, 4, 0.95));
}

/// What parallel contours tell of the hand can be structure that is finer than their gaps.
TEST(ExpectedDice, WhatParallelContoursTellOfTheHandLowersTheWorseEndAlone) {
    const Body ball = test::ball_solid({}, 20);
    SurfaceEvidence evidence = test::fitted(ball, test::parallel_planes(ball, 6)).evidence;
    evidence.hand_mm = 0;
    const ExpectedDice without = expected_dice(evidence);
    evidence.hand_mm = 1;
    const ExpectedDice with = expected_dice(evidence);
    EXPECT_EQ(with.value, without.value);
    EXPECT_EQ(with.high, without.high);
    EXPECT_LT(with.low, without.low);
    EXPECT_GT(with.low, 0);
}

/// Smooth bodies do better than organs, on which the constants were fitted, but never much worse.
TEST(ExpectedDice, IsNotFarAboveWhatPhantomsHave) {
    for (const char* name :
         {"liver_oblique10", "liver_orthogonal14_hand", "kidney_radial6_hand", "vertebra_parallel11_hand"}) {
        const PhantomCase one = phantom_case(name);
        const Grid grid = test::coarse(one.grid, 2);
        const test::Fitted made = test::fitted(one.contours, grid);
        const double dice = test::dice(made.mask.values, make_truth_mask(*one.body, grid, {.threads = 1}).values);
        EXPECT_GT(dice, expected_dice(made.evidence).low) << name;
    }
}

}  // namespace
}  // namespace kontur
