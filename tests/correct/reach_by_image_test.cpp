// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/reach_by_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "kontur/correct_mask.h"
#include "support/mask_of.h"

namespace kontur {
namespace {

/// A rod along z of radius 12, a mask that is 5 mm too thick in the middle, and the rod's outline in some planes.
struct ThickRod {
    Grid grid = grid_around({{-22, -22, -44}, {22, 22, 44}}, {2, 2, 2}, 2);
    Mask right = test::mask_of(grid, [](const Vec3& p) { return std::hypot(p.x, p.y) < 12 && std::abs(p.z) < 40; });
    Mask mask = test::mask_of(
        grid, [](const Vec3& p) { return std::hypot(p.x, p.y) < (std::abs(p.z) < 30 ? 17 : 12) && std::abs(p.z) < 40; });
    ExistingSurface surface{mask};

    static Corrections outlines(const std::vector<double>& heights) {
        Corrections corrections;
        for (const double z : heights) {
            const Plane plane = make_plane({0, 0, z}, {0, 0, 1});
            Contour contour{plane, {}};
            for (int n = 0; n < 90; ++n) {
                const double angle = 2 * std::numbers::pi * n / 90;
                contour.points.push_back(plane.from_uv(12 * std::cos(angle), 12 * std::sin(angle)));
            }
            corrections.drawing.contours.push_back(contour);
        }
        return corrections;
    }

    /// The rod brighter than what is around it by `contrast` times the noise.
    Image image(double contrast) const {
        std::mt19937 random(7);
        std::normal_distribution<float> noise;
        std::vector<float> samples;
        for (const std::uint8_t inside : right.values)
            samples.push_back(static_cast<float>(contrast * inside) + noise(random));
        return {grid, std::move(samples)};
    }

    std::size_t wrong(const Mask& made) const {
        std::size_t count = 0;
        for (std::size_t n = 0; n < made.values.size(); ++n) count += made.values[n] != right.values[n];
        return count;
    }
};

TEST(ReachByImage, ACorrectionGoesAsFarAsTheImageShows) {
    const ThickRod rod;
    const Corrections corrections = ThickRod::outlines({-13, 1, 15});
    const Image image = rod.image(8);
    const CorrectedMask without = correct(rod.mask, rod.surface, corrections);
    const CorrectedMask with = correct({rod.mask, rod.surface, &image}, corrections);
    EXPECT_LT(rod.wrong(with.mask), 0.2 * static_cast<double>(rod.wrong(without.mask)));
    ASSERT_TRUE(with.report.image);
    EXPECT_EQ(with.report.image->weight, kMostImageWeight);
    EXPECT_EQ(with.report.image->planes, 3U);
    EXPECT_LT(with.report.image->wrong_with, with.report.image->wrong_without);
    EXPECT_GT(with.report.removed_image, 100);
    EXPECT_NE(sentence(*with.report.image).find("decided"), std::string::npos);
}

TEST(ReachByImage, AnImageThatShowsNothingChangesNothing) {
    const ThickRod rod;
    const Corrections corrections = ThickRod::outlines({-13, 1, 15});
    const Image image = rod.image(0);
    const CorrectedMask with = correct({rod.mask, rod.surface, &image}, corrections);
    ASSERT_TRUE(with.report.image);
    EXPECT_EQ(with.mask.values, correct(rod.mask, rod.surface, corrections).mask.values) << sentence(*with.report.image);
    EXPECT_EQ(with.report.removed_image + with.report.added_image, 0);
}

TEST(ReachByImage, IsAskedFromThreePlanesOn) {
    const ThickRod rod;
    const Corrections corrections = ThickRod::outlines({-13, 15});
    const Image image = rod.image(8);
    const CorrectedMask with = correct({rod.mask, rod.surface, &image}, corrections);
    EXPECT_EQ(with.mask.values, correct(rod.mask, rod.surface, corrections).mask.values);
    ASSERT_TRUE(with.report.image);
    EXPECT_EQ(with.report.image->planes, 0U);
    EXPECT_NE(sentence(*with.report.image).find("three"), std::string::npos);
}

TEST(ReachByImage, CorrectionsThatRepeatTheMaskChangeNothing) {
    const ThickRod rod;
    Corrections corrections;
    for (const double z : {-13.0, 1.0, 15.0}) corrections.confirmed.push_back(make_plane({0, 0, z}, {0, 0, 1}));
    const Image image = rod.image(8);
    EXPECT_EQ(correct({rod.mask, rod.surface, &image}, corrections).mask.values, rod.mask.values);
}

TEST(ReachByImage, DrawnPlanesStayAsDrawnAndTheOriginSaysWhatTheImageMade) {
    const ThickRod rod;
    const Image image = rod.image(8);
    const CorrectedMask with = correct({rod.mask, rod.surface, &image}, ThickRod::outlines({-13, 1, 15}));
    const Index3 size = rod.grid.size;
    std::size_t in_drawn = 0;
    for (std::size_t n = 0; n < with.origin.size(); ++n) {
        const auto made = static_cast<CorrectedVoxel>(with.origin[n]);
        const bool by_image = made == CorrectedVoxel::added_image || made == CorrectedVoxel::removed_image;
        const double z = rod.grid.center_mm(0, 0, static_cast<std::int64_t>(n) / (size.i * size.j)).z;
        const bool was = rod.mask.values[n] != 0, is = with.mask.values[n] != 0;
        if (by_image) {
            EXPECT_GT(std::min({std::abs(z + 13), std::abs(z - 1), std::abs(z - 15)}), 1);
            EXPECT_EQ(is, made == CorrectedVoxel::added_image);
            EXPECT_NE(is, was);
        }
        in_drawn += made == CorrectedVoxel::removed_drawn;
    }
    EXPECT_GT(in_drawn, 100U);
}

TEST(ReachByImage, AnyNumberOfThreadsGivesTheSameBytes) {
    const ThickRod rod;
    const Image image = rod.image(4);
    Work one, three;
    one.threads = 1;
    three.threads = 3;
    const Corrections corrections = ThickRod::outlines({-13, 1, 15});
    EXPECT_EQ(correct({rod.mask, rod.surface, &image}, corrections, {}, one).origin,
              correct({rod.mask, rod.surface, &image}, corrections, {}, three).origin);
}

}  // namespace
}  // namespace kontur
