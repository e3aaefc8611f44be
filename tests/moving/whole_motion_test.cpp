// SPDX-License-Identifier: Apache-2.0
#include "kontur/moving/whole_motion.h"

#include <gtest/gtest.h>

#include <array>

#include "support/functions.h"

namespace kontur {
namespace {

constexpr double kRest = -30;
constexpr std::array kRadii{30.0, 24.0, 20.0, 27.0};
const Vec3 kPlace{22, 3, -4};

/// The motion of balls at frames 1, 4, 7 and 10 of 12, at one place.
double value(const std::vector<double>& weights, double time) {
    const TimeCourse course({1, 4, 7, 10}, 12);
    std::vector<std::optional<ImplicitFunction>> functions(kRadii.size());
    for (std::size_t k = 0; k < weights.size(); ++k)
        if (weights[k] > 0) functions[k] = test::ball_function({0, 0, 0}, kRadii[k]);
    double at = kRest;
    WholeMotion(course, functions, weights).lay_over({&kPlace, 1}, time, {&at, 1}, {.threads = 1});
    return at;
}

TEST(WholeMotion, IsTheMotionBetweenWholeMoments) {
    const MovingFunction motion(TimeCourse({1, 7}, 12),
                                {test::ball_function({0, 0, 0}, kRadii[0]), test::ball_function({0, 0, 0}, kRadii[2])});
    for (const double time : {1.0, 2.7, 7.0, 11.5}) EXPECT_EQ(value({1, 0, 1, 0}, time), motion.value(kPlace, time)) << time;
}

TEST(WholeMotion, WithoutAnyWeightWhatWasThereStays) {
    EXPECT_EQ(value({0, 0, 0, 0}, 3), kRest);
    EXPECT_DOUBLE_EQ(value({0, 0.25, 0, 0}, 3),
                     0.75 * kRest + 0.25 * test::ball_function({0, 0, 0}, kRadii[1]).value(kPlace));
}

TEST(WholeMotion, ChangesWithEachWeightWithoutAStep) {
    constexpr double kLittle = 1e-6;
    for (const std::vector<double>& others :
         {std::vector<double>{1, 0, 1, 0}, {1, 0, 0.4, 0.4}, {0, 0, 0.3, 0}, {0.5, 0, 1, 0.2}})
        for (const double weight : {0.0, 0.2, 0.3, 0.4, 0.5, 1 - kLittle})
            for (const double time : {1.0, 3.2, 4.0, 8.9, 12.5}) {
                std::vector<double> before = others, after = others;
                before[1] = weight;
                after[1] = weight + kLittle;
                EXPECT_NEAR(value(before, time), value(after, time), 100 * kLittle) << weight << " at " << time;
            }
}

}  // namespace
}  // namespace kontur
