// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/self_intersections.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/polygons.h"
#include "support/random.h"

namespace kontur {
namespace {

using Kind = SelfIntersection::Kind;

Polygon2 started_at(Polygon2 polygon, std::size_t first) {
    std::rotate(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(first), polygon.end());
    return polygon;
}

Polygon2 reversed(Polygon2 polygon) {
    std::reverse(polygon.begin(), polygon.end());
    return polygon;
}

std::vector<Kind> kinds(const Polygon2& polygon) {
    std::vector<Kind> result;
    for (const SelfIntersection& c : find_self_intersections(polygon).places) result.push_back(c.kind);
    std::sort(result.begin(), result.end());
    return result;
}

/// Whatever point a drawing starts at and in whichever sense it runs.
void expect_kinds(const Polygon2& polygon, std::vector<Kind> expected, const char* what) {
    std::sort(expected.begin(), expected.end());
    for (std::size_t first = 0; first < polygon.size(); ++first)
        for (const Polygon2& drawn : {started_at(polygon, first), reversed(started_at(polygon, first))})
            EXPECT_EQ(kinds(drawn), expected) << what << " started at " << first;
}

TEST(SelfIntersections, SimplePolygonsHaveNone) {
    std::mt19937 random = test::random_of_this_test();
    for (int round = 0; round < 50; ++round) EXPECT_TRUE(kinds(test::random_star(3 + round, random)).empty());
}

TEST(SelfIntersections, FigureOfEightCrossesWhetherOrNotThroughAPoint) {
    expect_kinds({{-2, -1}, {2, 1}, {2, -1}, {-2, 1}}, {Kind::crossing}, "between points");
    expect_kinds({{-2, -1}, {0, 0}, {2, 1}, {2, -1}, {-2, 1}}, {Kind::crossing}, "through one point");
    expect_kinds({{0, 0}, {2, -1}, {3, 0}, {2, 1}, {0, 0}, {-2, -1}, {-3, 0}, {-2, 1}}, {Kind::crossing}, "through two");
}

TEST(SelfIntersections, LobesThatMeetInAPointTouch) {
    expect_kinds({{0, 0}, {2, -1}, {3, 0}, {2, 1}, {0, 0}, {-2, 1}, {-3, 0}, {-2, -1}}, {Kind::touch}, "in two points");
    expect_kinds({{-3, 0}, {3, 0}, {3, 2}, {0, 0}, {-3, 2}}, {Kind::touch}, "tip on an edge");
    expect_kinds({{-3, 0}, {3, 0}, {3, 2}, {0, 1e-12}, {-3, 2}}, {}, "tip just off an edge");
    expect_kinds({{-3, 0}, {3, 0}, {3, 2}, {0, -1e-12}, {-3, 2}}, {Kind::crossing, Kind::crossing}, "tip just beyond");
}

TEST(SelfIntersections, CommonStretchIsOneContact) {
    expect_kinds({{1, 0}, {3, 0}, {4, 2}, {5, 0}, {5, -3}, {0, -3}, {0, 0}, {1, 0}, {3, 0}, {2, 4}}, {Kind::crossing},
                 "passes through along a stretch");
    expect_kinds({{-6, 5}, {-4, 0}, {4, 0}, {6, 5}, {2, 4}, {1, 0}, {-1, 0}, {-2, 4}}, {Kind::touch}, "rests on a stretch");
}

TEST(SelfIntersections, SpikesFold) {
    expect_kinds({{-1, -1}, {1, -1}, {1, 0}, {3, 0}, {1, 0}, {1, 1}, {-1, 1}}, {Kind::fold}, "there and back");
    expect_kinds({{-1, -1}, {1, -1}, {1, 0}, {3, 0}, {2, 0}, {1, 1}, {-1, 1}}, {Kind::fold}, "not all the way back");
    expect_kinds({{0, 0}, {4, 0}, {4, 3}, {0, 3}, {0, 0}, {0, 3}, {-4, 3}, {-4, 0}}, {Kind::fold, Kind::touch},
                 "tip touches");
    expect_kinds({{-1, -1}, {1, -1}, {1, -1e-12}, {3, 0}, {1, 1e-12}, {1, 1}, {-1, 1}}, {}, "thin");
}

TEST(SelfIntersections, PositionIsWhereTheSegmentsMeet) {
    const SelfIntersections found = find_self_intersections({{-2, -1}, {2, 1}, {2, -2}, {-2, 2}});
    ASSERT_EQ(found.places.size(), 1u);
    EXPECT_NEAR(found.places[0].position[0], 0, 1e-15);
    EXPECT_NEAR(found.places[0].position[1], 0, 1e-15);
    EXPECT_EQ(found.places[0].first, 0u);
    EXPECT_EQ(found.places[0].second, 2u);
    EXPECT_EQ(found.crossings_of_segment, (std::vector<int>{1, 0, 1, 0}));
}

TEST(SelfIntersections, PixelSnappedPathsDoNotDependOnTheirStart) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_int_distribution<int> pixel(0, 4);
    std::size_t contacts = 0;
    for (int round = 0; round < 400; ++round) {
        Polygon2 polygon;
        for (int i = 0; i < 4 + round % 9; ++i) polygon.push_back({0.7 * pixel(random), 0.7 * pixel(random)});
        polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
        while (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
        if (polygon.size() < 4) continue;
        const std::vector<Kind> found = kinds(polygon);
        contacts += found.size();
        expect_kinds(polygon, found, "pixels");
    }
    EXPECT_GT(contacts, 400u);
}

TEST(SelfIntersections, EveryEdgeOfEveryLobeHasAPoint) {
    // The five arms of a pentagram have one point each, the edges of the pentagon in its middle none.
    const Polygon2 pentagram{{0, 10}, {6, -8}, {-9.5, 3}, {9.5, 3}, {-6, -8}};
    const SelfIntersections found = find_self_intersections(pentagram);
    EXPECT_EQ(found.places.size(), 5u);
    ASSERT_EQ(found.between_crossings.size(), 5u);
    for (const Point2& p : found.between_crossings) {
        EXPECT_LT(std::hypot(p[0], p[1]), 4);
        double nearest = 1e9;
        for (std::size_t i = 0; i < 5; ++i)
            nearest = std::min(nearest, test::distance_to_segment(pentagram[i], pentagram[(i + 1) % 5], p));
        EXPECT_LT(nearest, 1e-12);
    }
}

}  // namespace
}  // namespace kontur
