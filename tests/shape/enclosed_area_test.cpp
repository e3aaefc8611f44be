// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/enclosed_area.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kontur/shape/section.h"

namespace kontur {
namespace {

/// Two lobes of 10 mm, its signed area is 0.
Polygon2 figure_of_eight() {
    Polygon2 line;
    for (int i = 0; i < 240; ++i) {
        const double t = 2 * M_PI * (i + 0.5) / 240;
        line.push_back({20 * std::sin(t), 10 * std::sin(2 * t)});
    }
    return line;
}

TEST(EnclosedArea, CountsBothLobesOfALineThatCrossesItself) {
    const Polygon2 square = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
    EXPECT_LT(area(figure_of_eight()), 1);
    EXPECT_NEAR(enclosed_area(figure_of_eight()), 2 * 20 * 10 * 4 / 3.0, 5);
    EXPECT_EQ(enclosed_area(square), area(square));
}

}  // namespace
}  // namespace kontur
