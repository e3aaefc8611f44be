// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/caps.h"

#include <gtest/gtest.h>

#include "kontur/shape/section.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

const Vec3 kNormal = normalized({0.3, -0.5, 0.8});

/// Equal circles in planes at these heights along kNormal.
ContourSet stack(std::initializer_list<double> heights) {
    ContourSet set;
    for (const double h : heights) set.contours.push_back(test::circle(make_plane(h * kNormal, kNormal), 10, 60));
    return set;
}

std::vector<Cap> caps_of(const ContourSet& set) { return find_limits(DrawnPlanes(set)).caps; }

TEST(Caps, StackOfCirclesEndsOnePlaneSpacingBeyondItsLastOnes) {
    const std::vector<Cap> caps = caps_of(stack({0, 4, 8, 12}));
    int above = 0, below = 0;
    for (const Cap& cap : caps) {
        const double height = dot(cap.position, kNormal);
        const double beyond = std::max(height - 12, -height);
        EXPECT_GT(beyond, 0);
        EXPECT_LE(beyond, 4 + 1e-9) << height;
        EXPECT_LE(cap.most_mm, 0);
        (height > 6 ? above : below)++;
    }
    EXPECT_GT(above, 50);
    EXPECT_EQ(above, below);
}

TEST(Caps, TwoSlicesOfAWideObjectEndOneSpacingBeyondOrSayThatTheirThicknessIsAGuess) {
    for (const double spacing : {3.0, 1.0, 0.3, 0.15}) {
        const ContourSet set = stack({0, spacing});
        const Limits limits = find_limits(DrawnPlanes(set));
        double highest = 0;
        for (const Cap& cap : limits.caps) highest = std::max(highest, dot(cap.position, kNormal));
        const bool is_one_place = spacing < 0.01 * 20;
        EXPECT_NEAR(highest, spacing + (is_one_place ? 10 : spacing), 1e-9 + is_one_place) << spacing;
        EXPECT_EQ(limits.notes.size(), is_one_place ? 1u : 0u) << spacing;
    }
}

TEST(Caps, LowOnesKeepTheSectionInside) {
    const auto floor_of = [](double spacing) {
        std::vector<double> values;
        for (const Cap& cap : caps_of(stack({0, spacing})))
            if (cap.kind == ConstraintKind::interior) values.push_back(cap.least_mm);
        return values;
    };
    EXPECT_TRUE(floor_of(4).empty());
    EXPECT_GT(floor_of(1).size(), 100u);
    for (const double least : floor_of(1)) {
        EXPECT_GT(least, 0);
        EXPECT_LT(least, 1);
    }
}

TEST(Caps, LeakProbesFillTheBallBeyondTheEnds) {
    const ContourSet set = stack({0, 1});
    int above = 0, below = 0;
    for (const Cap& probe : find_limits(DrawnPlanes(set)).leak_probes) {
        const double height = dot(probe.position, kNormal);
        EXPECT_LT(probe.value_mm, 0);
        above += height > 10;
        below += height < -9;
        EXPECT_LE(distance(probe.position, 0.5 * kNormal), 2 * 10.02 + 1e-9);
    }
    EXPECT_GT(above, 15);
    EXPECT_EQ(above, below);
}

TEST(Caps, SingleCircleEndsAtItsRadius) {
    double highest = 0;
    for (const Cap& cap : caps_of(stack({0}))) highest = std::max(highest, std::abs(dot(cap.position, kNormal)));
    EXPECT_NEAR(highest, 10, 1);
}

TEST(Caps, NoneWhereOtherContoursLeadOn) {
    ContourSet set;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 normal{};
        normal[axis] = 1;
        set.contours.push_back(test::circle(make_plane({}, normal), 10, 60));
    }
    EXPECT_TRUE(caps_of(set).empty());
}

TEST(Caps, BranchThatTheNextPlaneDoesNotShowEndsBeforeIt) {
    ContourSet set = stack({0, 4, 8});
    Contour branch = test::circle(set.contours[1].plane, 3, 30);
    for (Vec3& p : branch.points) p += 30 * set.contours[1].plane.u;
    set.contours.push_back(branch);
    int near_branch = 0;
    for (const Cap& cap : caps_of(set)) {
        const Vec3 from = cap.position - set.contours[1].plane.from_uv(30, 0);
        if (norm(from) < 5) {
            ++near_branch;
            EXPECT_LE(std::abs(dot(from, kNormal)), 4 + 1e-9);
        }
    }
    EXPECT_GE(near_branch, 2);
}

TEST(Caps, MoveAndScaleWithTheContours) {
    const ContourSet set = stack({0, 4, 8});
    ContourSet large = set;
    for (Contour& contour : large.contours) {
        contour.plane.origin = 3.0 * contour.plane.origin + Vec3{900, -500, 100};
        for (Vec3& p : contour.points) p = 3.0 * p + Vec3{900, -500, 100};
    }
    const std::vector<Cap> here = caps_of(set), there = caps_of(large);
    ASSERT_EQ(here.size(), there.size());
    for (std::size_t i = 0; i < here.size(); ++i) {
        EXPECT_LT(distance(3.0 * here[i].position + Vec3{900, -500, 100}, there[i].position), 1e-6);
        EXPECT_NEAR(3 * here[i].most_mm, there[i].most_mm, 1e-6);
    }
}

}  // namespace
}  // namespace kontur
