// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/sides.h"

#include <gtest/gtest.h>

#include <numbers>

#include "kontur/base/error.h"
#include "kontur/drawing/orient.h"
#include "kontur/fit/prepare.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

/// A quarter of a circle in `plane`, counter-clockwise about its normal: the disc lies on its left.
Contour arc(const Plane& plane, double radius, bool reversed = false) {
    Contour contour{plane, {}, false, false};
    for (int i = 0; i <= 20; ++i) {
        const double angle = std::numbers::pi / 2 * (reversed ? 20 - i : i) / 20;
        contour.points.push_back(plane.from_uv(radius * std::cos(angle), radius * std::sin(angle)));
    }
    return contour;
}

const Plane kPlane = make_plane({4, 5, 6}, {0.3, -0.5, 0.8});

TEST(LeftNormals, PointToTheLeftOfTheWalk) {
    for (const bool reversed : {false, true}) {
        const Contour contour = arc(kPlane, 10, reversed);
        const std::vector<Vec3> normals = left_normals(contour);
        for (std::size_t i = 0; i < normals.size(); ++i) {
            const Vec3 inward = normalized(kPlane.origin - contour.points[i]);
            EXPECT_LT(distance(normals[i], reversed ? -inward : inward), 0.05) << i;
        }
    }
}

TEST(FindSides, FollowWhatTheRestOfTheDrawingSays) {
    // Two closed circles of a ball, and an arc of it in a plane through both.
    for (const bool reversed : {false, true}) {
        ContourSet set;
        for (const double at : {-8.0, 8.0})
            set.contours.push_back(
                test::circle(make_plane(kPlane.origin + at * kPlane.normal, kPlane.normal), std::sqrt(400 - at * at), 60));
        set.contours.push_back(arc(make_plane(kPlane.origin, kPlane.u), 20, reversed));
        EXPECT_THROW(prepare(set), Error) << "nobody told on which hand the object lies";
        const std::vector<FoundSide> sides = find_sides(set);
        ASSERT_EQ(sides.size(), 1u);
        EXPECT_EQ(sides[0], (FoundSide{2, reversed ? Hand::right : Hand::left, true}));
        EXPECT_EQ(sentences({sides[0]}).front(),
                  std::string("contour 3 is open; the object was taken to lie on its ") + (reversed ? "right" : "left"));
        for (const BoundaryPoint& point : prepare(set).points) {
            if (point.contour != 2) continue;
            EXPECT_GT(dot(point.inplane_normal, point.position - kPlane.origin), 0.95 * 20) << "outward";
        }
    }
}

TEST(FindSides, AloneTheObjectLiesTowardsTheMiddleAndAClickTellsOtherwise) {
    ContourSet set;
    for (int i = 0; i < 3; ++i) {
        Plane plane = kPlane;
        plane.origin += 6.0 * i * plane.normal;
        set.contours.push_back(arc(plane, 20));
    }
    ContourSet alone = set;
    EXPECT_EQ(find_sides(alone).size(), 3u);
    EXPECT_EQ(alone.contours[1].inside, Hand::left);

    set.interior = {kPlane.from_uv(22, 22) + 6.0 * kPlane.normal};
    set.exterior = {kPlane.from_uv(8, 8) + 6.0 * kPlane.normal};
    find_sides(set);
    for (const Contour& contour : set.contours) EXPECT_EQ(contour.inside, Hand::right);
}

TEST(FindSides, NeverOverruleWhatIsDeclared) {
    ContourSet set;
    set.contours = {arc(kPlane, 20)};
    set.contours[0].inside = Hand::right;
    EXPECT_TRUE(find_sides(set).empty());
    EXPECT_EQ(set.contours[0].inside, Hand::right);
}

TEST(FindSides, ManyOfOneSideAreOneSentence) {
    const std::vector<FoundSide> sides{{2, Hand::left, true}, {4, Hand::right, false}, {5, Hand::left, true}};
    EXPECT_EQ(sentences(sides),
              (std::vector<std::string>{
                  "2 contours are open, the first of them contour 3; the object was taken to lie on their left",
                  "contour 5 is open; the object was taken to lie on its right, which is doubtful"}));
}

}  // namespace
}  // namespace kontur
