// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/missed_clicks.h"

#include <gtest/gtest.h>

#include "support/functions.h"

namespace kontur {
namespace {

TEST(MissedClicks, AreThoseOnTheWrongSideOfTheSurface) {
    ContourSet set;
    set.interior = {{0, 0, 3}, {0, 0, 12}};
    set.exterior = {{0, 0, 9}, {0, 0, 12}};
    EXPECT_EQ(missed_clicks(set, test::ball_function({}, 10), 0.5),
              (std::vector<std::string>{"interior point 2 could not be brought inside",
                                        "exterior point 1 could not be brought outside"}));
}

TEST(MissedClicks, CountSurfacePointsThatTheSurfacePassesFarFrom) {
    ContourSet set;
    set.surface = {{{10, 0, 0}, {}}, {{0, 10.3, 0}, {}}, {{0, 0, 11}, {}}, {{0, 0, 0}, {}}};
    EXPECT_EQ(missed_clicks(set, test::ball_function({}, 10), 0.5),
              (std::vector<std::string>{"2 of 4 surface points could not be reached, the first of them point 3: the surface "
                                        "passes more than 0.5 mm away"}));
}

}  // namespace
}  // namespace kontur
