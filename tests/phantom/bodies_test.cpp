// SPDX-License-Identifier: Apache-2.0
#include "kontur/phantom/bodies.h"

#include <gtest/gtest.h>

#include "kontur/phantom/depth.h"
#include "kontur/phantom/random.h"

namespace kontur {
namespace {

struct Census {
    double volume_ml = 0;
    Box3 extent;
};

Census census(const Body& body) {
    constexpr double kStep_mm = 1.5;
    Census result;
    const Box3 box = body.bounds();
    for (double z = box.min.z; z < box.max.z; z += kStep_mm)
        for (double y = box.min.y; y < box.max.y; y += kStep_mm)
            for (double x = box.min.x; x < box.max.x; x += kStep_mm)
                if (body.value({x, y, z}) > 0) {
                    result.volume_ml += kStep_mm * kStep_mm * kStep_mm / 1000;
                    result.extent.extend({x, y, z});
                }
    return result;
}

TEST(Bodies, HaveTheSizesOfOrgans) {
    struct Expected {
        Body body;
        double least_ml, most_ml;
        Vec3 size_mm;
    };
    for (const auto& [body, least_ml, most_ml, size_mm] :
         {Expected{liver(), 1200, 1900, {200, 153, 173}}, Expected{metastasis(), 20, 40, {43, 38, 39}},
          Expected{kidney(), 100, 200, {50, 46, 107}}, Expected{vertebra(), 30, 60, {77, 72, 33}}}) {
        const Census found = census(body);
        EXPECT_GT(found.volume_ml, least_ml) << body.name();
        EXPECT_LT(found.volume_ml, most_ml) << body.name();
        for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(found.extent.size()[axis], size_mm[axis], 4) << body.name() << axis;
    }
}

TEST(Bodies, AreOutsideOnAndBeyondTheirBounds) {
    Random random(seed_of("AreOutsideOnAndBeyondTheirBounds"));
    for (const Body& body : phantom_bodies()) {
        const Box3 near = body.bounds(), far = near.padded(60);
        for (int run = 0; run < 200000; ++run) {
            const Vec3 p{random.uniform(far.min.x, far.max.x), random.uniform(far.min.y, far.max.y),
                         random.uniform(far.min.z, far.max.z)};
            if (near.padded(-3).contains(p)) continue;
            ASSERT_LE(body.value(p), 0) << body.name() << " " << p.x << " " << p.y << " " << p.z;
        }
    }
}

TEST(Bodies, ShareNoPointExceptTheMetastasisInsideTheLiver) {
    const std::vector<Body> bodies = phantom_bodies();
    const Body all_liver = liver(), tumour = metastasis();
    for (const Body& body : bodies) {
        const Box3 box = body.bounds();
        for (double z = box.min.z; z < box.max.z; z += 2)
            for (double y = box.min.y; y < box.max.y; y += 2)
                for (double x = box.min.x; x < box.max.x; x += 2) {
                    const Vec3 p{x, y, z};
                    if (!(body.value(p) > 0)) continue;
                    int owners = 0;
                    for (const Body& other : bodies) owners += other.value(p) > 0;
                    const bool in_tumour = tumour.value(p) > 0;
                    ASSERT_EQ(owners, in_tumour ? 2 : 1) << body.name();
                    if (!in_tumour) continue;
                    ASSERT_GT(all_liver.value(p), 5) << "the metastasis lies well inside the liver";
                }
    }
}

TEST(Bodies, VertebraHasAnOpenSpinalCanalInABonyRing) {
    const Body bone = vertebra();
    const Vec3 center = bone.bounds().center();
    int ringed = 0;
    for (double z = bone.bounds().min.z; z < bone.bounds().max.z; z += 1) {
        const Vec3 canal{center.x, 55 + 25, z};
        ASSERT_LT(bone.value(canal), -5) << "z = " << z;
        bool walled = true;
        for (int degree = 0; degree < 360; degree += 2) {
            bool hit = false;
            for (double r = 0; r < 30 && !hit; r += 0.5)
                hit = bone.value(canal + Vec3{r * std::cos(degree * 0.0174533), r * std::sin(degree * 0.0174533), 0}) > 0;
            walled = walled && hit;
        }
        ringed += walled;
    }
    EXPECT_GE(ringed, 6) << "slices of 1 mm in which bone surrounds the canal";
}

TEST(Depth, EllipsoidIsExactForABall) {
    for (const double r : {0.1, 5.0, 9.9, 10.0, 25.0})
        EXPECT_NEAR(depth::ellipsoid(Vec3{r / std::sqrt(3.0), -r / std::sqrt(3.0), r / std::sqrt(3.0)}, {10, 10, 10}),
                    10 - r, 1e-12);
    EXPECT_EQ(depth::ellipsoid({0, 0, 0}, {3, 2, 4}), 2);
}

TEST(Depth, JoinIsTheLargerDepthAwayFromTheSeamAndSmoothAcross) {
    EXPECT_EQ(depth::join(3, -2, 4), 3);
    EXPECT_EQ(depth::intersect(3, -2, 4), -2);
    EXPECT_EQ(depth::subtract(9, -2, 4), 2);
    const double h = 1e-6;
    for (const double x : {-4.0, 0.0, 4.0}) {  // where the blend begins, is deepest and ends
        const double left = (depth::join(x, 0, 4) - depth::join(x - h, 0, 4)) / h;
        const double right = (depth::join(x + h, 0, 4) - depth::join(x, 0, 4)) / h;
        EXPECT_NEAR(left, right, 1e-5) << x;
    }
}

}  // namespace
}  // namespace kontur
