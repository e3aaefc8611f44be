// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/predicates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/random.h"

namespace kontur {
namespace {

using Wide = __int128;

/// On coordinates that are integers below 2^60.
int sign_of_area(const Point2& a, const Point2& b, const Point2& c) {
    const auto wide = [](double from, double to) { return static_cast<Wide>(to) - static_cast<Wide>(from); };
    const Wide area = wide(a[0], b[0]) * wide(a[1], c[1]) - wide(a[1], b[1]) * wide(a[0], c[0]);
    return area > 0 ? 1 : area < 0 ? -1 : 0;
}

int sign_in_doubles(const Point2& a, const Point2& b, const Point2& c) {
    const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    return area > 0 ? 1 : area < 0 ? -1 : 0;
}

TEST(Predicates, OrientationIsExactWhereDoublesAreNot) {
    std::mt19937_64 random(test::random_of_this_test()());
    std::uniform_int_distribution<std::int64_t> coordinate(-(std::int64_t{1} << 30), std::int64_t{1} << 30), off(-1, 1),
        multiple(1, 1 << 20);
    int doubles_fail = 0;
    for (int i = 0; i < 20000; ++i) {
        const std::int64_t dx = coordinate(random), dy = coordinate(random), k = multiple(random);
        const auto point = [](std::int64_t x, std::int64_t y) {
            return Point2{static_cast<double>(x), static_cast<double>(y)};
        };
        const Point2 a = point(coordinate(random), coordinate(random));
        const Point2 b{a[0] + static_cast<double>(dx), a[1] + static_cast<double>(dy)};
        const Point2 c{a[0] + static_cast<double>(k * dx + off(random)), a[1] + static_cast<double>(k * dy + off(random))};
        const int expected = sign_of_area(a, b, c);
        EXPECT_EQ(orientation(a, b, c), expected);
        EXPECT_EQ(orientation(b, c, a), expected);
        EXPECT_EQ(orientation(b, a, c), -expected);
        doubles_fail += sign_in_doubles(a, b, c) != expected;
    }
    EXPECT_GT(doubles_fail, 100) << "else the test shows nothing";
}

TEST(Predicates, OrientationKnowsNoTolerance) {
    for (const double size : {1e-200, 1e-6, 1.0, 1e6, 1e150}) {
        EXPECT_EQ(orientation({0, 0}, {size, 0}, {0, size}), 1);
        EXPECT_EQ(orientation({0, 0}, {size, size}, {size * 0.5, size * 0.5}), 0);
        EXPECT_EQ(orientation({0, 0}, {size, size}, {size * 0.5, std::nextafter(size * 0.5, 2 * size)}), 1);
        EXPECT_EQ(orientation({0, 0}, {size, size}, {size * 0.5, std::nextafter(size * 0.5, 0)}), -1);
    }
}

TEST(Predicates, PointOfASegment) {
    const Point2 a{0.25, 0.5}, b{3.25, 6.5};
    EXPECT_TRUE(is_on_segment(a, b, a));
    EXPECT_TRUE(is_on_segment(a, b, b));
    EXPECT_TRUE(is_on_segment(b, a, {1.25, 2.5}));
    EXPECT_FALSE(is_on_segment(a, b, {4.25, 8.5}));
    EXPECT_FALSE(is_on_segment(a, b, {1.25, 2.5 + 1e-12}));
    EXPECT_FALSE(is_on_segment(a, b, {1.25 - 1e-12, 2.5}));
    EXPECT_TRUE(is_on_segment(a, a, a));
}

/// By the fractions at which the lines meet, on integers.
Meeting meeting_of_integers(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
    const auto cross = [](double ux, double uy, double vx, double vy) { return ux * vy - uy * vx; };
    const double ux = b[0] - a[0], uy = b[1] - a[1], vx = d[0] - c[0], vy = d[1] - c[1], wx = c[0] - a[0], wy = c[1] - a[1];
    double denominator = cross(ux, uy, vx, vy);
    if (denominator == 0) {
        if (cross(ux, uy, wx, wy) != 0) return Meeting::apart;
        const auto along = [&](const Point2& p) { return (p[0] - a[0]) * ux + (p[1] - a[1]) * uy; };
        const auto [low, high] = std::minmax({along(c), along(d)});
        return high < 0 || low > along(b) ? Meeting::apart : Meeting::touching;
    }
    double t = cross(wx, wy, vx, vy), s = cross(wx, wy, ux, uy);
    if (denominator < 0) t = -t, s = -s, denominator = -denominator;
    if (t < 0 || t > denominator || s < 0 || s > denominator) return Meeting::apart;
    const bool inner = t > 0 && t < denominator && s > 0 && s < denominator;
    return inner ? Meeting::crossing : Meeting::touching;
}

TEST(Predicates, SegmentsMeetOnEveryLatticeOfFourByFour) {
    std::vector<Point2> lattice;
    for (int i = 0; i < 16; ++i) lattice.push_back({static_cast<double>(i % 4), static_cast<double>(i / 4)});
    int touching = 0;
    for (const Point2& a : lattice)
        for (const Point2& b : lattice)
            for (const Point2& c : lattice)
                for (const Point2& d : lattice) {
                    if (a == b || c == d) continue;
                    const Meeting expected = meeting_of_integers(a, b, c, d);
                    ASSERT_EQ(meeting(a, b, c, d), expected) << a[0] << a[1] << b[0] << b[1] << c[0] << c[1] << d[0] << d[1];
                    touching += expected == Meeting::touching;
                }
    EXPECT_GT(touching, 5000);
}

TEST(Predicates, TouchAndMissByATrillionth) {
    const Point2 a{0, 0}, b{100, 0};
    for (const double off : {1e-12, 1e-9, 1e-6}) {
        EXPECT_EQ(meeting(a, b, {50, off}, {50, 10}), Meeting::apart);
        EXPECT_EQ(meeting(a, b, {50, -off}, {50, 10}), Meeting::crossing);
        EXPECT_EQ(meeting(a, b, {100 + off, -1}, {100 + off, 1}), off < 1e-13 ? Meeting::touching : Meeting::apart);
        EXPECT_EQ(meeting(a, b, {0, off}, {100, off}), Meeting::apart);
    }
    EXPECT_EQ(meeting(a, b, {50, 0}, {50, 10}), Meeting::touching);
    EXPECT_EQ(meeting(a, b, {20, 0}, {300, 0}), Meeting::touching);
}

TEST(Predicates, TilesShareNoPoint) {
    // Lattice points lie inside of exactly one of the triangles that tile the plane around them.
    std::mt19937 random = test::random_of_this_test();
    std::uniform_int_distribution<int> coordinate(0, 12);
    for (int round = 0; round < 200; ++round) {
        const Point2 hub{static_cast<double>(coordinate(random)), static_cast<double>(coordinate(random))};
        const Polygon2 frame{{-1, -1}, {13, -1}, {13, 13}, {-1, 13}};
        for (int k = 0; k < 40; ++k) {
            const Point2 p{static_cast<double>(coordinate(random)), static_cast<double>(coordinate(random))};
            int tiles = 0;
            for (std::size_t side = 0; side < 4; ++side)
                tiles += is_inside(Polygon2{hub, frame[side], frame[(side + 1) % 4]}, p);
            EXPECT_EQ(tiles, 1) << p[0] << " " << p[1];
        }
    }
}

TEST(Predicates, InsideFollowsTheEvenOddRule) {
    const Polygon2 pentagram{{0, 10}, {6, -8}, {-9.5, 3}, {9.5, 3}, {-6, -8}};
    EXPECT_FALSE(is_inside(pentagram, {0, 0}));
    EXPECT_TRUE(is_inside(pentagram, {0, 5}));
    EXPECT_TRUE(is_inside(pentagram, {7, 2.5}));
    EXPECT_FALSE(is_inside(pentagram, {7, -2}));
    EXPECT_FALSE(is_inside(Polygon2{}, {0, 0}));
}

}  // namespace
}  // namespace kontur
