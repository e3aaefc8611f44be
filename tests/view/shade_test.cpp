// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/shade.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "kontur/view/depth_buffer.h"
#include "support/bodies.h"

namespace kontur {
namespace {

using test::ball;

const Vec3 kFromFront{0, -1, 0};

TEST(Camera, ViewerInFrontSeesThePatientsLeftOnTheRightAndTheHeadOnTop) {
    const Camera camera{view_plane({10, 20, 30}, kFromFront), 100, 80, 0.5};
    EXPECT_EQ(camera.project({10, 20, 30}), (Vec3{50, 40, 0}));
    EXPECT_EQ(camera.project({11, 20, 30}), (Vec3{52, 40, 0}));
    EXPECT_EQ(camera.project({10, 20, 31}), (Vec3{50, 38, 0}));
    EXPECT_EQ(camera.project({10, 15, 30}), (Vec3{50, 40, 5}));
}

TEST(Camera, ViewPlaneIsOrthonormalAndRightHandedFromAnywhere) {
    for (const Vec3& d : {Vec3{1, 2, 3}, Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{-1, 0, 0}, Vec3{0.001, 0, 1}}) {
        const Plane plane = view_plane({}, d);
        EXPECT_NEAR(distance(cross(plane.u, plane.v), plane.normal), 0, 1e-12);
        EXPECT_NEAR(norm(plane.u), 1, 1e-12);
        EXPECT_NEAR(norm(plane.normal), 1, 1e-12);
        EXPECT_NEAR(dot(plane.normal, normalized(d)), -1, 1e-12);
    }
}

TEST(Camera, FitShowsEverythingWithItsMargin) {
    const TriangleMesh mesh = ball({5, 6, 7}, 20, 4);
    const Camera camera = fit_camera(view_plane({}, {1, -1, 0.5}), mesh.points, 300, 200, 0.1);
    double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
    for (const Vec3& p : mesh.points) {
        const Vec3 s = camera.project(p);
        left = std::min(left, s.x), right = std::max(right, s.x), top = std::min(top, s.y), bottom = std::max(bottom, s.y);
    }
    EXPECT_NEAR(top, 20, 1e-6);
    EXPECT_NEAR(bottom, 180, 1e-6);
    EXPECT_NEAR(left + right, 300, 1e-6);
}

TEST(RenderDepth, BallHasItsDepthNormalAndAreaEverywhere) {
    const Vec3 center{3, -4, 5};
    const Camera camera{view_plane(center, {0.4, -0.8, 0.3}), 120, 120, 0.2};
    const DepthBuffer buffer = render_depth(ball(center, 10, 5), camera, {.threads = 2});
    int covered = 0;
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 120; ++x) {
            const auto& pixel = buffer.at(x, y);
            const double u = (x + 0.5 - 60) * 0.2, v = (y + 0.5 - 60) * 0.2, r = std::hypot(u, v);
            if (pixel.is_covered()) ++covered;
            if (r > 9.5) continue;
            const double depth = std::sqrt(100 - r * r);
            EXPECT_NEAR(pixel.depth_mm, depth, 0.05);
            EXPECT_NEAR(pixel.normal[0], u / 10, 0.02);
            EXPECT_NEAR(pixel.normal[1], -v / 10, 0.02);
            EXPECT_NEAR(pixel.normal[2], depth / 10, 0.02);
        }
    EXPECT_NEAR(covered * 0.04, std::numbers::pi * 100, 1.5);
}

TEST(RenderDepth, LeavesNoGapBetweenTrianglesOfAnySize) {
    for (const int levels : {0, 2, 7}) {
        const Camera camera{view_plane({}, {0.3, -0.7, 0.6}), 64, 64, 0.01};
        const DepthBuffer buffer = render_depth(ball({}, 1, levels), camera, {.threads = 1});
        for (const auto& pixel : buffer.pixels) ASSERT_TRUE(pixel.is_covered()) << levels;
    }
}

TEST(RenderDepth, NearerSurfaceHidesTheFarther) {
    TriangleMesh mesh = ball({0, 0, 0}, 5, 3);
    const TriangleMesh front = ball({0, -50, 0}, 2, 3);
    for (const auto& [a, b, c] : front.triangles) {
        const auto shift = static_cast<std::uint32_t>(mesh.points.size());
        mesh.triangles.push_back({a + shift, b + shift, c + shift});
    }
    mesh.points.insert(mesh.points.end(), front.points.begin(), front.points.end());
    mesh.normals.insert(mesh.normals.end(), front.normals.begin(), front.normals.end());
    const DepthBuffer buffer = render_depth(mesh, {view_plane({}, kFromFront), 101, 101, 0.2}, {.threads = 1});
    EXPECT_NEAR(buffer.at(50, 50).depth_mm, 52, 0.1);
    EXPECT_NEAR(buffer.at(50, 30).depth_mm, 3, 0.1);
}

TEST(RenderDepth, ClipsWhatLiesBesideThePicture) {
    const DepthBuffer buffer =
        render_depth(ball({1000, 0, 0}, 5, 3), {view_plane({}, kFromFront), 50, 50, 0.2}, {.threads = 1});
    for (const auto& pixel : buffer.pixels) EXPECT_FALSE(pixel.is_covered());
}

TEST(RenderDepth, LeavesOutTrianglesThatAreNotFinite) {
    const Camera camera{view_plane({}, kFromFront), 200, 200, 0.2};
    const TriangleMesh whole = ball({}, 5, 3);
    for (const double bad : {std::nan(""), 1e300, -1e300, std::numeric_limits<double>::infinity()}) {
        TriangleMesh mesh = whole;
        const auto first = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.insert(mesh.points.end(), {{bad, 0, 0}, {0, bad, 0}, {0, 0, bad}});
        mesh.normals.resize(mesh.points.size());
        mesh.triangles.push_back({first, first + 1, first + 2});
        const DepthBuffer expected = render_depth(whole, camera, {.threads = 1}),
                          buffer = render_depth(mesh, camera, {.threads = 1});
        for (std::size_t i = 0; i < buffer.pixels.size(); ++i)
            ASSERT_EQ(buffer.pixels[i].depth_mm, expected.pixels[i].depth_mm) << bad;
    }
}

TEST(PointNormals, OfABallPointOutward) {
    TriangleMesh mesh = ball({1, 2, 3}, 7, 4);
    const auto exact = std::move(mesh.normals);
    const auto normals = point_normals(mesh);
    for (std::size_t i = 0; i < exact.size(); ++i) EXPECT_NEAR(dot(normals[i], exact[i]), 1, 1e-3);
}

double luminance(const ShadedSurface& s, int x, int y) {
    const std::uint32_t p = s.argb[static_cast<std::size_t>(y * s.width + x)];
    return (p >> 16 & 255) + (p >> 8 & 255) + (p & 255);
}

TEST(Shade, LightComesFromTheUpperLeftAndEdgesAreAntiAliased) {
    const ShadedSurface s = shade(ball({}, 10, 4), {view_plane({}, kFromFront), 100, 100, 0.25});
    EXPECT_GT(luminance(s, 30, 30), 1.3 * luminance(s, 70, 70));
    EXPECT_EQ(s.argb.front(), 0u);
    EXPECT_TRUE(std::isinf(s.depth_mm.front()));
    double area = 0;
    int partial = 0;
    for (const std::uint32_t p : s.argb) {
        area += (p >> 24) / 255.0;
        partial += p >> 24 > 0 && p >> 24 < 255;
    }
    EXPECT_NEAR(area, std::numbers::pi * 1600, 25);
    EXPECT_GT(partial, 100);
}

TEST(Shade, HollowIsDarkerThanTheSameSlopeInTheOpen) {
    const TriangleMesh pitted = test::star({}, 7, [](const Vec3& d) {
        return 10 - 5 * std::exp(-50 * (1 - dot(d, Vec3{0, -1, 0})));
    });
    const TriangleMesh smooth = ball({}, 10, 6);
    const Camera camera{view_plane({}, kFromFront), 480, 480, 0.05};
    EXPECT_LT(luminance(shade(pitted, camera), 240, 240), 0.8 * luminance(shade(smooth, camera), 240, 240));
}

TEST(Shade, SameBytesForAnyNumberOfThreads) {
    const TriangleMesh mesh = test::torus({}, 10, 4, 64);
    const Camera camera = fit_camera(view_plane({}, {1, -1, 1}), mesh.points, 150, 200, 0.05);
    const ShadedSurface one = shade(mesh, camera, {}, {.threads = 1});
    for (const int threads : {2, 5}) EXPECT_EQ(shade(mesh, camera, {}, {.threads = threads}).argb, one.argb);
}

TEST(Shade, EmptyMeshLeavesThePictureEmpty) {
    const ShadedSurface s = shade({}, {view_plane({}, kFromFront), 20, 10, 1});
    EXPECT_EQ(s.argb, std::vector<std::uint32_t>(200, 0u));
}

}  // namespace
}  // namespace kontur
