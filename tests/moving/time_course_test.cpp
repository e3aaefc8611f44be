// SPDX-License-Identifier: Apache-2.0
#include "kontur/moving/time_course.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "support/expect_error.h"
#include "support/random.h"

namespace kontur {
namespace {

double value(const TimeCourse& course, double time, const std::vector<double>& values) {
    return course.value(course.place_of(time), values);
}

struct Drawn {
    TimeCourse course;
    std::vector<double> values;
};

/// Some moments in a cycle of 20, or without one.
Drawn drawn(std::mt19937& random, bool repeats) {
    std::uniform_int_distribution<int> count(1, 7);
    std::uniform_real_distribution<double> apart(0.2, 2.5), height(-3, 3);
    std::vector<double> times{1 + apart(random)}, values{height(random)};
    for (int left = count(random); left > 1; --left) {
        times.push_back(times.back() + apart(random));
        values.push_back(height(random));
    }
    return {TimeCourse(times, repeats ? std::optional(20.0) : std::nullopt), values};
}

TEST(TimeCourse, PassesThroughEveryMomentAndStaysBetweenItsNeighbours) {
    std::mt19937 random = test::random_of_this_test();
    for (int n = 0; n < 300; ++n) {
        const auto [course, values] = drawn(random, n % 2 == 0);
        for (std::size_t k = 0; k < values.size(); ++k) EXPECT_EQ(value(course, course.times()[k], values), values[k]);
        for (double time = -5; time < 45; time += 0.13) {
            const TimeCourse::Place place = course.place_of(time);
            const auto [low, high] = std::minmax(values[place.before], values[place.after]);
            EXPECT_GE(value(course, time, values), low - 1e-12);
            EXPECT_LE(value(course, time, values), high + 1e-12);
        }
    }
}

TEST(TimeCourse, ItsRateHasNoStepsOverTheSeamOfTheCycleNeither) {
    constexpr double kStep = 1e-5;
    std::mt19937 random = test::random_of_this_test();
    for (int n = 0; n < 100; ++n) {
        const auto [course, values] = drawn(random, n % 2 == 0);
        const auto rate = [&, &course = course, &values = values](double time) {
            return (value(course, time + kStep, values) - value(course, time, values)) / kStep;
        };
        for (double time = 0; time < 41; time += 0.173) EXPECT_NEAR(rate(time), rate(time - kStep), 0.01);
        for (const double time : course.times()) EXPECT_NEAR(rate(time), rate(time - kStep), 0.01);
        if (!course.cycle()) continue;
        EXPECT_NEAR(value(course, 3.7, values), value(course, 23.7, values), 1e-9);
        EXPECT_NEAR(rate(3.7), rate(23.7), 1e-4);
    }
}

TEST(TimeCourse, TheUnitOfTimeDoesNotMatter) {
    const std::vector<double> values{1, 3, -2, 0.5};
    const TimeCourse frames({1, 4, 9, 11}, 20), seconds({0.05, 0.2, 0.45, 0.55}, 1);
    for (double frame = 1; frame < 21; frame += 0.3)
        EXPECT_NEAR(value(frames, frame, values), value(seconds, 0.05 * frame, values), 1e-9);
}

TEST(TimeCourse, RisesAtAnEvenRateBetweenMomentsThatRiseEvenly) {
    const TimeCourse course({1, 2, 3, 4, 5, 6}, 60);
    const std::vector<double> values{0, 1, 2, 3, 4, 5};
    for (double time = 2; time <= 5; time += 0.1) EXPECT_NEAR(value(course, time, values), time - 1, 0.02);
}

/// Of a breath of which five moments are known: the straight line between them is off by .095 at most.
TEST(TimeCourse, FollowsABreathMoreCloselyThanStraightLines) {
    std::vector<double> times, values;
    for (int k = 0; k < 8; ++k) {
        times.push_back(k / 8.0);
        values.push_back(std::sin(2 * std::numbers::pi * times.back() + 0.4));
    }
    const TimeCourse course(times, 1);
    double off = 0, off_straight = 0;
    for (double time = 0; time < 1; time += 0.01) {
        const TimeCourse::Place place = course.place_of(time);
        const double truth = std::sin(2 * std::numbers::pi * time + 0.4);
        off += std::abs(course.value(place, values) - truth);
        off_straight += std::abs(std::lerp(values[place.before], values[place.after], place.since * 8) - truth);
    }
    EXPECT_LT(off, 0.6 * off_straight);
}

TEST(TimeCourse, RefusesTimesThatDoNotRiseOrDoNotFitIntoTheCycle) {
    EXPECT_KONTUR_ERROR(TimeCourse({}), ErrorKind::invalid_input, "there is no moment");
    EXPECT_KONTUR_ERROR(TimeCourse({1, 3, 2}), ErrorKind::invalid_input, "moment 3 is at 2, not after 3");
    EXPECT_KONTUR_ERROR(TimeCourse({1, 1}), ErrorKind::invalid_input, "moment 2 is at 1, not after 1");
    EXPECT_KONTUR_ERROR(TimeCourse({1, std::nan("")}), ErrorKind::invalid_input, "moment 2 is at nan");
    EXPECT_KONTUR_ERROR(TimeCourse({1, 21}, 20), ErrorKind::invalid_input, "the cycle is 20 long, and the moments span 20");
}

}  // namespace
}  // namespace kontur
