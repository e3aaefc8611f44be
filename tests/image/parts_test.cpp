// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kontur/image/appearance.h"
#include "kontur/image/walls.h"
#include "kontur/sampling/spread_points.h"
#include "support/lobed_body.h"

namespace kontur {
namespace {

using namespace test;

TEST(IntensityScale, IsMonotonousAndTurnsAroundWithTheImage) {
    std::vector<double> values, turned;
    Random random(3);
    for (int n = 0; n < 500; ++n) values.push_back(n % 3 == 0 ? -1000 : random.gaussian() * 40 + 60);
    for (const double v : values) turned.push_back(-2 * v + 5);
    const IntensityScale scale(values), opposite(turned);
    double last = -1;
    for (double v = -1200; v < 400; v += 7) {
        EXPECT_GE(scale(v), last);
        last = scale(v);
        EXPECT_NEAR(opposite(-2 * v + 5), 1 - scale(v), 1e-9) << v;
    }
    EXPECT_EQ(scale(-5000), 0);
    EXPECT_EQ(scale(1e9), 1);
}

TEST(IntensityScale, OfNothingIsTheMiddle) {
    EXPECT_EQ(IntensityScale({})(3), 0.5);
    EXPECT_EQ(IntensityScale({4, 4, 4, std::nan("")})(100), 0.5);
}

TEST(IsLabelMap, TellsMasksAndLabelMapsFromIntensities) {
    const Grid grid = cube_grid(2);
    EXPECT_TRUE(is_label_map(image_of(grid, [](const Vec3& p) { return lobed_depth(p) > 0 ? 1.0 : 0.0; })));
    EXPECT_TRUE(is_label_map(image_of(grid, [](const Vec3& p) { return lobed_depth(p) > 0 ? 180.0 : -60.5; })));
    EXPECT_TRUE(
        is_label_map(image_of(grid, [](const Vec3& p) { return lobed_depth(p) > 0 ? std::floor(p.z / 12) + 9 : 0.0; })));
    EXPECT_FALSE(is_label_map(image_of(grid, body_look)));
    Image empty = image_of(grid, [](const Vec3&) { return 7.0; });
    EXPECT_TRUE(is_label_map(empty)) << "an empty mask";
    std::get<std::vector<float>>(empty.samples).back() = 8.5;
    EXPECT_FALSE(is_label_map(empty));
    const Image noisy = image_of(
        grid, [](const Vec3& p) { return lobed_depth(p) > 0 ? 100.0 : 40.0; }, 8);
    Image whole = noisy;
    for (float& v : std::get<std::vector<float>>(whole.samples)) v = std::round(v);
    EXPECT_FALSE(is_label_map(noisy));
    EXPECT_FALSE(is_label_map(whole));
    for (float& v : std::get<std::vector<float>>(whole.samples)) v = std::max(v, 50.0F);
    EXPECT_FALSE(is_label_map(whole)) << "a background of one value is no label";
}

std::vector<MovingPoint> on_the_equator(double radius_mm) {
    std::vector<MovingPoint> points;
    for (int n = 0; n < 200; ++n) {
        const double angle = 2 * M_PI * n / 200;
        const Vec3 normal{std::cos(angle), std::sin(angle), 0};
        points.push_back({radius_mm * normal, normal});
    }
    return points;
}

TEST(Appearance, FindsTheOffsetOfABorderThatItHasLearnt) {
    const Image image = image_of(
        cube_grid(1), [](const Vec3& p) { return two_tissues(30 - norm(p)); }, 5);
    const Intensities intensities(image);
    const double step = intensities.step_mm();
    const std::vector<MovingPoint> examples = on_the_equator(30);
    const IntensityScale scale(intensities_across(intensities, examples, step, {.threads = 1}));
    const Appearance appearance(intensities, scale, examples, step, {.threads = 1});
    for (const double off : {-3.0, -1.0, 0.0, 2.0}) {
        const Vec3 normal = normalized({1, 0.5, 0.8});
        const std::vector<double> likelihood = appearance.log_likelihood({(30 - off) * normal, normal}, 10);
        const auto best = std::max_element(likelihood.begin(), likelihood.end()) - likelihood.begin() - 10;
        EXPECT_NEAR(static_cast<double>(best) * step, off, 0.75) << off;
    }
}

/// A dark body in a bright rind, and beyond that air, darker still. The rind is thick where the border was drawn, about the
/// equator, and thin elsewhere.
double rind_look(const Vec3& p) {
    const double depth = 30 - norm(p), rind = std::abs(p.z) < 8 ? 20 : 6;
    return depth > 0 ? 40 : depth > -rind ? 100 : 25;
}

TEST(Appearance, TakesNothingBeyondWhatItHasLearntForTheBody) {
    const Image image = image_of(cube_grid(1, 60), rind_look, 5);
    const Intensities intensities(image);
    const double step = intensities.step_mm();
    const std::vector<MovingPoint> examples = on_the_equator(30);
    const IntensityScale scale(intensities_across(intensities, examples, step, {.threads = 1}));
    const Appearance appearance(intensities, scale, examples, step, {.threads = 1});
    for (const Vec3& direction : {Vec3{0.3, 0.2, 1}, Vec3{0, 1, 1}, Vec3{-1, 0.4, -1}}) {
        const Vec3 normal = normalized(direction);
        const std::vector<double> likelihood = appearance.log_likelihood({30.0 * normal, normal}, 24);
        const auto best = std::max_element(likelihood.begin(), likelihood.end()) - likelihood.begin() - 24;
        EXPECT_NEAR(static_cast<double>(best) * step, 0, 1);
    }
}

TEST(Walls, AreTheDrawnPlanesAndBeyondTheEndsOfAStack) {
    const Walls walls{Drawing(drawn_on(stacked_planes()))};  // at -21, -11, 0, 10, 20: the median gap is 10
    std::vector<MovingPoint> points{
        {{30, 0, 5}, {0, 0, 1}}, {{0, 0, 24}, {0, 0, 1}}, {{0, 0, 24}, {1, 0, 0}}, {{0, 0, 29}, {0, 0, 1}}};
    walls.limit(points);
    EXPECT_NEAR(points[0].least_mm, -5, 1e-9);
    EXPECT_NEAR(points[0].most_mm, 5, 1e-9);
    EXPECT_NEAR(points[1].least_mm, -4, 1e-9);
    EXPECT_NEAR(points[1].most_mm, 2, 1e-9) << "0.6 gaps beyond the last plane";
    EXPECT_EQ(points[2].most_mm, std::numeric_limits<double>::infinity());
    EXPECT_NEAR(points[3].most_mm, 0, 1e-9);
}

TEST(Walls, AreNoneWhereAContourIsOpen) {
    ContourSet set = drawn_on(orthogonal_planes());
    set.contours[1].closed = false;  // z = 5
    set.contours[1].inside = Hand::left;
    std::vector<MovingPoint> points{{{0, 0, 12}, {0, 0, -1}}};
    Walls(Drawing(set)).limit(points);
    EXPECT_NEAR(points[0].most_mm, 20, 1e-9) << "the plane at z = -8 is the next";
}

TEST(SurfaceSamples, LieEvenlyAlongContours) {
    const ContourSet set = drawn_on({make_plane({0, 0, 1}, {0, 0, 1})});
    const std::vector<Vec3> points = along_contours(set, 2);
    EXPECT_NEAR(static_cast<double>(points.size()), length_mm(set) / 2, 1);
    for (std::size_t i = 1; i < points.size(); ++i) EXPECT_NEAR(distance(points[i], points[i - 1]), 2, 0.1);
}

}  // namespace
}  // namespace kontur
