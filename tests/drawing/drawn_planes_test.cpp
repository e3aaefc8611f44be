// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/drawn_planes.h"

#include <gtest/gtest.h>

#include "support/contour_sets.h"

namespace kontur {
namespace {

TEST(DrawnPlanes, NextIsTheNearestParallelOneAhead) {
    const Vec3 up = normalized({0.3, -0.5, 0.8});
    ContourSet set;
    for (const double height : {0.0, 9.0, 4.0, -6.0, 0.001})
        set.contours.push_back(test::circle(make_plane(height * up, height > 5 ? -up : up), 10, 60));
    set.contours.push_back(test::circle(make_plane(2 * up, normalized(up + 0.2 * set.contours[0].plane.u)), 10, 60));
    const DrawnPlanes planes(set);
    ASSERT_EQ(planes.sections.size(), 5u);
    const Plane& here = set.contours.front().plane;
    EXPECT_NEAR(planes.next(here, 1)->distance_mm, 4, 1e-12);
    EXPECT_EQ(planes.next(here, 1)->section, &planes.sections[2]);
    EXPECT_EQ(planes.next(here, -1)->section, &planes.sections[3]);
    EXPECT_FALSE(planes.next(planes.sections[3].plane, -1));
    EXPECT_EQ(planes.next(planes.sections[1].plane, 1)->section, &planes.sections[2]) << "seen from its other side";
}

}  // namespace
}  // namespace kontur
