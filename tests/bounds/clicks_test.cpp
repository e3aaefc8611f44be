// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/clicks.h"

#include <gtest/gtest.h>

#include "kontur/drawing/drawn_planes.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

TEST(ClickBounds, AreMetByEveryPointThatLiesDeepEnoughAnyway) {
    ContourSet set;
    set.interior = {{1, 2, 3}};
    set.exterior = {{4, 5, 6}};
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    const std::vector<Bound> bounds = click_bounds(set, 0.5);
    ASSERT_EQ(bounds.size(), 2u);
    EXPECT_EQ(bounds[0].least_mm, 0.5);
    EXPECT_EQ(bounds[0].most_mm, kInfinite);
    EXPECT_EQ(bounds[1].least_mm, -kInfinite);
    EXPECT_EQ(bounds[1].most_mm, -0.5);
}

TEST(ContradictoryClicks, NameThePointTheContourAndTheDistance) {
    ContourSet set = test::three_circles();
    const Plane& plane = set.contours[1].plane;
    set.interior = {plane.from_uv(3, 3), plane.from_uv(14, 0)};
    set.exterior = {plane.from_uv(20, 0), plane.from_uv(0, 7) + 0.2 * plane.normal};
    const std::vector<std::string> found = contradictory_clicks(DrawnPlanes(set), 0.5);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0], "interior point 2 contradicts contour 2: it lies 4 mm on its outside");
    EXPECT_EQ(found[1], "exterior point 2 contradicts contour 2: it lies 2.96 mm on its inside") << "a chord, not an arc";
}

TEST(ContradictoryClicks, ManyAreToldInOneSentenceAfterTheFirstFive) {
    ContourSet set = test::three_circles();
    for (int n = 0; n < 200; ++n) set.surface.push_back({set.contours[1].plane.from_uv(30 + 0.1 * n, 0), {}});
    std::vector<std::string> found = contradictory_clicks(DrawnPlanes(set), 0.5);
    ASSERT_EQ(found.size(), 6u);
    for (std::size_t n = 0; n < 5; ++n)
        EXPECT_TRUE(found[n].starts_with("surface point " + std::to_string(n + 1) + " contradicts contour ")) << found[n];
    EXPECT_EQ(found[5], "195 more surface points contradict contours");
    set.surface.resize(6);
    found = contradictory_clicks(DrawnPlanes(set), 0.5);
    ASSERT_EQ(found.size(), 6u);
    EXPECT_EQ(found[5], "1 more surface point contradicts contours");
}

TEST(ContradictoryClicks, PointsFarFromEveryPlaneContradictNothingButEachOther) {
    ContourSet set = test::three_circles();
    const Plane& plane = set.contours[2].plane;
    set.interior = {plane.from_uv(11, 0) + 6.0 * plane.normal};
    set.exterior = {plane.from_uv(9, 0) + 6.0 * plane.normal, set.interior[0] + 0.3 * plane.u};
    EXPECT_EQ(
        contradictory_clicks(DrawnPlanes(set), 0.5),
        (std::vector<std::string>{"interior point 1 and exterior point 2 contradict each other: they are 0.3 mm apart"}));
}

}  // namespace
}  // namespace kontur
