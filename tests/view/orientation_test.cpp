// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/orientation.h"

#include <gtest/gtest.h>

namespace kontur {
namespace {

TEST(OrientationLetters, SixSidesOfThePatient) {
    EXPECT_EQ(orientation_letters({1, 0, 0}), "L");
    EXPECT_EQ(orientation_letters({-2, 0, 0}), "R");
    EXPECT_EQ(orientation_letters({0, 1, 0}), "P");
    EXPECT_EQ(orientation_letters({0, -1, 0}), "A");
    EXPECT_EQ(orientation_letters({0, 0, 9}), "S");
    EXPECT_EQ(orientation_letters({0, 0, -1}), "I");
}

TEST(OrientationLetters, WeakerSidesFollowOnlyWhenTheyCount) {
    EXPECT_EQ(orientation_letters({0.5, -0.8, 0.1}), "AL");
    EXPECT_EQ(orientation_letters({-0.2, 0.3, -0.9}), "IP");
    EXPECT_EQ(orientation_letters({0.99, 0.1, 0.1}), "L");
    EXPECT_EQ(orientation_letters({1, 1, 1}), "LPS");
}

TEST(EdgeLetters, RadiologicalConventionOfTheThreeSlices) {
    const auto expect = [](SliceKind kind, const char* left, const char* right, const char* top, const char* bottom) {
        const EdgeLetters letters = edge_letters(screen_plane(kind, {}));
        EXPECT_EQ(letters.left, left);
        EXPECT_EQ(letters.right, right);
        EXPECT_EQ(letters.top, top);
        EXPECT_EQ(letters.bottom, bottom);
    };
    expect(SliceKind::axial, "R", "L", "A", "P");
    expect(SliceKind::coronal, "R", "L", "S", "I");
    expect(SliceKind::sagittal, "A", "P", "S", "I");
}

TEST(ScreenPlane, FramesAreRightHandedAndOfTheirKind) {
    for (const SliceKind kind : {SliceKind::axial, SliceKind::coronal, SliceKind::sagittal}) {
        const Plane plane = screen_plane(kind, {1, 2, 3});
        EXPECT_EQ(cross(plane.u, plane.v), plane.normal);
        EXPECT_EQ(slice_kind(plane.normal), kind);
        EXPECT_EQ(slice_kind(-plane.normal + 0.4 * plane.u), kind);
        EXPECT_EQ(plane.origin, (Vec3{1, 2, 3}));
    }
}

TEST(Obliquity, IsTheAngleToTheNearestAxis) {
    EXPECT_NEAR(obliquity_deg({0, 0, -3}), 0, 1e-6);
    EXPECT_NEAR(obliquity_deg({0, std::sin(0.3), std::cos(0.3)}), 0.3 * 180 / 3.14159265358979, 1e-6);
    EXPECT_NEAR(obliquity_deg({1, 1, 1}), 54.7356, 1e-3);
}

}  // namespace
}  // namespace kontur
