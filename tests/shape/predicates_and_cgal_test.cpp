// SPDX-License-Identifier: Apache-2.0
// The orientation of three points, beside CGAL's exact kernel.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "kontur/shape/predicates.h"
#include "support/random.h"

namespace kontur {
namespace {

int by_cgal(const Point2& a, const Point2& b, const Point2& c) {
    using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;
    return CGAL::orientation(Point(a[0], a[1]), Point(b[0], b[1]), Point(c[0], c[1]));
}

struct Counts {
    std::array<int, 3> of_sign{};  ///< right turns, lines, left turns
    int wrong_in_doubles = 0;
};

/// Compares `rounds` triples, each in three orders.
template <class Triple>
Counts compared(int rounds, Triple triple) {
    Counts counts;
    int differences = 0;
    for (int round = 0; round < rounds; ++round) {
        const auto [a, b, c] = triple();
        const int expected = by_cgal(a, b, c);
        const bool agrees =
            orientation(a, b, c) == expected && orientation(c, a, b) == expected && orientation(b, a, c) == -expected;
        if (!agrees && ++differences <= 5)
            ADD_FAILURE() << std::hexfloat << a[0] << " " << a[1] << ", " << b[0] << " " << b[1] << ", " << c[0] << " "
                          << c[1] << " turn by " << expected << ", not " << orientation(a, b, c);
        ++counts.of_sign[static_cast<std::size_t>(expected + 1)];
        const double area = (a[0] - c[0]) * (b[1] - c[1]) - (a[1] - c[1]) * (b[0] - c[0]);
        counts.wrong_in_doubles += (area > 0) - (area < 0) != expected;
    }
    EXPECT_EQ(differences, 0);
    return counts;
}

using Triple = std::array<Point2, 3>;

TEST(PredicatesAndCgal, AgreeNearlyOnALine) {
    std::mt19937_64 random(test::random_of_this_test()());
    std::uniform_real_distribution<double> coordinate(-300, 300), part(-0.5, 1.5);
    std::uniform_int_distribution<int> step(-2, 2);
    const auto moved = [&](double value) {
        const int steps = step(random);
        for (int i = 0; i < std::abs(steps); ++i) value = std::nextafter(value, steps < 0 ? -1e9 : 1e9);
        return value;
    };
    const Counts counts = compared(2'000'000, [&] {
        const Point2 a{coordinate(random), coordinate(random)}, b{coordinate(random), coordinate(random)};
        const double t = part(random);
        return Triple{a, b, {moved(a[0] + t * (b[0] - a[0])), moved(a[1] + t * (b[1] - a[1]))}};
    });
    EXPECT_GT(counts.wrong_in_doubles, 1000) << "else the test shows nothing";
}

/// As contours are that were snapped to pixels.
TEST(PredicatesAndCgal, AgreeOnMultiples) {
    std::mt19937_64 random(test::random_of_this_test()());
    for (const double spacing : {1.0, 0.7, 0.1, 1.0 / 3}) {
        std::uniform_int_distribution<int> index(-40, 40);
        const auto point = [&] { return Point2{spacing * index(random), spacing * index(random)}; };
        const Counts counts = compared(500'000, [&] { return Triple{point(), point(), point()}; });
        EXPECT_GT(counts.of_sign[1], 300) << spacing;
    }
}

/// Of every magnitude, subnormal ones among them; with coordinates that are equal, or zero, so that much cancels.
TEST(PredicatesAndCgal, AgreeOnAnyFiniteNumbers) {
    std::mt19937_64 random(test::random_of_this_test()());
    const auto number = [&] {
        while (true)
            if (const auto value = std::bit_cast<double>(random()); std::isfinite(value)) return value;
    };
    const Counts counts = compared(600'000, [&] {
        std::array<double, 6> values{};
        for (double& value : values) value = random() % 4 == 0 ? 0 : number();
        for (double& value : values)
            if (random() % 3 == 0) value = std::ldexp(values[random() % 6], static_cast<int>(random() % 5) - 2);
        for (double& value : values)
            if (!std::isfinite(value)) value = 1;
        return Triple{Point2{values[0], values[1]}, {values[2], values[3]}, {values[4], values[5]}};
    });
    EXPECT_GT(counts.of_sign[1], 1000);
    EXPECT_GT(counts.wrong_in_doubles, 1000);
}

/// Two products of opposite sign that differ in the last of 106 bits, at the ends of double's range.
TEST(PredicatesAndCgal, AgreeWhereProductsUnderflowAndOverflow) {
    std::mt19937_64 random(test::random_of_this_test()());
    std::uniform_real_distribution<double> significand(1, 2);
    for (const int exponent : {-1070, -1000, -600, -500, 500, 600, 1020}) {
        const auto number = [&] { return std::ldexp(significand(random), exponent); };
        const Counts counts = compared(60'000, [&] {
            const Point2 a{number(), number()};
            const Point2 b{a[0] * 1.5, a[1] * 1.5};
            return Triple{a, {std::nextafter(b[0], random() % 2 ? 0 : 1e308), b[1]}, {0, 0}};
        });
        EXPECT_GT(counts.of_sign[0] + counts.of_sign[2], 1000) << exponent;
    }
}

}  // namespace
}  // namespace kontur
