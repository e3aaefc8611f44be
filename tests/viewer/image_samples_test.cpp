// SPDX-License-Identifier: Apache-2.0
#include "viewer/images/image_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "viewer/images/views.h"

namespace kontur::viewer {
namespace {

/// Tilted, anisotropic, and `mirrored` along its first axis.
Grid tilted_grid(bool mirrored) {
    Grid grid{{23, 19, 9}, {}};
    const double c = std::cos(0.2), s = std::sin(0.2);
    grid.index_to_mm.set_column(0, (mirrored ? -0.8 : 0.8) * Vec3{c, s, 0});
    grid.index_to_mm.set_column(1, 0.8 * Vec3{-s, c, 0});
    grid.index_to_mm.set_column(2, {0, 0, 3});
    grid.index_to_mm.translation = {40, -12, 900};
    return grid;
}

Image noise_on(const Grid& grid) {
    std::mt19937 random(11);
    std::vector<std::int16_t> samples(static_cast<std::size_t>(grid.voxel_count()));
    for (std::int16_t& sample : samples) sample = static_cast<std::int16_t>(random() % 1000);
    return {grid, samples};
}

Reslice screen_of(const View& view, double pixel_mm) {
    return centered_reslice(view.plane, static_cast<int>(view.width_mm / pixel_mm) + 9,
                            static_cast<int>(view.height_mm / pixel_mm) + 5, pixel_mm);
}

/// What the page shows at a pixel: samples interpolated linearly along both sides, nothing beyond the outermost by more
/// than half a step.
float shown(const ImageSamples& samples, const std::vector<float>& values, int column, int row) {
    const double at[] = {(column - samples.first[0]) / samples.step[0], (row - samples.first[1]) / samples.step[1]};
    const int counts[] = {samples.raster.width, samples.raster.height};
    int from[2];
    double share[2];
    for (int side = 0; side < 2; ++side) {
        if (at[side] < -0.5 || at[side] > counts[side] - 0.5) return std::nanf("");
        const double inside = std::clamp(at[side], 0.0, counts[side] - 1.0);
        from[side] = std::min(static_cast<int>(inside), std::max(counts[side] - 2, 0));
        share[side] = inside - from[side];
    }
    const auto value = [&](int i, int j) {
        return values[static_cast<std::size_t>(std::min(from[0] + i, counts[0] - 1) +
                                               counts[0] * std::min(from[1] + j, counts[1] - 1))];
    };
    const auto along = [&](int j) { return std::lerp(value(0, j), value(1, j), static_cast<float>(share[0])); };
    return std::lerp(along(0), along(1), static_cast<float>(share[1]));
}

/// The largest and the mean difference from the screen's own pixels, among those that both show; and how many only one of
/// them shows.
struct Differences {
    double largest = 0, mean = 0;
    int unlike = 0, compared = 0;
};

Differences differences(const Image& image, const Reslice& screen) {
    const float nothing = std::nanf("");
    const ImageSamples samples = samples_for(image.grid, screen);
    const std::vector<float> values = reslice(image, samples.raster, nothing), pixels = reslice(image, screen, nothing);
    Differences found;
    for (int row = 0; row < screen.height; ++row)
        for (int column = 0; column < screen.width; ++column) {
            const float expected = pixels[static_cast<std::size_t>(column + row * screen.width)];
            const float got = shown(samples, values, column, row);
            if (std::isnan(expected) != std::isnan(got)) ++found.unlike;
            if (std::isnan(expected) || std::isnan(got)) continue;
            found.largest = std::max<double>(found.largest, std::abs(got - expected));
            found.mean += std::abs(got - expected);
            ++found.compared;
        }
    found.mean /= std::max(found.compared, 1);
    return found;
}

class SamplesOfTheImage : public testing::TestWithParam<bool> {
protected:
    Image image_ = noise_on(tilted_grid(GetParam()));
};
INSTANTIATE_TEST_SUITE_P(BothHands, SamplesOfTheImage, testing::Bool());

TEST_P(SamplesOfTheImage, AreItsVoxelsAndShowWhatTheScreensOwnPixelsDid) {
    for (const SliceKind kind : {SliceKind::axial, SliceKind::sagittal, SliceKind::coronal}) {
        View view = view_of(image_.grid, kind);
        view.plane.origin += 0.3 * view.plane.normal;  // between slices, too
        const Reslice screen = screen_of(view, 0.11);
        const Differences found = differences(image_, screen);
        EXPECT_LT(found.largest, 0.01);
        EXPECT_EQ(found.unlike, 0);
        const ImageSamples samples = samples_for(image_.grid, screen);
        const auto most = static_cast<int>(std::max({image_.grid.size.i, image_.grid.size.j, image_.grid.size.k}));
        EXPECT_LE(samples.raster.width, most);
        EXPECT_LE(samples.raster.height, most);
    }
}

TEST_P(SamplesOfTheImage, OfAnObliquePlaneShowItAllButForALittle) {
    const Reslice screen = screen_of(oblique_view(image_.grid), 0.06);
    const Differences found = differences(image_, screen);
    EXPECT_GT(samples_for(image_.grid, screen).pixels_per_sample(), 8);
    EXPECT_LT(found.mean, 0.035 * 1000);             // of noise, which no image is
    EXPECT_LT(found.unlike, 0.03 * found.compared);  // half a step at the image's end
}

TEST_P(SamplesOfTheImage, AreTheScreensPixelsWhereThoseAreCoarser) {
    const Reslice screen = screen_of(view_of(image_.grid, SliceKind::axial), 0.9);
    const ImageSamples samples = samples_for(image_.grid, screen);
    EXPECT_EQ(samples.pixels_per_sample(), 1);
    EXPECT_EQ(samples.raster.width, screen.width);
    EXPECT_EQ(samples.raster.height, screen.height);
    EXPECT_EQ(differences(image_, screen).largest, 0);
}

TEST_P(SamplesOfTheImage, OfAZoomedViewAreOnlyThoseThatItShows) {
    View view = view_of(image_.grid, SliceKind::axial);
    const Reslice screen = centered_reslice(view.plane, 200, 100, 0.02);  // 4 x 2 mm of it
    const ImageSamples samples = samples_for(image_.grid, screen);
    EXPECT_LE(samples.raster.width, 4 / 0.8 + 3);
    EXPECT_LE(samples.raster.height, 2 / 0.8 + 3);
    EXPECT_LT(differences(image_, screen).largest, 0.01);
}

TEST_P(SamplesOfTheImage, BesideTheImageAreFewAndShowNothing) {
    View view = view_of(image_.grid, SliceKind::axial);
    view.plane.origin += 500 * view.plane.u;
    const Reslice screen = centered_reslice(view.plane, 200, 100, 0.02);
    const ImageSamples samples = samples_for(image_.grid, screen);
    EXPECT_EQ(samples.raster.width, 1);
    EXPECT_EQ(differences(image_, screen).compared + differences(image_, screen).unlike, 0);
}

}  // namespace
}  // namespace kontur::viewer
