// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/orient.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kontur/phantom/cases.h"
#include "support/polygons.h"
#include "support/random.h"

namespace kontur {
namespace {

using test::Point2;
using Polygon = std::vector<Point2>;

const Plane kTilted = make_plane({30, -20, 100}, {0.3, -0.5, 0.8});

double side(const Point2& a, const Point2& b, const Point2& p) {
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

/// Proper crossings by comparing every pair of segments.
Polygon all_crossings(const Polygon& p) {
    Polygon result;
    const std::size_t n = p.size();
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 2; j < n; ++j) {
            const Point2 &a = p[i], &b = p[(i + 1) % n], &c = p[j], &d = p[(j + 1) % n];
            const double sa = side(c, d, a), sb = side(c, d, b);
            if (!(sa * sb < 0 && side(a, b, c) * side(a, b, d) < 0)) continue;
            const double t = sa / (sa - sb);
            result.push_back({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])});
        }
    return result;
}

Polygon in_plane(const Plane& plane, const std::vector<Vec3>& points) {
    Polygon result;
    for (const Vec3& p : points) result.push_back(plane.to_uv(p));
    return result;
}

/// Steps a little from every point along its normal and back, and looks by the even-odd rule where that leads. Points at
/// which other parts of the polygon are too close for an answer are left out; returns how many were judged.
int expect_outward(const Contour& contour, const char* what) {
    const Polygon polygon = in_plane(contour.plane, contour.points);
    const ContourOrientation orientation = orient(contour);
    const std::size_t n = polygon.size();
    int judged = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 normal = orientation.normals[i];
        EXPECT_NEAR(norm(normal), 1, 1e-12) << what << " at " << i;
        EXPECT_NEAR(dot(normal, contour.plane.normal), 0, 1e-12) << what << " at " << i;
        constexpr double kStep = 1e-5;
        double others = 1e9;
        for (std::size_t j = 0; j < n; ++j)
            if (j != i && (j + 1) % n != i)
                others = std::min(others, test::distance_to_segment(polygon[j], polygon[(j + 1) % n], polygon[i]));
        if (others < 10 * kStep) continue;
        const bool ahead = test::is_inside_even_odd(polygon, contour.plane.to_uv(contour.points[i] + kStep * normal));
        const bool behind = test::is_inside_even_odd(polygon, contour.plane.to_uv(contour.points[i] - kStep * normal));
        if (ahead == behind) continue;  // at a sharp corner Eq. 7 may leave the wedge: outside on both sides
        EXPECT_EQ(ahead, contour.hole) << what << " at " << i;
        ++judged;
    }
    return judged;
}

Polygon reversed(Polygon polygon) {
    std::reverse(polygon.begin(), polygon.end());
    return polygon;
}

TEST(Orient, NormalsOfACircleAreItsRadii) {
    Polygon circle;
    for (int i = 0; i < 40; ++i) circle.push_back({std::cos(i * M_PI / 20), std::sin(i * M_PI / 20)});
    for (const Polygon& polygon : {circle, reversed(circle)}) {
        const ContourOrientation orientation = orient(test::contour_in(kTilted, polygon));
        EXPECT_TRUE(orientation.crossings.empty());
        for (std::size_t i = 0; i < polygon.size(); ++i)
            EXPECT_LT(distance(orientation.normals[i], polygon[i][0] * kTilted.u + polygon[i][1] * kTilted.v), 1e-12);
    }
}

TEST(Orient, NormalIsThatOfEquation7) {
    // A corner whose edges are 1 and 3 long: the longer one weighs three times as much.
    const Polygon corner{{0, 0}, {3, 0}, {3, 1}, {0, 1}};
    const ContourOrientation orientation = orient(test::contour_in(Plane{}, corner));
    EXPECT_LT(distance(orientation.normals[1], normalized({1, -3, 0})), 1e-12);
    EXPECT_LT(distance(orientation.normals[3], normalized({-1, 3, 0})), 1e-12);
}

TEST(Orient, StarsPointOutwardInEitherSenseAndHolesInward) {
    std::mt19937 random = test::random_of_this_test();
    int judged = 0;
    for (int round = 0; round < 50; ++round) {
        const Polygon star = test::random_star(5 + round, random);
        for (const Polygon& polygon : {star, reversed(star)})
            for (const bool hole : {false, true}) judged += expect_outward(test::contour_in(kTilted, polygon, hole), "star");
    }
    EXPECT_GT(judged, 2000);
}

TEST(Orient, TanglesFollowTheEvenOddRule) {
    std::mt19937 random = test::random_of_this_test();
    int judged = 0;
    for (int round = 0; round < 200; ++round)
        judged += expect_outward(test::contour_in(kTilted, test::random_tangle(4 + round % 40, random)), "tangle");
    EXPECT_GT(judged, 2000);
}

TEST(Orient, CrossingsAreThoseOfAllPairsOfSegments) {
    std::mt19937 random = test::random_of_this_test();
    for (int round = 0; round < 100; ++round) {
        const Polygon polygon = test::random_tangle(4 + round % 40, random);
        Polygon expected = all_crossings(polygon);
        Polygon found = in_plane(Plane{}, orient(test::contour_in(Plane{}, polygon)).crossings);
        std::sort(expected.begin(), expected.end());
        std::sort(found.begin(), found.end());
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_NEAR(found[i][0], expected[i][0], 1e-9);
            EXPECT_NEAR(found[i][1], expected[i][1], 1e-9);
        }
    }
}

TEST(Orient, LobesAndLoopsOfThePhantomAgreeWithItsOwnNormals) {
    const PhantomCase c = phantom_case("self_intersecting");
    for (std::size_t k = 0; k < c.contours.contours.size(); ++k) {
        const ContourOrientation orientation = orient(c.contours.contours[k]);
        EXPECT_EQ(orientation.crossings.size(), 1u);
        for (std::size_t i = 0; i < orientation.normals.size(); ++i)
            EXPECT_GT(dot(orientation.normals[i], c.normals[k][i]), 0.99) << k << " " << i;
    }
}

TEST(Orient, PixelSnappedTanglesFollowTheEvenOddRule) {
    // Few different coordinates: paths run through points, along segments, back and forth and around twice.
    std::mt19937 random = test::random_of_this_test();
    std::uniform_int_distribution<int> pixel(0, 4);
    int judged = 0;
    for (int round = 0; round < 2000; ++round) {
        Polygon polygon;
        for (int i = 0; i < 4 + round % 12; ++i) polygon.push_back({0.7 * pixel(random), 0.7 * pixel(random)});
        polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
        if (polygon.size() < 4) continue;
        judged += expect_outward(test::contour_in(kTilted, polygon), "pixels");
    }
    EXPECT_GT(judged, 3000);
}

TEST(Orient, LobesThatMeetInASharedPointBothPointOutward) {
    for (const int first : {0, 1, 2, 3, 4, 5, 6, 7}) {
        Polygon eight{{0, 0}, {2, -1}, {3, 0}, {2, 1}, {0, 0}, {-2, -1}, {-3, 0}, {-2, 1}};
        std::rotate(eight.begin(), eight.begin() + first, eight.end());
        EXPECT_EQ(expect_outward(test::contour_in(kTilted, eight), "eight"), 6);
    }
}

TEST(Orient, TouchIsNoCrossing) {
    const Polygon crossing{{0, 0}, {2, -1}, {3, 0}, {2, 1}, {0, 0}, {-2, -1}, {-3, 0}, {-2, 1}};
    const Polygon touching{{0, 0}, {2, -1}, {3, 0}, {2, 1}, {0, 0}, {-2, 1}, {-3, 0}, {-2, -1}};
    EXPECT_EQ(orient(test::contour_in(Plane{}, crossing)).crossings.size(), 1u);
    EXPECT_TRUE(orient(test::contour_in(Plane{}, touching)).crossings.empty());
}

TEST(Orient, DecidesByATrillionthOfAMillimetre) {
    // A notch whose tip ends just before the opposite side, or just beyond it.
    for (const double off : {1e-12, 1e-9, 1e-6, 1e-3})
        for (const bool pierces : {false, true}) {
            const double tip = -1 + (pierces ? -off : off);
            const Contour contour =
                test::contour_in(Plane{}, Polygon{{-1, -1}, {1, -1}, {1, 1}, {0.1, 1}, {0, tip}, {-0.1, 1}, {-1, 1}});
            const ContourOrientation orientation = orient(contour);
            EXPECT_EQ(orientation.crossings.size(), pierces ? 2u : 0u) << off;
            EXPECT_NEAR(orientation.normals[4].y, pierces ? -1 : 1, 1e-9) << off;
        }
}

TEST(Orient, StraightRunAtTheExtremePointIsNoObstacle) {
    const Polygon square{{0, 0}, {0, -1}, {0, -2}, {2, -2}, {2, 0}, {2, 2}, {0, 2}, {0, 1}};
    for (std::size_t first = 0; first < square.size(); ++first)
        for (Polygon polygon : {square, reversed(square)}) {
            std::rotate(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(first), polygon.end());
            EXPECT_EQ(expect_outward(test::contour_in(Plane{}, polygon), "square"), 8);
        }
}

TEST(Orient, TipOfAFoldedSpikePointsAlongTheSpike) {
    // A square with a spike out of its right side, or a cut into it.
    for (const double width : {0.0, 1e-12, 1e-9, 1e-6})
        for (const double tip : {3.0, 0.0})
            for (const bool turned : {false, true}) {
                const Polygon square{{-1, -1}, {1, -1}, {1, -width}, {tip, 0}, {1, width}, {1, 1}, {-1, 1}};
                const ContourOrientation orientation = orient(test::contour_in(Plane{}, turned ? reversed(square) : square));
                EXPECT_NEAR(orientation.normals[3].x, 1, 1e-5) << width << " " << tip << " " << turned;
                EXPECT_NEAR(orientation.normals[turned ? 6 : 0].x, -std::sqrt(0.5), 1e-5);
            }
}

TEST(Orient, TurnsWithItsPlane) {
    std::mt19937 random = test::random_of_this_test();
    const Polygon polygon = test::random_tangle(30, random);
    const ContourOrientation flat = orient(test::contour_in(Plane{}, polygon));
    for (const Vec3& normal : {Vec3{0, 0, -1}, Vec3{1, 0, 0}, Vec3{-0.2, 0.9, 0.1}})
        for (const double handedness : {1.0, -1.0}) {
            Plane plane = make_plane({500, -300, 1000}, normal);
            plane.v = handedness * plane.v;
            const ContourOrientation turned = orient(test::contour_in(plane, polygon));
            ASSERT_EQ(turned.crossings.size(), flat.crossings.size());
            for (std::size_t i = 0; i < polygon.size(); ++i)
                EXPECT_LT(distance(turned.normals[i], flat.normals[i].x * plane.u + flat.normals[i].y * plane.v), 1e-9);
        }
}

}  // namespace
}  // namespace kontur
