// SPDX-License-Identifier: Apache-2.0
// Objects that the image cuts off: there the image ends, and they go on.
#include <gtest/gtest.h>

#include <cmath>

#include "kontur/drawing/image_box.h"
#include "kontur/measure/compare.h"
#include "kontur/segment.h"
#include "support/drawn_bodies.h"
#include "support/mask_of.h"

namespace kontur {
namespace {

constexpr double kTop = 10;  // z of the image's border

Grid image_to(double top, double margin = 30) {
    const Vec3 low{-37 - margin, -33 - margin, -46 - margin};
    Grid grid{
        {static_cast<std::int64_t>(-low.x), static_cast<std::int64_t>(-low.y), static_cast<std::int64_t>((top - low.z) / 2)},
        {}};
    grid.index_to_mm.set_column(0, {2, 0, 0});
    grid.index_to_mm.set_column(1, {0, 2, 0});
    grid.index_to_mm.set_column(2, {0, 0, 2});
    grid.index_to_mm.translation = low + Vec3{1, 1, 1};
    return grid;
}

Body cut_ellipsoid() { return test::both(test::ellipsoid({}, {37, 33, 45}), test::half_space({0, 0, kTop}, {0, 0, 1})); }

std::vector<Plane> across_axes() {
    std::vector<Plane> planes = test::axial_planes({-30, -12});
    for (const double at : {-14.0, 4.0, 18.0}) {
        planes.push_back(make_plane({at, 0, 0}, {1, 0, 0}));
        planes.push_back(make_plane({0, at, 0}, {0, 1, 0}));
    }
    return planes;
}

Segmentation segment_on(const Grid& image, const ContourSet& set) { return segment(set, image, {.drawn_on = image}); }

/// Below the plane of the cut, on an image that ends there or farther up.
double dice(const std::vector<Plane>& planes, double image_top) {
    const Grid grid = image_to(kTop);
    const Body body = cut_ellipsoid();
    Mask mask = segment_on(image_to(image_top), test::drawn(body, planes)).mask;
    mask.grid = grid;
    mask.values.resize(static_cast<std::size_t>(grid.voxel_count()));
    return compare(mask, test::mask_of(grid, [&](const Vec3& p) { return body.value(p) > 0; })).dice;
}

void expect_gain(const std::vector<Plane>& planes, double least_gain) {
    const double cut = dice(planes, kTop), whole = dice(planes, kTop + 60);
    EXPECT_GT(cut, whole + least_gain) << cut << " " << whole;
}

TEST(CutOff, AStackOfSlicesGoesOnToTheBorder) {
    expect_gain(test::axial_planes({-36, -20, -4}), 0.003);
    expect_gain(test::axial_planes({-34, -4}), 0.002);
}

TEST(CutOff, LinesAlongTheBorderAreNoBorderOfTheObject) {
    expect_gain(across_axes(), 0.001);
    const Grid grid = image_to(kTop);
    const Segmentation made = segment_on(grid, test::drawn(cut_ellipsoid(), across_axes()));
    EXPECT_LT(made.report.residual.max_mm, 1);
    EXPECT_TRUE(sentences(made.report.section_check).empty());
}

TEST(CutOff, AnImageThatEndsElsewhereChangesNothing) {
    const ContourSet set = test::drawn(cut_ellipsoid(), across_axes());
    const Segmentation near = segment_on(image_to(kTop + 4), set), far = segment_on(image_to(kTop + 40), set);
    for (const Vec3& p : {Vec3{0, 0, 0}, {10, 5, 12}, {-20, 20, -20}, {0, 0, 30}})
        EXPECT_EQ(near.function.value(p), far.function.value(p));
}

TEST(CutOff, AGridThatIsNoImageCutsNothing) {
    const ContourSet set = test::drawn(test::ellipsoid({}, {37, 33, 45}), test::axial_planes({-30, -15, 0}));
    const Segmentation near = segment(set, image_to(4)), far = segment(set, image_to(80));
    for (const Vec3& p : {Vec3{0, 0, 0}, {10, 5, 12}, {-20, 20, -20}, {0, 0, 30}})
        EXPECT_EQ(near.function.value(p), far.function.value(p));
}

TEST(CutOff, AnImageThatLinesRunOutOfChangesNothing) {
    const ContourSet set = test::drawn(test::ellipsoid({}, {37, 33, 45}), across_axes());
    const Segmentation near = segment_on(image_to(kTop), set), far = segment_on(image_to(kTop + 80), set);
    for (const Vec3& p : {Vec3{0, 0, 0}, {10, 5, 12}, {-20, 20, -20}, {0, 0, 30}})
        EXPECT_EQ(near.function.value(p), far.function.value(p));
}

TEST(ImageBox, SaysHowFarItsBorderIs) {
    const ImageBox box(image_to(kTop));
    EXPECT_TRUE(box.contains(Vec3{0, 0, kTop - 0.1}));
    EXPECT_FALSE(box.contains(Vec3{0, 0, kTop + 0.1}));
    EXPECT_EQ(box.nearest({0, 0, kTop + 7}), (Vec3{0, 0, kTop}));
    EXPECT_NEAR(box.border_ahead_mm({0, 0, 0}, {0, 0, 1}), kTop, 1e-9);
    EXPECT_NEAR(box.border_ahead_mm({0, 0, 0}, normalized({0, 1, 1})), kTop * std::sqrt(2), 1e-9);
    EXPECT_EQ(box.border_ahead_mm({0, 0, kTop + 1}, {0, 0, 1}), 0);
    EXPECT_TRUE(box.is_border({0, 0, kTop - 1}, {0, 0, 1}));
    EXPECT_FALSE(box.is_border({0, 0, kTop - 1}, {0, 0, -1}));
    EXPECT_FALSE(box.is_border({0, 0, kTop - 1}, {1, 0, 0}));
    EXPECT_FALSE(box.is_border({0, 0, kTop - 3}, {0, 0, 1}));
}

}  // namespace
}  // namespace kontur
