// SPDX-License-Identifier: Apache-2.0
#include "kontur/phantom/phantom.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "kontur/phantom/frames.h"
#include "kontur/phantom/noise.h"
#include "kontur/phantom/volumes.h"
#include "support/expect_error.h"

namespace kontur {
namespace {

const std::vector<std::int16_t>& samples(const Image& image) { return std::get<std::vector<std::int16_t>>(image.samples); }

Grid coarse_abdomen() { return grid_around({{-198, -138, -108}, {198, 126, 100}}, {3, 3, 6}, 0); }

/// Mean and standard deviation of the image over the voxels deeper than `depth_mm` in the body.
std::pair<double, double> density_inside(const Image& image, const Body& body, double depth_mm) {
    double count = 0, sum = 0, squares = 0;
    const Grid& grid = image.grid;
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i)
                if (body.value(grid.center_mm(i, j, k)) > depth_mm) {
                    const double hu = samples(image)[grid.offset(i, j, k)];
                    ++count, sum += hu, squares += hu * hu;
                }
    const double mean = sum / count;
    return {mean, std::sqrt(squares / count - mean * mean)};
}

TEST(Phantom, HasTheDensitiesOfAnEnhancedCt) {
    const Image image = make_phantom_image(coarse_abdomen(), {.noise_hu = 0});
    EXPECT_NEAR(density_inside(image, liver(), 5).first, 110, 6) << "with its vessels and the metastasis";
    EXPECT_NEAR(density_inside(image, metastasis(), 5).first, 68, 1);
    EXPECT_NEAR(density_inside(image, kidney(), 0).first, 165, 15);
    EXPECT_NEAR(density_inside(image, vertebra(), 3).first, 210, 40);

    const auto [least, most] = std::ranges::minmax(samples(image));
    EXPECT_EQ(least, -1000);
    EXPECT_GT(most, 350);
    EXPECT_EQ(samples(image).front(), -1000) << "air around the body";
    const auto share = [&](double low, double high) {
        return static_cast<double>(std::ranges::count_if(samples(image), [&](double hu) { return hu > low && hu < high; })) /
               static_cast<double>(image.grid.voxel_count());
    };
    EXPECT_GT(share(-130, -70), 0.15) << "fat";
    EXPECT_GT(share(40, 130), 0.15) << "soft tissue";
    EXPECT_GT(share(-900, -800), 0.01) << "lung";
    EXPECT_GT(share(200, 700), 0.01) << "bone";
}

TEST(Phantom, NoiseHasItsStatedDeviationAndIsCorrelated) {
    const Grid grid{{64, 64, 16}, {}};
    const CorrelatedNoise noise(grid, 7, 14);
    double count = 0, squares = 0, neighbours = 0, sum = 0;
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j) {
            const std::vector<double> row = noise.row(j, k), next = noise.row(j + 1, k);
            for (std::size_t i = 0; i < row.size(); ++i, ++count) {
                sum += row[i];
                squares += row[i] * row[i];
                neighbours += row[i] * next[i];
            }
        }
    EXPECT_NEAR(sum / count, 0, 0.5);
    EXPECT_NEAR(std::sqrt(squares / count), 14, 0.4);
    EXPECT_NEAR(neighbours / squares, 2.0 / 3.0, 0.03) << "of the kernel 1 2 1";
}

TEST(Phantom, DependsOnTheSeedButNotOnTheNumberOfThreads) {
    const Grid grid = oblique(coarse_abdomen());
    const Image one = make_phantom_image(grid, {.seed = 3}, {.threads = 1});
    for (const int threads : {2, 5})
        EXPECT_EQ(samples(make_phantom_image(grid, {.seed = 3}, {.threads = threads})), samples(one));
    EXPECT_NE(samples(make_phantom_image(grid, {.seed = 4})), samples(one));
    EXPECT_EQ(make_truth_mask(liver(), grid, {.threads = 1}).values, make_truth_mask(liver(), grid, {.threads = 5}).values);
}

TEST(Phantom, TruthMasksHoldTheVoxelsWhoseCentresAreInside) {
    for (const Grid& grid : {coarse_abdomen(), oblique(coarse_abdomen())})
        for (const Body& body : phantom_bodies()) {
            const Mask mask = make_truth_mask(body, grid);
            for (std::int64_t k = 0; k < grid.size.k; ++k)
                for (std::int64_t j = 0; j < grid.size.j; ++j)
                    for (std::int64_t i = 0; i < grid.size.i; ++i)
                        ASSERT_EQ(mask.values[grid.offset(i, j, k)] != 0, body.value(grid.center_mm(i, j, k)) > 0)
                            << body.name();
        }
}

TEST(Phantom, EdgesOfBodiesShowInTheImageWhereTheirTruthEnds) {
    const Grid grid = grid_around(kidney().bounds(), {1, 1, 2}, 2);
    const Image image = make_phantom_image(grid, {.noise_hu = 0});
    const Body body = kidney();
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i) {
                const double depth = body.value(grid.center_mm(i, j, k)), hu = samples(image)[grid.offset(i, j, k)];
                if (depth > 1.3) {
                    ASSERT_GE(hu, 149) << depth;
                }
                if (depth > -0.1 && depth < 0.1) {
                    ASSERT_LT(hu, 160) << "half of it belongs to a neighbour, which is never denser";
                }
            }
}

TEST(Phantom, VolumesShowTheirBodiesWholeAndShareOneFrame) {
    std::set<std::string> names;
    for (const PhantomVolume& volume : phantom_volumes()) {
        names.insert(volume.name);
        EXPECT_FALSE(volume.bodies.empty()) << volume.name;
        for (const Body& body : volume.bodies) {
            const Mask mask = make_truth_mask(body, volume.grid);
            const Index3& n = volume.grid.size;
            std::int64_t inside = 0, on_border = 0;
            for (std::int64_t k = 0; k < n.k; ++k)
                for (std::int64_t j = 0; j < n.j; ++j)
                    for (std::int64_t i = 0; i < n.i; ++i) {
                        if (mask.values[volume.grid.offset(i, j, k)] == 0) continue;
                        ++inside;
                        on_border += i == 0 || j == 0 || k == 0 || i == n.i - 1 || j == n.j - 1 || k == n.k - 1;
                    }
            EXPECT_GT(inside, 5000) << volume.name << " " << body.name();
            EXPECT_EQ(on_border, 0) << volume.name << " " << body.name();
        }
    }
    EXPECT_EQ(names, (std::set<std::string>{"abdomen", "abdomen_oblique", "liver", "metastasis"}));
}

TEST(Phantom, ObliqueGridIsARigidlyTurnedCopyAboutItsCentre) {
    const Grid straight = coarse_abdomen(), turned = oblique(straight);
    EXPECT_EQ(turned.size, straight.size);
    EXPECT_NEAR(turned.voxel_volume_mm3(), straight.voxel_volume_mm3(), 1e-9);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(turned.spacing_mm()[axis], straight.spacing_mm()[axis], 1e-12);
        EXPECT_NEAR(dot(turned.index_to_mm.column(axis), turned.index_to_mm.column((axis + 1) % 3)), 0, 1e-12);
        EXPECT_LT(dot(normalized(turned.index_to_mm.column(axis)), normalized(straight.index_to_mm.column(axis))), 0.99);
    }
    EXPECT_GT(turned.index_to_mm.determinant(), 0);
}

TEST(Phantom, RefusesImpossibleNoise) {
    EXPECT_KONTUR_ERROR(make_phantom_image(coarse_abdomen(), {.noise_hu = -1}), ErrorKind::invalid_input, "noise_hu");
    EXPECT_KONTUR_ERROR(make_phantom_image(Grid{}, {}), ErrorKind::invalid_input, "");
}

}  // namespace
}  // namespace kontur
