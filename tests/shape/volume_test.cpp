// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kontur/base/error.h"
#include "support/expect_error.h"

namespace kontur {
namespace {

Grid small_grid() {
    Grid grid{{3, 4, 5}, {}};
    grid.index_to_mm.set_column(0, {1.5, 0.2, 0});
    grid.index_to_mm.set_column(1, {0, 0, 2});
    grid.index_to_mm.set_column(2, {0, 3, 0});
    grid.index_to_mm.translation = {-7, 8, 9};
    return grid;
}

template <typename Value, typename Function>
Image image_of(const Grid& grid, const Function& function) {
    std::vector<Value> values;
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i)
                values.push_back(
                    static_cast<Value>(function(static_cast<int>(i), static_cast<int>(j), static_cast<int>(k))));
    return {grid, values};
}

std::string message_of_count(const Image& image, std::size_t max_labels) {
    try {
        count_labels(image, max_labels);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
        return error.what();
    }
    ADD_FAILURE() << "no Error";
    return {};
}

TEST(Interpolate, ReproducesATrilinearFunction) {
    const auto function = [](double i, double j, double k) { return 1 + 2 * i - 3 * j + 0.5 * k + i * j * k; };
    const Image image = image_of<float>(small_grid(), function);
    const Affine3 mm_to_index = image.grid.index_to_mm.inverse();
    for (double i : {0.0, 0.25, 1.5, 2.0})
        for (double j : {0.0, 1.75, 3.0})
            for (double k : {0.0, 2.5, 4.0})
                EXPECT_NEAR(interpolate(image, mm_to_index, image.grid.index_to_mm.apply({i, j, k}), -1), function(i, j, k),
                            1e-5);
}

TEST(Interpolate, HoldsTheOutermostValueForHalfAVoxelAndEndsThere) {
    const Image image = image_of<std::int16_t>(small_grid(), [](auto i, auto, auto) { return 100 * i; });
    const Affine3 mm_to_index = image.grid.index_to_mm.inverse();
    const auto at = [&](const Vec3& index) {
        return interpolate(image, mm_to_index, image.grid.index_to_mm.apply(index), -9);
    };
    EXPECT_NEAR(at({-0.49, 0, 0}), 0, 1e-9);
    EXPECT_NEAR(at({2.49, 3.49, 4.49}), 200, 1e-9);
    for (const Vec3 index : {Vec3{-0.51, 0, 0}, Vec3{2.51, 0, 0}, Vec3{0, -0.51, 0}, Vec3{0, 3.51, 0}, Vec3{0, 0, 4.51}})
        EXPECT_EQ(at(index), -9);
    EXPECT_EQ(at({std::nan(""), 0, 0}), -9);
}

TEST(SelectLabel, ComparesAsNumbers) {
    const Image image = image_of<float>(small_grid(), [](auto i, auto j, auto) { return i == 1 ? 7.0 : j == 0 ? -0.5 : 0; });
    const Mask seven = select_label(image, 7), none = select_label(image, 8), nonzero = select_nonzero(image);
    std::int64_t sevens = 0, nones = 0, nonzeros = 0;
    for (std::size_t offset = 0; offset < seven.values.size(); ++offset) {
        EXPECT_EQ(seven.values[offset], sample(image, offset) == 7);
        sevens += seven.values[offset];
        nones += none.values[offset];
        nonzeros += nonzero.values[offset];
    }
    EXPECT_EQ(sevens, 20);
    EXPECT_EQ(nones, 0);
    EXPECT_EQ(nonzeros, 20 + 10);
    EXPECT_EQ(seven.grid, image.grid);
}

TEST(CountLabels, CountsEveryValueButZero) {
    const auto function = [](auto i, auto, auto k) { return i == 0 ? 0 : k == 4 ? -3 : 300; };
    const std::map<std::int64_t, std::int64_t> expected{{-3, 8}, {300, 32}};
    EXPECT_EQ(count_labels(image_of<std::int16_t>(small_grid(), function)), expected);
    EXPECT_EQ(count_labels(image_of<std::int32_t>(small_grid(), function)), expected);
    EXPECT_EQ(count_labels(image_of<float>(small_grid(), function)), expected);
}

TEST(CountLabels, RefusesFractionsNamingTheirNumber) {
    const Image image = image_of<float>(small_grid(), [](auto i, auto, auto) { return i == 0 ? 0.25 : 1; });
    EXPECT_NE(message_of_count(image, 10).find("20 voxels"), std::string::npos);
    for (const double value : {std::nan(""), std::numeric_limits<double>::infinity(), 1e30})
        EXPECT_FALSE(message_of_count(image_of<float>(small_grid(), [&](auto, auto, auto) { return value; }), 10).empty());
}

TEST(CountLabels, RefusesAnImageWithTooManyValues) {
    const Image image = image_of<std::int16_t>(small_grid(), [](auto i, auto j, auto k) { return i + 3 * j + 12 * k; });
    EXPECT_EQ(count_labels(image, 59).size(), 59u);
    EXPECT_NE(message_of_count(image, 58).find("58"), std::string::npos);
}

TEST(SelectMask, TakesTheLoneLabelOrTheChosenOne) {
    const auto lone = image_of<std::int16_t>(small_grid(), [](auto i, auto, auto) { return i == 0 ? 0 : -7; });
    const auto two = image_of<float>(small_grid(), [](auto i, auto, auto) { return i; });
    EXPECT_EQ(select_mask(lone, {}, "it").values, select_nonzero(lone).values);
    EXPECT_EQ(select_mask(lone, -7, "it").values, select_nonzero(lone).values);
    EXPECT_EQ(select_mask(two, 2, "it").values, select_label(two, 2).values);
    const auto none = image_of<std::uint8_t>(small_grid(), [](auto, auto, auto) { return 0; });
    EXPECT_TRUE(bounding_box(select_mask(none, {}, "it")).is_empty());
}

TEST(SelectMask, RefusesWhatLeavesAChoiceAndNamesIt) {
    const auto two = image_of<std::uint8_t>(small_grid(), [](auto i, auto, auto) { return i; });
    const auto halves = image_of<float>(small_grid(), [](auto i, auto, auto) { return 0.5 * i; });
    EXPECT_KONTUR_ERROR(select_mask(two, {}, "it"), ErrorKind::invalid_input, "it has 2 labels; choose one of 1, 2");
    EXPECT_KONTUR_ERROR(select_mask(two, 3, "it"), ErrorKind::invalid_input, "it has no label 3; its labels are 1, 2");
    EXPECT_KONTUR_ERROR(select_mask(halves, {}, "it"), ErrorKind::invalid_input, "it: the image is no label map: 20 voxels");
}

}  // namespace
}  // namespace kontur
