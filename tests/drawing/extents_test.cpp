// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/extents.h"

#include <gtest/gtest.h>

#include "kontur/fit/prepare.h"
#include "kontur/phantom/cases.h"
#include "kontur/pipeline.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

ContourSet moved(ContourSet set, const Vec3& by) {
    for (Contour& contour : set.contours) {
        contour.plane.origin += by;
        for (Vec3& p : contour.points) p += by;
    }
    return set;
}

ContourSet together(ContourSet a, const ContourSet& b) {
    a.contours.insert(a.contours.end(), b.contours.begin(), b.contours.end());
    return a;
}

Extents extents_of(const ContourSet& set) { return {set, smallest_ball(set)}; }

TEST(Extents, AnObjectIsOnePartHoweverSmallItsSections) {
    for (const char* name : {"liver_orthogonal14", "vertebra_parallel11", "metastasis_parallel7"})
        EXPECT_TRUE(extents_of(phantom_case(name).contours).is_one_part()) << name;
    ContourSet tip = test::ball_slices({}, 100, 10, 20);
    tip.contours.push_back(test::circle(make_plane({0, 0, 99.99}, {0, 0, 1}), 1, 12));
    EXPECT_TRUE(extents_of(tip).is_one_part());
    EXPECT_EQ(extents_of(tip).at({0, 0, 99.99}), 1);
}

TEST(Extents, SmallBallsFarFromEachOtherArePartsOfTheirOwn) {
    const ContourSet ball = test::three_great_circles();
    const Vec3 apart{4000, 0, 0};
    const Extents extents = extents_of(together(ball, moved(ball, apart)));
    ASSERT_FALSE(extents.is_one_part());
    EXPECT_NEAR(extents.at({}), 40.2 / 2010.0, 1e-6);
    EXPECT_EQ(extents.at({}), extents.at(apart));
    EXPECT_GT(extents.at(0.5 * apart), 0.9) << "what lies far from all has the extent of all";
}

TEST(Extents, ABallLosesNothingByAWiderOneFarAway) {
    const ContourSet small = test::three_great_circles(), wide = test::ball_slices({3000, 0, 0}, 100, 10, 20);
    const Extents extents = extents_of(together(small, wide));
    EXPECT_LT(extents.at({}), 0.1);
    EXPECT_NEAR(extents.at({3000, 0, 0}), 100 / 1555.0, 1e-3);
}

TEST(Extents, FollowWhatIsDraggedAwayWithoutAJump) {
    const ContourSet ball = test::three_great_circles();
    double before = 1;
    for (double apart = 30; apart < 4000; apart *= 1.002) {
        const double now = extents_of(together(ball, moved(ball, {apart, 0, 0}))).at({});
        EXPECT_LE(now, before);
        EXPECT_GT(now, 0.98 * before) << apart;
        before = now;
    }
    EXPECT_LT(before, 0.3);
}

TEST(Extents, EvenlySpacedRingsAreOnePartHoweverFarApart) {
    for (const double apart : {10.0, 30.0, 100.0}) {
        ContourSet tube;
        for (int n = 0; n < 7; ++n) tube.contours.push_back(test::circle(make_plane({0, 0, n * apart}, {0, 0, 1}), 3, 24));
        EXPECT_TRUE(extents_of(tube).is_one_part()) << apart;
    }
}

TEST(Extents, PartsHaveTheirOwnContours) {
    const ContourSet ball = test::three_great_circles();
    const Extents one = extents_of(together(ball, moved(ball, {30, 0, 0})));
    EXPECT_EQ(one.parts().size(), 1u);
    const Extents two = extents_of(together(ball, moved(ball, {60, 0, 0})));
    EXPECT_EQ(two.parts(), (std::vector<std::vector<std::size_t>>{{0, 1, 2}, {3, 4, 5}}));
    EXPECT_NEAR(two.at({}), 10 / 40.0, 1e-6);
}

TEST(Extents, EachConstraintOfAPartHasThatOfThePart) {
    const ContourSet ball = test::three_great_circles();
    const PreparedContours prepared = prepare(Drawing(together(ball, moved(ball, {4000, 0, 0}))));
    for (const BoundaryPoint& point : prepared.points) EXPECT_NEAR(point.extent, 40.2 / 2010.0, 1e-6);
    for (const Bound& bound : prepared.bounds) {
        EXPECT_GT(bound.extent, 0);
        EXPECT_LE(bound.extent, 1);
    }
    for (const BoundaryPoint& point : prepare(Drawing(ball)).points) EXPECT_EQ(point.extent, 1);
}

}  // namespace
}  // namespace kontur
