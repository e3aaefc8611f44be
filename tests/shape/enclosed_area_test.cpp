// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/enclosed_area.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kontur/shape/section.h"
#include "support/polygons.h"

namespace kontur {
namespace {

using test::figure_of_eight;

TEST(EnclosedArea, CountsBothLobesOfALineThatCrossesItself) {
    const Polygon2 square = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
    EXPECT_LT(area(figure_of_eight()), 1);
    EXPECT_NEAR(enclosed_area(figure_of_eight()), 2 * 20 * 10 * 4 / 3.0, 5);
    EXPECT_EQ(enclosed_area(square), area(square));
}

}  // namespace
}  // namespace kontur
