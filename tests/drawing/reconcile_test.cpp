// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/reconcile.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kontur/fit/prepare.h"
#include "kontur/measure/compare.h"
#include "kontur/phantom/cases.h"
#include "kontur/segment.h"
#include "support/coarse_grid.h"
#include "support/contour_sets.h"
#include "support/functions.h"

namespace kontur {
namespace {

/// Three circles of a ball of radius 20 in planes at right angles; the last one drawn too large by `excess`.
ContourSet three_great_circles(double excess) {
    ContourSet set;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 normal{};
        normal[axis] = 1;
        set.contours.push_back(test::circle(make_plane({0, 0, 0}, normal), axis == 2 ? 20 + excess : 20, 90));
    }
    return set;
}

std::vector<BoundaryPoint> reconciled(const ContourSet& set, Conflicts conflicts) {
    std::vector<BoundaryPoint> points = prepare(set, {.reconcile = {.conflicts = Conflicts::exact}}).points;
    reconcile(points, find_crossings(set), diameter_mm(set), {.conflicts = conflicts, .offset_mm = 1});
    return points;
}

TEST(Reconcile, TrustsAllPointsOfContoursThatAgree) {
    for (const BoundaryPoint& p : reconciled(three_great_circles(0), Conflicts::reconcile))
        EXPECT_GT(p.trust, 0.98) << "chords alone disagree by a hundredth of a millimetre";
}

TEST(Reconcile, LowersTheTrustOfBothContoursOnlyWhereTheyDisagree) {
    bool any = false;
    for (const BoundaryPoint& p : reconciled(three_great_circles(1.5), Conflicts::reconcile)) {
        // The third circle, in the plane z = 0, crosses the others on the x and y axes.
        const double away = std::min(distance(p.position, normalized({p.position.x, 0, 0}) * 20.75),
                                     distance(p.position, normalized({0, p.position.y, 0}) * 20.75));
        if (away > 3 * 1.5 + 1) {
            EXPECT_EQ(p.trust, 1) << p.position.x << ' ' << p.position.y << ' ' << p.position.z;
        }
        if (away < 1) {
            EXPECT_LT(p.trust, 0.02);
            any = true;
        }
        EXPECT_GT(p.trust, 0);
    }
    EXPECT_TRUE(any);
}

// A point that a drag moves a little must not be let go of at once, or the surface leaps.
TEST(Reconcile, TrustFadesByAndByHoweverLargeTheDisagreement) {
    for (const double excess : {0.1, 1.0, 4.0}) {
        const ContourSet set = three_great_circles(excess);
        std::vector<BoundaryPoint> points;
        for (const Vec3& p : test::circle(set.contours[0].plane, 20, 9000).points)  // 0.014 mm apart
            points.push_back({.position = p, .contour = 0});
        reconcile(points, find_crossings(set), diameter_mm(set), {.offset_mm = 1});
        EXPECT_LT(std::ranges::min(points, {}, &BoundaryPoint::trust).trust, 0.7) << excess;
        for (std::size_t i = 1; i < points.size(); ++i) {
            const auto [less, more] = std::minmax(points[i - 1].trust, points[i].trust);
            ASSERT_LT(more, 1.2 * less) << excess << " at point " << i;
        }
    }
}

TEST(Reconcile, TheNewestContourKeepsAllTrust) {
    double least_of_first = 1;
    for (const BoundaryPoint& p : reconciled(three_great_circles(1.5), Conflicts::newest_wins)) {
        if (p.contour == 2) {
            EXPECT_EQ(p.trust, 1);
        } else {
            least_of_first = std::min(least_of_first, p.trust);
        }
    }
    EXPECT_LT(least_of_first, 0.02);
}

TEST(Reconcile, TheHeavierContourYieldsLess) {
    const auto least_trust = [](double weight, std::int32_t contour) {
        ContourSet set = three_great_circles(1.5);
        set.contours[2].weight = weight;
        double least = 1;
        for (const BoundaryPoint& p : reconciled(set, Conflicts::reconcile))
            if (p.contour == contour)
                least = std::min(least, p.trust / set.contours[static_cast<std::size_t>(contour)].weight);
        return least;
    };
    EXPECT_NEAR(least_trust(1, 2), least_trust(1, 0), 1e-3);
    EXPECT_GT(least_trust(9, 2), 3 * least_trust(1, 2));
    EXPECT_LT(least_trust(9, 0), least_trust(1, 0));
}

TEST(Reconcile, PointsStartWithTheWeightOfTheirContour) {
    ContourSet set = three_great_circles(0);
    set.contours[1].weight = 5;
    for (const BoundaryPoint& p : prepare(set, {.reconcile = {.conflicts = Conflicts::exact}}).points)
        EXPECT_EQ(p.trust, p.contour == 1 ? 5 : 1);
}

TEST(Reconcile, ExactContoursAllKeepTheirTrust) {
    for (const BoundaryPoint& p : reconciled(three_great_circles(1.5), Conflicts::exact)) EXPECT_EQ(p.trust, 1);
}

TEST(Reconcile, TheSurfacePassesBetweenContoursThatYieldAndThroughTheOneThatDoesNot) {
    const Grid grid = test::grid_about({0, 0, 0}, {30, 30, 30}, 2);
    const auto radius_along_x = [&](Conflicts conflicts, double weight = 1) {
        ContourSet set = three_great_circles(1);
        set.contours[2].weight = weight;
        SegmentOptions options;
        options.conflicts = conflicts;
        const ImplicitFunction f = segment(set, grid, options).function;
        double inside = 15, outside = 25;
        for (int step = 0; step < 40; ++step) {
            const double middle = (inside + outside) / 2;
            (f.value({middle, 0, 0}) > 0 ? inside : outside) = middle;
        }
        return inside;
    };
    EXPECT_GT(radius_along_x(Conflicts::reconcile), 20.2);
    EXPECT_LT(radius_along_x(Conflicts::reconcile), 20.8);
    EXPECT_NEAR(radius_along_x(Conflicts::newest_wins), 21, 0.1);
    EXPECT_GT(radius_along_x(Conflicts::reconcile, 1000), 20.95);
    EXPECT_LT(radius_along_x(Conflicts::reconcile, 0.001), 20.05);
}

TEST(Reconcile, HandDrawnContoursThatCrossLoseNothing) {
    const PhantomCase c = phantom_case("liver_oblique10_hand");
    const Grid grid = test::coarse(c.grid, 3);
    Mask truth{grid, {}};
    truth.values.resize(static_cast<std::size_t>(grid.voxel_count()));
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i)
                truth.values[grid.offset(i, j, k)] = c.body->value(grid.center_mm(i, j, k)) > 0;
    const auto dice = [&](Conflicts conflicts) {
        SegmentOptions options;
        options.conflicts = conflicts;
        return compare(segment(c.contours, grid, options).mask, truth).dice;
    };
    const double exact = dice(Conflicts::exact);
    EXPECT_GT(exact, 0.985);
    EXPECT_GT(dice(Conflicts::reconcile), exact - 0.0005);
}

}  // namespace
}  // namespace kontur
