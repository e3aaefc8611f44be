// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/suggest_to_look_at.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kontur/base/error.h"
#include "support/mask_of.h"

namespace kontur {
namespace {

/// A rod along z of radius 10 that an image shows, and a mask of it that is 4 mm too wide for 12 mm around one height.
struct BulgingRod {
    explicit BulgingRod(double its_height) : height(its_height) {}

    double height;
    Grid grid = grid_around({{-24, -24, -40}, {24, 24, 40}}, {2, 2, 2}, 2);
    Mask right = test::mask_of(grid, [](const Vec3& p) { return std::hypot(p.x, p.y) < 10 && std::abs(p.z) < 36; });
    Mask mask = test::mask_of(grid, [this](const Vec3& p) {
        return std::hypot(p.x, p.y) < (std::abs(p.z - height) < 6 ? 14 : 10) && std::abs(p.z) < 36;
    });

    Image image() const {
        std::mt19937 random(47);
        std::normal_distribution<float> noise;
        std::vector<float> samples;
        for (const std::uint8_t inside : right.values) samples.push_back(4 * static_cast<float>(inside) + noise(random));
        return {grid, std::move(samples)};
    }
};

TEST(SuggestToLookAt, ThePlaneIsWhereTheBorderIsUnlikeTheImage) {
    for (const double height : {-15.0, 11.0}) {
        const BulgingRod rod(height);
        const Image image = rod.image();
        const ExistingSurface surface(rod.mask);
        for (const PlaneChoice planes : {PlaneChoice::image_slices, PlaneChoice::any}) {
            const std::vector<PlaneToLookAt> found = suggest_to_look_at(surface, image, 1, {planes});
            ASSERT_EQ(found.size(), 1U);
            EXPECT_EQ(found[0].slice.has_value() || planes == PlaneChoice::any, true);
            EXPECT_NEAR(std::abs(found[0].plane.normal.z), 1, 0.2);
            EXPECT_NEAR(found[0].plane.origin.z, height, 7);
            const double wrong_mm2 = 3.14159265 * (14 * 14 - 10 * 10);
            EXPECT_GT(found[0].doubtful_mm2, 0.5 * wrong_mm2);
            EXPECT_LT(found[0].doubtful_mm2, 1.5 * wrong_mm2);
        }
    }
}

TEST(SuggestToLookAt, WhatWasLookedAtCountsLess) {
    const BulgingRod rod(0);
    const Image image = rod.image();
    const ExistingSurface surface(rod.mask);
    const std::vector<PlaneToLookAt> found = suggest_to_look_at(surface, image, 3, {PlaneChoice::image_slices});
    ASSERT_EQ(found.size(), 3U);
    EXPECT_GT(found[0].doubtful_mm2, found[1].doubtful_mm2);
    EXPECT_GE(found[1].doubtful_mm2, found[2].doubtful_mm2);
    const std::vector<PlaneToLookAt> next =
        suggest_to_look_at(surface, image, 2, {PlaneChoice::image_slices, {found[0].plane}});
    ASSERT_EQ(next.size(), 2U);
    for (std::size_t n = 0; n < 2; ++n) {
        EXPECT_EQ(next[n].slice, found[n + 1].slice);
        EXPECT_EQ(next[n].doubtful_mm2, found[n + 1].doubtful_mm2);
    }
}

TEST(SuggestToLookAt, AnyNumberOfThreadsGivesTheSamePlanes) {
    const BulgingRod rod(5);
    const Image image = rod.image();
    const ExistingSurface surface(rod.mask);
    const auto planes = [&](int threads) {
        std::vector<Vec3> found;
        for (const PlaneToLookAt& one : suggest_to_look_at(surface, image, 3, {}, Work{.threads = threads})) {
            found.push_back(one.plane.origin);
            found.push_back(one.plane.normal);
        }
        return found;
    };
    EXPECT_EQ(planes(1), planes(3));
}

TEST(SuggestToLookAt, NeedsAnImageThatShowsTheBorderAndACount) {
    const BulgingRod rod(0);
    const ExistingSurface surface(rod.mask);
    EXPECT_THROW(suggest_to_look_at(surface, rod.image(), 0), Error);
    Image elsewhere = rod.image();
    elsewhere.grid.index_to_mm.translation.x += 500;
    EXPECT_THROW(suggest_to_look_at(surface, elsewhere), Error);
}

}  // namespace
}  // namespace kontur
