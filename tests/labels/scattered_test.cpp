// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/scattered.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kontur/fill_labels.h"
#include "support/expect_error.h"
#include "support/label_maps.h"

namespace kontur {
namespace {

using test::index_grid;

/// What a scanner sees of a smooth body: levels and noise.
Image scan() {
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, 10);
    Image image{index_grid({40, 40, 40}), std::vector<std::int16_t>(40 * 40 * 40)};
    for (auto& value : std::get<std::vector<std::int16_t>>(image.samples))
        value = static_cast<std::int16_t>(std::lround(60 + noise(random)));
    return image;
}

/// 64 balls, painted on every third slice across an axis.
Image many_balls(int axis) {
    Image labels{index_grid({48, 48, 48}), std::vector<std::int16_t>(48 * 48 * 48)};
    auto& values = std::get<std::vector<std::int16_t>>(labels.samples);
    std::size_t n = 0;
    for (std::int64_t k = 0; k < 48; ++k)
        for (std::int64_t j = 0; j < 48; ++j)
            for (std::int64_t i = 0; i < 48; ++i, ++n) {
                const Index3 at{i, j, k};
                const std::int64_t a = i % 12 - 6, b = j % 12 - 6, c = k % 12 - 6;
                if (at[axis] % 3 == 0 && a * a + b * b + c * c < 25)
                    values[n] = static_cast<std::int16_t>(1 + i / 12 + 4 * (j / 12) + 16 * (k / 12));
            }
    return labels;
}

TEST(Scattered, AnImageIsNoLabelMap) {
    const auto why = why_no_labels(scan());
    ASSERT_TRUE(why);
    EXPECT_NE(why->find("labels are scattered"), std::string::npos) << *why;
    EXPECT_KONTUR_ERROR(fill_labels(scan()), ErrorKind::invalid_input, "looks like an image, not like a label map");
}

TEST(Scattered, ManyLabelsOnThinSlicesAreALabelMap) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_FALSE(why_no_labels(many_balls(axis))) << axis;
    EXPECT_EQ(fill_labels(many_balls(2)).report.labels.size(), 64U);
}

}  // namespace
}  // namespace kontur
