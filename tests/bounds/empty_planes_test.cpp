// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/empty_planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/contour_sets.h"
#include "support/functions.h"

namespace kontur {
namespace {

constexpr double kBallMm = 20;

/// Circles of a ball about the origin.
ContourSet ball(const std::vector<double>& heights) {
    ContourSet set;
    for (const double z : heights)
        set.contours.push_back(test::circle(make_plane({0, 0, z}, {0, 0, 1}), std::sqrt(kBallMm * kBallMm - z * z), 60));
    return set;
}

std::vector<Bound> bounds_of(const ContourSet& set, const Plane& empty) {
    const DrawnPlanes planes(set);
    return empty_plane_bounds(planes, drawn_regions(planes), empty);
}

TEST(EmptyPlanes, AreOutsideAllOverMoreTheFartherFromWhatIsShown) {
    const Plane empty = make_plane({0, 0, 18}, {0, 0, 1});
    const std::vector<Bound> bounds = bounds_of(ball({-6, 6}), empty);
    ASSERT_GT(bounds.size(), 50u);
    double nearest = 0, farthest = 0;
    for (const Bound& bound : bounds) {
        EXPECT_NEAR(empty.distance_to(bound.position), 0, 1e-9);
        EXPECT_LT(bound.most_mm, 0);
        EXPECT_GT(bound.noise_mm, 0);
        EXPECT_TRUE(std::isinf(bound.least_mm));
        (norm(bound.position - Vec3{0, 0, 18}) < 5 ? nearest : farthest) = bound.most_mm;
    }
    EXPECT_LT(farthest, nearest);
}

TEST(EmptyPlanes, SayNothingFarFromTheDrawing) {
    EXPECT_TRUE(bounds_of(ball({0}), make_plane({0, 0, 26}, {0, 0, 1})).empty());
}

TEST(EmptyPlanes, FadeOutAsContoursReachThroughThem) {
    const ContourSet upright = [] {
        ContourSet set;
        set.contours = {test::circle(make_plane({}, {1, 0, 0}), kBallMm, 180)};
        return set;
    }();
    double before = 0;
    for (const double through : {0.0, 0.35, 0.55, 0.75}) {  // of 40 mm: up to 1.9 %
        const std::vector<Bound> bounds = bounds_of(upright, make_plane({0, 0, kBallMm - through}, {0, 0, 1}));
        ASSERT_FALSE(bounds.empty()) << through;
        const double noise = bounds.front().noise_mm;
        EXPECT_GT(noise, 0.9 * before);
        before = noise;
    }
    EXPECT_TRUE(bounds_of(upright, make_plane({0, 0, kBallMm - 1}, {0, 0, 1})).empty());
    EXPECT_TRUE(bounds_of(upright, make_plane({}, {1, 0, 0})).empty());
}

TEST(EmptyPlanes, ContradictionsNameThePlaneAndTheContour) {
    ContourSet set = ball({-6, 6});
    set.contours.push_back(test::circle(make_plane({}, {1, 0, 0}), kBallMm, 60));
    set.empty_planes = {make_plane({0, 0, 26}, {0, 0, 1}), make_plane({0, 0, 12}, {0, 0, 1}),
                        make_plane({0, 0, -6}, {0, 0, 1})};
    const std::vector<std::string> found = contradicted_empty_planes(DrawnPlanes(set));
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0],
              "plane 2 in which nothing is seen is contradicted by contour 3, which reaches through it; the contour counts");
    EXPECT_EQ(found[1],
              "plane 3 in which nothing is seen is contradicted by contour 1, which lies in it; the contour counts");
}

TEST(EmptyPlanes, TurnMoveAndScaleWithTheDrawing) {
    const ContourSet here = ball({-6, 6});
    const Plane empty = make_plane({0, 0, 20}, normalized({0.2, 0, 1}));
    Affine3 motion = test::kOblique;
    motion.translation = {500, -70, 1200};
    ContourSet there = here;
    for (Contour& contour : there.contours) {
        contour.plane = make_plane(motion.apply(contour.plane.origin), motion.apply_linear(contour.plane.normal));
        for (Vec3& p : contour.points) p = motion.apply(p);
    }
    const std::vector<Bound> a = bounds_of(here, empty),
                             b = bounds_of(there, make_plane(motion.apply(empty.origin), motion.apply_linear(empty.normal)));
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t n = 0; n < a.size(); ++n) {
        EXPECT_NEAR(distance(motion.apply(a[n].position), b[n].position), 0, 1e-6);
        EXPECT_NEAR(a[n].most_mm, b[n].most_mm, 1e-6);
    }
}

}  // namespace
}  // namespace kontur
