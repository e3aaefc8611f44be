// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/slices.h"

#include <gtest/gtest.h>

#include <numbers>

#include "support/bodies.h"

namespace kontur {
namespace {

Contour circle(const Vec3& center, const Vec3& normal, double radius) {
    Contour contour;
    contour.plane = make_plane(center, normal);
    for (int i = 0; i < 60; ++i) {
        const double a = 2 * std::numbers::pi * i / 60;
        contour.points.push_back(contour.plane.from_uv(radius * std::cos(a), radius * std::sin(a)));
    }
    return contour;
}

TEST(ChooseSlices, WithoutContoursTheyLieInTheObjectsMiddle) {
    const auto slices = choose_slices(test::ball({10, 20, 30}, 5, 3), {}, nullptr);
    EXPECT_EQ(slices[0].kind, SliceKind::axial);
    EXPECT_EQ(slices[1].kind, SliceKind::coronal);
    EXPECT_EQ(slices[2].kind, SliceKind::sagittal);
    for (const Slice& slice : slices) {
        EXPECT_NEAR(distance(slice.plane.origin, {10, 20, 30}), 0, 1e-9);
        EXPECT_EQ(slice.plane.normal, screen_plane(slice.kind, {}).normal);
        EXPECT_NEAR(slice.width_mm, 10, 1e-9);
        EXPECT_NEAR(slice.height_mm, 10, 1e-9);
    }
}

TEST(ChooseSlices, LieWhereMostWasDrawn) {
    ContourSet set;
    set.contours = {circle({0, 0, 10}, {0, 0, 1}, 3), circle({0, 0, 14}, {0, 0, -1}, 5), circle({0, -2, 12}, {0, 1, 0}, 4)};
    const auto slices = choose_slices({}, set, nullptr);
    EXPECT_NEAR(slices[0].plane.origin.z, 14, 1e-9);
    EXPECT_TRUE(slices[0].contains(set.contours[1]));
    EXPECT_FALSE(slices[0].contains(set.contours[0]));
    EXPECT_NEAR(slices[1].plane.origin.y, -2, 1e-9);
    EXPECT_TRUE(slices[1].contains(set.contours[2]));
}

TEST(ChooseSlices, SeveralShortContoursInOneSliceOutweighALongerOne) {
    ContourSet set;
    set.contours = {circle({0, 0, 1}, {0, 0, 1}, 5), circle({-8, 0, 9}, {0, 0, 1}, 3), circle({8, 0, 9.2}, {0, 0, 1}, 3)};
    EXPECT_NEAR(choose_slices({}, set, nullptr)[0].plane.origin.z, 9.1, 0.11);
}

TEST(ChooseSlices, ContainsWithinHalfAnImageSlice) {
    Image image{{{10, 10, 10}, {}}, std::vector<float>(1000)};
    image.grid.index_to_mm.set_column(2, {0, 0, 4});
    ContourSet set;
    set.contours = {circle({5, 5, 20}, {0, 0, 1}, 3)};
    const Slice axial = choose_slices({}, set, &image)[0];
    EXPECT_DOUBLE_EQ(axial.thickness_mm, 4);
    EXPECT_TRUE(axial.contains(circle({5, 5, 21.9}, {0, 0, 1}, 3)));
    EXPECT_FALSE(axial.contains(circle({5, 5, 22.1}, {0, 0, 1}, 3)));
    EXPECT_FALSE(axial.contains(Contour{}));
}

TEST(ChooseSlices, TiltedStackTurnsAllThree) {
    const Vec3 normal = normalized({0.3, 0.2, 0.9});
    ContourSet set;
    for (int i = -3; i <= 3; ++i)
        set.contours.push_back(circle({10.0 * i * normal}, i % 2 ? normal : -normal, 20 - 0.1 * i * i));
    const auto slices = choose_slices({}, set, nullptr);
    EXPECT_NEAR(std::abs(dot(slices[0].plane.normal, normal)), 1, 1e-9);
    EXPECT_TRUE(slices[0].contains(set.contours[3]));
    for (const Slice& slice : slices) {
        EXPECT_EQ(slice_kind(slice.plane.normal), slice.kind);
        EXPECT_GT(dot(slice.plane.u, screen_plane(slice.kind, {}).u), 0.8);
        EXPECT_GT(dot(slice.plane.v, screen_plane(slice.kind, {}).v), 0.8);
        EXPECT_NEAR(distance(cross(slice.plane.u, slice.plane.v), slice.plane.normal), 0, 1e-9);
    }
    EXPECT_NEAR(dot(slices[0].plane.normal, slices[1].plane.normal), 0, 1e-9);
}

TEST(ChooseSlices, PlanesOfAllDirectionsKeepThePatientsAxes) {
    ContourSet set;
    for (const Vec3& n : {Vec3{1, 1, 1}, Vec3{1, -1, 1}, Vec3{-1, 1, 1}}) set.contours.push_back(circle({}, n, 10));
    for (const Slice& slice : choose_slices({}, set, nullptr))
        EXPECT_EQ(slice.plane.normal, screen_plane(slice.kind, {}).normal);
}

}  // namespace
}  // namespace kontur
