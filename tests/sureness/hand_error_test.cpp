// SPDX-License-Identifier: Apache-2.0
#include "kontur/sureness/hand_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "kontur/sureness/surface_evidence.h"
#include "kontur/sureness/surface_uncertainty.h"
#include "support/drawn_bodies.h"

namespace kontur {
namespace {

/// Independent from contour to contour: five waves around each, `sd_mm` rms, in its plane.
ContourSet by_hand(ContourSet contours, double sd_mm, unsigned seed = 1) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, sd_mm / std::sqrt(5.0));
    for (Contour& contour : contours.contours) {
        const std::vector<Vec3> drawn = contour.points;
        std::array<std::array<double, 2>, 5> heights;
        for (auto& wave : heights) wave = {normal(random), normal(random)};
        for (std::size_t n = 0; n < drawn.size(); ++n) {
            const double angle = 2 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(drawn.size());
            double off = 0;
            for (std::size_t w = 0; w < heights.size(); ++w)
                off += heights[w][0] * std::cos(static_cast<double>(w + 1) * angle) +
                       heights[w][1] * std::sin(static_cast<double>(w + 1) * angle);
            const Vec3 along = drawn[(n + 1) % drawn.size()] - drawn[(n + drawn.size() - 1) % drawn.size()];
            contour.points[n] += off * normalized(cross(along, contour.plane.normal));
        }
    }
    return contours;
}

Body egg() { return test::ellipsoid({10, -20, 300}, {30, 22, 40}); }
ContourSet stack(std::size_t count) { return test::drawn(egg(), test::parallel_planes(egg(), count)); }

TEST(HandError, OfManyParallelContoursIsFound) {
    for (const std::size_t count : {20U, 30U, 60U}) {
        const ContourSet exact = stack(count);
        EXPECT_LT(parallel_hand_mm(exact), 0.01) << count;
        for (const double sd_mm : {0.6, 1.2})
            for (const unsigned seed : {1U, 2U, 3U}) {
                const double found = parallel_hand_mm(by_hand(exact, sd_mm, seed));
                EXPECT_GT(found, 0.7 * sd_mm) << count << " planes, seed " << seed;
                EXPECT_LT(found, 1.3 * sd_mm) << count << " planes, seed " << seed;
            }
    }
}

TEST(HandError, OfFewContoursIsFoundInTheMeanAndNeverMuchTooLarge) {
    double sum = 0;
    for (unsigned seed = 1; seed <= 12; ++seed) {
        const double found = parallel_hand_mm(by_hand(stack(9), 1.2, seed));
        EXPECT_LT(found, 1.5 * 1.2);
        sum += found / 12;
    }
    EXPECT_GT(sum, 0.5 * 1.2);
    EXPECT_LT(parallel_hand_mm(stack(9)), 0.01);
}

TEST(HandError, IsNotKnownFromFewPlanesNorWithoutAStack) {
    EXPECT_EQ(parallel_hand_mm({}), 0);
    EXPECT_EQ(parallel_hand_mm(by_hand(stack(3), 1)), 0);
    EXPECT_EQ(parallel_hand_mm(by_hand(test::drawn(egg(), test::three_planes({10, -20, 300})), 1)), 0);
    ContourSet open = by_hand(stack(9), 1);
    for (Contour& contour : open.contours) contour.closed = false;
    EXPECT_EQ(parallel_hand_mm(open), 0);
}

TEST(HandError, OneOfManyPlanesThatShowsSomethingElseMattersLittle) {
    ContourSet drawn = by_hand(stack(30), 0.6);
    const double before = parallel_hand_mm(drawn);
    for (Vec3& p : drawn.contours[14].points) p += Vec3{12, 0, 0};
    EXPECT_NEAR(parallel_hand_mm(drawn) / before, 1, 0.3);
}

/// Small balls of five sections each, far from each other and none at another's height.
ContourSet lesions(int count) {
    ContourSet set;
    for (int n = 0; n < count; ++n) {
        const Body ball = test::ellipsoid({90.0 * (n % 3), 90.0 * (n / 3 % 3), 4.7 * n}, {5, 5, 5});
        const ContourSet sections = test::drawn(ball, test::parallel_planes(ball, 5));
        set.contours.insert(set.contours.end(), sections.contours.begin(), sections.contours.end());
    }
    return set;
}

TEST(HandError, LinesOfOtherPartsTellNothing) {
    EXPECT_LT(parallel_hand_mm(lesions(9)), 1);
    EXPECT_NEAR(parallel_hand_mm(by_hand(lesions(1), 0.3)), 0.3, 0.3);
}

TEST(HandError, ManySmallPartsAreAboutAsSureAsOne) {
    const auto expected = [](int count) {
        const ContourSet set = lesions(count);
        return segment(set, grid_around(bounding_box(set), {1, 1, 1}, 8)).report.uncertainty.dice;
    };
    const ExpectedDice one = expected(1), many = expected(9);
    EXPECT_NEAR(many.value, one.value, 0.02);
    EXPECT_GT(many.high, one.value);
}

TEST(HandError, TurnsMovesAndScalesWithTheContours) {
    const ContourSet drawn = by_hand(stack(11), 0.8);
    const Affine3 turn{{{{0, 0, 1}, {0.8, -0.6, 0}, {0.6, 0.8, 0}}}, {7, 8, 9}};
    ContourSet moved = drawn;
    for (Contour& contour : moved.contours) {
        contour.plane = make_plane(3.0 * turn.apply(contour.plane.origin), turn.apply_linear(contour.plane.normal));
        for (Vec3& p : contour.points) p = 3.0 * turn.apply(p);
    }
    EXPECT_NEAR(parallel_hand_mm(moved), 3 * parallel_hand_mm(drawn), 1e-6);
}

TEST(HandError, DoesNotDependOnTheOrderOfTheContours) {
    const ContourSet drawn = by_hand(stack(11), 0.8);
    ContourSet shuffled = drawn;
    std::shuffle(shuffled.contours.begin(), shuffled.contours.end(), std::mt19937(5));
    EXPECT_NEAR(parallel_hand_mm(shuffled), parallel_hand_mm(drawn), 1e-9);
}

/// Against the body itself.
TEST(HandError, WidensTheBandOfAStackDrawnByHand) {
    const test::Fitted made = test::fitted(by_hand(stack(20), 1), test::grid_for(egg()));
    EXPECT_GT(made.evidence.hand_mm, 0.5);
    SurfaceEvidence without = made.evidence;
    without.hand_mm = 0;
    const auto covered = [&](const SurfaceEvidence& evidence) {
        const std::vector<double> widths = half_widths_mm(evidence);
        double area = 0;
        for (std::size_t n = 0; n < widths.size(); ++n)
            if (std::abs(test::depth_mm(egg(), evidence.samples.points[n])) <= widths[n])
                area += evidence.samples.areas_mm2[n];
        return area / evidence.samples.area_mm2();
    };
    EXPECT_LT(covered(without), 0.8);
    EXPECT_GT(covered(made.evidence), 0.87);
}

TEST(HandError, IsNotAskedWhereContoursCross) {
    ContourSet drawn = by_hand(stack(9), 1);
    for (const Contour& across : test::drawn(egg(), {make_plane({10, -20, 300}, {1, 0, 0})}).contours)
        drawn.contours.push_back(across);
    const test::Fitted made = test::fitted(drawn, test::grid_for(egg()));
    EXPECT_GT(made.evidence.disagreement_mm, 0);
    EXPECT_EQ(made.evidence.hand_mm, 0);
}

}  // namespace
}  // namespace kontur
