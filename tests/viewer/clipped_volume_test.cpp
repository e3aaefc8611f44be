// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/clipped_volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "viewer/drawn_contours.h"

namespace kontur::viewer {
namespace {

/// A closed box with its faces turned outward.
TriangleMesh box(const Vec3& low, const Vec3& high) {
    TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.points.push_back({corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z});
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

/// From -0.5 to 39.5 mm along each axis.
Grid image() { return test::flat_image()->grid; }

TEST(ClippedVolume, OfWhatLiesInsideItIsTheWholeVolume) {
    const TriangleMesh mesh = box({3, 4, 5}, {10, 12, 20});
    EXPECT_NEAR(volume_within_mm3(mesh, image()), 7 * 8 * 15, 1e-9);
    EXPECT_NEAR(volume_within_mm3(mesh, image()), signed_volume_mm3(mesh), 1e-9);
    EXPECT_EQ(volume_within_mm3({}, image()), 0);
}

TEST(ClippedVolume, WhatLeavesTheImageOnAnySideIsNotCounted) {
    EXPECT_NEAR(volume_within_mm3(box({-10, 4, 5}, {10, 12, 20}), image()), 10.5 * 8 * 15, 1e-9);
    EXPECT_NEAR(volume_within_mm3(box({3, 30, 5}, {10, 60, 20}), image()), 7 * 9.5 * 15, 1e-9);
    EXPECT_NEAR(volume_within_mm3(box({3, 4, -9}, {10, 12, 90}), image()), 7 * 8 * 40.0, 1e-9);
    EXPECT_NEAR(volume_within_mm3(box({-9, -9, -9}, {90, 90, 90}), image()), 40.0 * 40 * 40, 1e-6);
    EXPECT_NEAR(volume_within_mm3(box({-30, -30, -30}, {-9, -9, -9}), image()), 0, 1e-9);
}

TEST(ClippedVolume, FollowsTurnedAndLeftHandedAxes) {
    Grid turned = image();
    const double s = std::sqrt(0.5);
    turned.index_to_mm.set_column(0, {s, s, 0});
    turned.index_to_mm.set_column(1, {-s, s, 0});
    // A large box holds the whole image, and what lies within is the image.
    EXPECT_NEAR(volume_within_mm3(box({-90, -90, -90}, {90, 90, 90}), turned), 64'000, 1e-6);
    Grid mirrored = image();
    mirrored.index_to_mm.set_column(0, {-1, 0, 0});
    EXPECT_NEAR(volume_within_mm3(box({-90, 4, 5}, {90, 12, 20}), mirrored), 40.0 * 8 * 15, 1e-6);
}

}  // namespace
}  // namespace kontur::viewer
