// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/reslice.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "kontur/base/error.h"
#include "support/expect_error.h"

namespace kontur {
namespace {

/// Oblique, sheared, anisotropic and (with `mirrored`) left-handed.
Grid awkward_grid(bool mirrored) {
    Grid grid{{7, 6, 5}, {}};
    grid.index_to_mm.set_column(0, {0.8, 0.3, -0.2});
    grid.index_to_mm.set_column(1, {-0.4, 1.1, 0.5});
    grid.index_to_mm.set_column(2, (mirrored ? -1.0 : 1.0) * Vec3{0.6, -0.1, 2.5});
    grid.index_to_mm.translation = {-30, 40, 1500};
    return grid;
}

template <class Sample>
Image noise(const Grid& grid) {
    std::mt19937 random(7);
    std::vector<Sample> samples(static_cast<std::size_t>(grid.voxel_count()));
    for (Sample& s : samples) s = static_cast<Sample>(random() % 200);
    return {grid, samples};
}

class ResliceOnGrid : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(BothHands, ResliceOnGrid, testing::Bool());

TEST_P(ResliceOnGrid, PixelOnAVoxelCentreHasThatVoxelsValue) {
    const Image image = noise<std::int16_t>(awkward_grid(GetParam()));
    for (std::int64_t k = 0; k < 5; ++k)
        for (std::int64_t i = 0; i < 7; ++i) {
            Plane plane = make_plane(image.grid.center_mm(i, 2, k), {0.3, -0.5, 0.8});
            plane.origin = plane.from_uv(-3 * 0.7, -2 * 0.7);
            const auto pixels = reslice(image, {plane, 6, 5, 0.7}, -1);
            EXPECT_NEAR(pixels[2 * 6 + 3], sample(image, image.grid.offset(i, 2, k)), 1e-3);
        }
}

TEST_P(ResliceOnGrid, EveryPixelAgreesWithInterpolation) {
    const Image image = noise<float>(awkward_grid(GetParam()));
    const Plane plane = make_plane(image.grid.center_mm(3, 3, 2), {-0.2, 0.7, 0.4});
    const Reslice raster = centered_reslice(plane, 41, 33, 0.37);
    const auto pixels = reslice(image, raster, -5);
    const Affine3 mm_to_index = image.grid.index_to_mm.inverse();
    int outside = 0;
    for (int row = 0; row < raster.height; ++row)
        for (int column = 0; column < raster.width; ++column) {
            const Vec3 p = raster.plane.from_uv(column * raster.pixel_mm, row * raster.pixel_mm);
            const double expected = interpolate(image, mm_to_index, p, -5);
            EXPECT_NEAR(pixels[static_cast<std::size_t>(row * raster.width + column)], expected, 1e-3);
            outside += expected == -5;
        }
    EXPECT_GT(outside, 100);
    EXPECT_LT(outside, 41 * 33 - 100);
}

TEST_P(ResliceOnGrid, LinearRampIsReproducedOnAnObliquePlane) {
    Image image{awkward_grid(GetParam()), {}};
    const Vec3 slope{3, -2, 0.5};
    std::vector<float> ramp;
    for (std::int64_t k = 0; k < 5; ++k)
        for (std::int64_t j = 0; j < 6; ++j)
            for (std::int64_t i = 0; i < 7; ++i)
                ramp.push_back(
                    static_cast<float>(dot(slope, image.grid.center_mm(i, j, k) - image.grid.center_mm(0, 0, 0))));
    image.samples = ramp;
    const Reslice raster = centered_reslice(make_plane(image.grid.center_mm(3, 3, 2), {0.9, 0.1, -0.4}), 5, 5, 0.2);
    const auto pixels = reslice(image, raster, -1e9f);
    for (int row = 0; row < 5; ++row)
        for (int column = 0; column < 5; ++column) {
            const Vec3 p = raster.plane.from_uv(column * raster.pixel_mm, row * raster.pixel_mm);
            EXPECT_NEAR(pixels[static_cast<std::size_t>(5 * row + column)], dot(slope, p - image.grid.center_mm(0, 0, 0)),
                        1e-3);
        }
}

TEST(Reslice, CenteredRasterHasItsMiddleAtTheOrigin) {
    const Plane plane = make_plane({1, 2, 3}, {0, 1, 1});
    const Reslice raster = centered_reslice(plane, 11, 7, 0.5);
    EXPECT_NEAR(distance(raster.plane.from_uv(5 * 0.5, 3 * 0.5), plane.origin), 0, 1e-12);
}

TEST(Reslice, RefusesRastersWithoutPixelsOrSize) {
    const Image image = noise<std::uint8_t>(awkward_grid(false));
    EXPECT_KONTUR_ERROR(reslice(image, {{}, 0, 5, 1}, 0), ErrorKind::invalid_input, "0 x 5");
    EXPECT_KONTUR_ERROR(reslice(image, {{}, 5, 5, 0}, 0), ErrorKind::invalid_input, "pixel size");
    EXPECT_KONTUR_ERROR(reslice(image, {{}, 5, 5, NAN}, 0), ErrorKind::invalid_input, "pixel size");
    constexpr int kMost = std::numeric_limits<int>::max();
    EXPECT_KONTUR_ERROR(reslice(image, {{}, kMost, kMost, 1}, 0), ErrorKind::too_large, "at most 268435456");
}

}  // namespace
}  // namespace kontur
