// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/window.h"

#include <gtest/gtest.h>

namespace kontur {
namespace {

Image image_of(std::vector<float> values) {
    return {{{static_cast<std::int64_t>(values.size()), 1, 1}, {}}, std::move(values)};
}

TEST(SuggestWindow, HounsfieldUnitsGetTheSoftTissueWindow) {
    EXPECT_EQ(suggest_window(image_of({-1000, -80, 40, 60, 900})), (Window{40, 350}));
}

TEST(SuggestWindow, OtherImagesGetThe1stTo99thPercentile) {
    std::vector<float> values{1e6f};
    for (int i = 0; i <= 1000; ++i) values.push_back(static_cast<float>(i));
    const Window window = suggest_window(image_of(values));
    EXPECT_NEAR(window.center - window.width / 2, 10, 1);
    EXPECT_NEAR(window.center + window.width / 2, 991, 1);
}

TEST(SuggestWindow, ConstantEmptyAndNanImagesGetSomeWidth) {
    EXPECT_GT(suggest_window(image_of({5, 5, 5})).width, 0);
    EXPECT_EQ(suggest_window(image_of({5, 5, 5})).center, 5);
    EXPECT_GT(suggest_window(image_of({})).width, 0);
    EXPECT_GT(suggest_window(image_of({NAN, NAN})).width, 0);
}

TEST(SuggestWindow, MostlyConstantImageShowsItsRange) {
    std::vector<float> values(1000, 0.0f);
    values.back() = 8;
    EXPECT_EQ(suggest_window(image_of(values)), (Window{4, 8}));
}

TEST(Brightness, RunsLinearlyAcrossTheWindowAndStopsAtItsEnds) {
    const Window window{40, 350};
    EXPECT_DOUBLE_EQ(brightness(40, window), 0.5);
    EXPECT_DOUBLE_EQ(brightness(-135, window), 0);
    EXPECT_DOUBLE_EQ(brightness(215, window), 1);
    EXPECT_DOUBLE_EQ(brightness(-1000, window), 0);
    EXPECT_DOUBLE_EQ(brightness(3000, window), 1);
    EXPECT_DOUBLE_EQ(brightness(NAN, window), 0);
}

}  // namespace
}  // namespace kontur
