// SPDX-License-Identifier: Apache-2.0
#include "kontur/sureness/surface_uncertainty.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kontur/phantom/cases.h"
#include "kontur/sureness/image_shares.h"
#include "kontur/sureness/surface_evidence.h"
#include "kontur/sureness/uncertainty_map.h"
#include "support/coarse_grid.h"
#include "support/drawn_bodies.h"

namespace kontur {
namespace {

using test::drawn;
using test::fitted;
using test::three_planes;

const Vec3 kCenter{10, -20, 300};

Body egg() { return test::ellipsoid(kCenter, {30, 22, 18}); }

TEST(SurfaceUncertainty, IsNotKnownBelowThreePlanes) {
    std::vector<Plane> planes = three_planes(kCenter);
    planes.pop_back();
    const SurfaceUncertainty two = fitted(egg(), planes).report.uncertainty;
    EXPECT_EQ(two.planes, 2u);
    EXPECT_FALSE(two.is_known);
    EXPECT_EQ(two.half_width_median_mm, 0);
    EXPECT_EQ(sentence(two), "2 planes do not tell how sure the surface is; 3 are needed");
    EXPECT_TRUE(half_widths_mm(fitted(egg(), planes).evidence).empty());

    EXPECT_TRUE(fitted(egg(), three_planes(kCenter)).report.uncertainty.is_known);
}

TEST(SurfaceUncertainty, IsNotKnownWhereNoVoxelIsInside) {
    const Grid coarse = grid_around({kCenter - Vec3{40, 40, 40}, kCenter + Vec3{160, 160, 160}}, {200, 200, 200}, 0);
    const SurfaceUncertainty none = fitted(drawn(egg(), three_planes(kCenter)), coarse).report.uncertainty;
    EXPECT_FALSE(none.is_known);
    EXPECT_EQ(sentence(none), "there is no surface on this grid, so how sure it is cannot be told");
}

TEST(SurfaceUncertainty, PlanesStillToDrawAreCountedAsFarAsThatMeansAnything) {
    SurfaceUncertainty known;
    known.is_known = true;
    known.planes_to_95 = 1;
    EXPECT_NE(sentence(known).find("; about 1 more plane to 0.95;"), std::string::npos) << sentence(known);
    known.planes_to_95 = 577;
    EXPECT_NE(sentence(known).find("; more than 30 more planes to 0.95;"), std::string::npos) << sentence(known);
    known.planes_to_95 = 0;
    known.planes_to_98 = 4;
    EXPECT_NE(sentence(known).find("; about 4 more planes to 0.98;"), std::string::npos) << sentence(known);
}

TEST(SurfaceUncertainty, AVolumeThatMayBeThreeTimesAnotherIsDoubted) {
    SurfaceUncertainty wide;
    EXPECT_FALSE(doubt(wide)) << "not known at all";
    wide.is_known = true;
    wide.volume_low_ml = 40;
    wide.volume_high_ml = 119;
    EXPECT_FALSE(doubt(wide));
    wide.volume_high_ml = 121;
    EXPECT_EQ(doubt(wide), "the volume is hardly known, it is between 40 and 121 ml; more planes would tell it");
}

TEST(SurfaceUncertainty, CountsAPlaneDrawnAgainOnce) {
    std::vector<Plane> planes = three_planes(kCenter);
    planes.back() = make_plane(kCenter + Vec3{0, 0, 0.1}, {0.01, 0, 1});  // of the first one, a little off
    const SurfaceUncertainty u = fitted(egg(), planes).report.uncertainty;
    EXPECT_EQ(u.planes, 2u);
    EXPECT_FALSE(u.is_known);
}

TEST(SurfaceUncertainty, IsLessTheMoreIsDrawn) {
    double last = 1e9, last_odds = 1e9;
    for (const std::size_t count : {3u, 5u, 9u}) {
        const SurfaceUncertainty u = fitted(egg(), test::parallel_planes(egg(), count)).report.uncertainty;
        EXPECT_LT(u.half_width_median_mm, last);
        EXPECT_LT(1 / u.dice.value - 1, last_odds);
        EXPECT_LT(u.volume_low_ml, u.volume_ml);
        EXPECT_GT(u.volume_high_ml, u.volume_ml);
        last = u.half_width_median_mm;
        last_odds = 1 / u.dice.value - 1;
    }
}

/// The definition, looked up for each point among all points of all lines.
TEST(SurfaceUncertainty, DistancesAreThoseFromTheNearestLine) {
    const ContourSet contours = drawn(egg(), three_planes(kCenter));
    const SurfaceEvidence evidence = fitted(contours, test::grid_for(egg())).evidence;
    for (std::size_t n = 0; n < evidence.samples.points.size(); n += 37) {
        double nearest = 1e9;
        for (const Contour& contour : contours.contours)
            for (std::size_t i = 0; i < contour.points.size(); ++i)
                nearest = std::min(nearest, distance_to_segment(evidence.samples.points[n], contour.points[i],
                                                                contour.points[(i + 1) % contour.points.size()]));
        EXPECT_NEAR(evidence.distances_mm[n], nearest, 0.004 * evidence.size_mm);
    }
}

TEST(SurfaceUncertainty, DrawingsErrorWidensTheBand) {
    const ContourSet contours = drawn(egg(), three_planes(kCenter));
    SurfaceEvidence evidence = fitted(contours, test::grid_for(egg())).evidence;
    const double before = half_widths_mm(evidence).front();
    evidence.disagreement_mm = 3;
    const double with = half_widths_mm(evidence).front();
    EXPECT_GT(with, 1.645 * 3 / std::sqrt(2.0));
    EXPECT_GT(with, before);
}

TEST(SurfaceUncertainty, WhatTheImageLeavesNarrowsTheBandToNoLessThanTheDrawingsError) {
    const ContourSet contours = drawn(egg(), test::parallel_planes(egg(), 5));
    SurfaceEvidence evidence = fitted(contours, test::grid_for(egg())).evidence;
    const std::vector<double> without = half_widths_mm(evidence);
    const double dice = expected_dice(evidence).value;
    std::vector<ImageShare> shares;
    for (const Vec3& p : evidence.samples.points) shares.push_back({p, 0.4});
    evidence.image = ImageShares(shares);
    std::fill(evidence.shares.begin(), evidence.shares.end(), 0.4);
    const std::vector<double> with = half_widths_mm(evidence),
                              there = half_widths_mm(evidence, evidence.samples.points, {.threads = 2});
    for (std::size_t n = 0; n < with.size(); ++n) {
        EXPECT_LT(with[n], without[n]);
        EXPECT_GE(with[n], 0.4 * without[n]);
        EXPECT_GE(with[n], evidence.voxel_mm / 2);
        EXPECT_NEAR(there[n] / with[n], 1, 0.35);
    }
    EXPECT_GT(expected_dice(evidence).value, dice);
}

TEST(SurfaceUncertainty, BandAtAnyPointAgreesWithTheSamples) {
    const test::Fitted egg_of_five = fitted(egg(), test::parallel_planes(egg(), 5));
    const SurfaceEvidence& evidence = egg_of_five.evidence;
    const std::vector<double> own = half_widths_mm(evidence),
                              asked = half_widths_mm(evidence, evidence.samples.points, {.threads = 1});
    ASSERT_EQ(own.size(), asked.size());
    for (std::size_t n = 0; n < own.size(); ++n) EXPECT_NEAR(asked[n] / own[n], 1, 0.35);  // |grad f| is a mean there
}

/// Circles around the centre of a ball that are as long as it takes count as one each, in however many planes.
TEST(SurfaceUncertainty, APlaneCountsAsWholeByTheLengthOfItsLines) {
    const Body ball = test::ball_solid(kCenter, 20);
    EXPECT_DOUBLE_EQ(fitted(ball, three_planes(kCenter)).evidence.whole_planes(), 3);

    std::vector<Plane> again = three_planes(kCenter);
    again.push_back(make_plane(kCenter + Vec3{0, 0, 0.05}, {0, 0, 1}));
    EXPECT_DOUBLE_EQ(fitted(ball, again).evidence.whole_planes(), 3);
}

TEST(SurfaceUncertainty, ASmallContourInAFurtherPlaneChangesTheBandLittleAndALargerOneMore) {
    const Body ball = test::ball_solid(kCenter, 20);
    SurfaceEvidence evidence = fitted(ball, three_planes(kCenter)).evidence;
    const double before = half_widths_mm(evidence).front();
    double last = before;
    for (const double height_mm : {19.9, 19.5, 18.0, 17.0}) {  // cut off ever larger caps
        std::vector<Plane> planes = three_planes(kCenter);
        planes.push_back(make_plane(kCenter + height_mm * normalized({1, 1, 1}), {1, 1, 1}));
        evidence.lines = DrawnLines(drawn(ball, planes));
        const double with = half_widths_mm(evidence).front();
        EXPECT_LT(with, last) << height_mm;
        if (last == before) {
            EXPECT_GT(with, 0.96 * before);
        }
        last = with;
    }
    EXPECT_LT(last, 0.9 * before);
}

/// What the band is said to hold: of the true surface nine tenths, and parts that few planes missed are in it.
TEST(SurfaceUncertainty, BandOfThreeOrFourPlanesHoldsTheTrueSurface) {
    double sum = 0, count = 0;
    for (const char* name : {"liver_oblique10", "kidney_radial6", "vertebra_parallel11", "metastasis_parallel7_hand"})
        for (const std::size_t kept : {3u, 4u}) {
            const PhantomCase one = phantom_case(name);
            std::vector<Plane> planes;
            for (std::size_t n = 0; n < kept; ++n)
                planes.push_back(one.contours.contours[(2 * n + 1) * one.contours.contours.size() / (2 * kept)].plane);
            const test::Fitted made = fitted(drawn(*one.body, planes), test::coarse(one.grid, 2));
            const double held = test::held_of_true_surface(made, *one.body, made.mask.grid);
            EXPECT_GT(held, 0.7) << name << " by " << kept << " planes";
            sum += held;
            ++count;
        }
    EXPECT_GT(sum / count, 0.88);
    EXPECT_LT(sum / count, 0.995);
}

/// Of bodies with exact truth: smoother than organs, so the band is wide for them; it must not be too narrow.
TEST(SurfaceUncertainty, BandCoversPhantomsDrawnExactlyAndByHand) {
    for (const char* name : {"liver_oblique10", "liver_orthogonal14_hand", "kidney_radial6", "kidney_radial6_hand",
                             "metastasis_parallel7_hand", "vertebra_parallel11", "vertebra_parallel11_hand"}) {
        const PhantomCase one = phantom_case(name);
        const test::Fitted made = fitted(one.contours, test::coarse(one.grid, 2));
        const std::vector<double> widths = half_widths_mm(made.evidence);
        double covered = 0;
        for (std::size_t n = 0; n < widths.size(); ++n) {
            const Vec3& p = made.evidence.samples.points[n];
            if (std::abs(test::depth_mm(*one.body, p)) <= widths[n]) covered += made.evidence.samples.areas_mm2[n];
        }
        EXPECT_GT(covered / made.evidence.samples.area_mm2(), 0.74) << name;
    }
}

TEST(SurfaceUncertainty, MapHoldsTheBandAtTheMasksBorderAlone) {
    const test::Fitted made = fitted(egg(), test::parallel_planes(egg(), 5));
    const Image map = uncertainty_map(made.mask, made.evidence, {.threads = 1});
    ASSERT_EQ(map.grid, made.mask.grid);
    const Grid& grid = map.grid;
    const double step = grid.spacing_mm().x;
    std::size_t filled = 0;
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i) {
                const double width = sample(map, grid.offset(i, j, k));
                if (width == 0) continue;
                ++filled;
                const Vec3 at = grid.center_mm(i, j, k);
                EXPECT_LT(std::abs(made.function.value(at)), 2 * step);
                EXPECT_FLOAT_EQ(static_cast<float>(half_widths_mm(made.evidence, {at}, {.threads = 1}).front()),
                                static_cast<float>(width));
            }
    const double faces = made.evidence.samples.area_mm2() / (step * step);
    EXPECT_GT(static_cast<double>(filled), 1.2 * faces);
    EXPECT_LT(static_cast<double>(filled), 3 * faces);

    const test::Fitted two = fitted(egg(), test::parallel_planes(egg(), 2));
    const Image empty = uncertainty_map(two.mask, two.evidence, {.threads = 1});
    for (std::size_t n = 0; n < two.mask.values.size(); ++n) ASSERT_EQ(sample(empty, n), 0);
}

TEST(SurfaceUncertainty, SameBytesForAnyNumberOfThreads) {
    const ContourSet contours = drawn(egg(), test::parallel_planes(egg(), 5));
    const test::Fitted one = fitted(contours, test::grid_for(egg()), 1), three = fitted(contours, test::grid_for(egg()), 3);
    EXPECT_EQ(half_widths_mm(one.evidence), half_widths_mm(three.evidence));
    EXPECT_EQ(half_widths_mm(one.evidence, one.evidence.samples.points, {.threads = 1}),
              half_widths_mm(one.evidence, one.evidence.samples.points, {.threads = 3}));
}

}  // namespace
}  // namespace kontur
