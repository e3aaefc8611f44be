// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/section.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/contour_sets.h"
#include "support/random.h"

namespace kontur {
namespace {

/// Wavy lines around places of their own, some of whose points lie on a coarse lattice; one is empty.
Section random_section(std::mt19937& random) {
    std::uniform_real_distribution<double> place(-20, 20), wave(-1, 1);
    Section section;
    for (const int count : {3, 15, 16, 17, 33, 400}) {
        Polygon2& line = section.outlines.emplace_back();
        const double u = place(random), v = place(random), deep = 2 * wave(random);
        for (int i = 0; i < count; ++i) {
            const double angle = 2 * M_PI * i / count, radius = 10 + deep * std::sin(5 * angle) + 0.1 * wave(random);
            line.push_back({u + radius * std::cos(angle), v + radius * std::sin(angle)});
            if (i % 7 == 0) line.back() = {std::round(line.back()[0]), std::round(line.back()[1])};
        }
    }
    section.outlines.emplace_back();
    return section;
}

TEST(SectionSearch, AnswersAsTheSectionDoes) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> coordinate(-40, 40);
    for (int repeat = 0; repeat < 20; ++repeat) {
        const Section section = random_section(random);
        const SectionSearch search(section);
        std::vector<Point2> places;
        for (int n = 0; n < 500; ++n) places.push_back({coordinate(random), coordinate(random)});
        for (int n = 0; n < 500; ++n) places.push_back({std::round(coordinate(random)), std::round(coordinate(random))});
        for (const Polygon2& line : section.outlines) places.insert(places.end(), line.begin(), line.end());
        for (const Point2& p : places) {
            EXPECT_EQ(search.contains(p), section.contains(p));
            const Section::Nearest fast = search.nearest(p), slow = section.nearest(p);
            EXPECT_EQ(fast.distance, slow.distance);
            EXPECT_EQ(fast.position, slow.position);
            EXPECT_EQ(fast.outline, slow.outline);
        }
    }
}

/// Small rings and holes in a lattice, of which neighbours touch and points lie on one another.
Section lattice_of_rings(int side) {
    Section section;
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
            for (const double radius : {2.0, 1.0}) {
                Polygon2& line = section.outlines.emplace_back();
                for (const auto& [u, v] : {Point2{1, 0}, Point2{0, 1}, Point2{-1, 0}, Point2{0, -1}})
                    line.push_back({4.0 * column + radius * u, 4.0 * row + radius * v});
                section.holes.push_back(radius < 2);
            }
    return section;
}

TEST(SectionSearch, OfPlacesEquallyNearTakesTheFirstAsTheSectionDoes) {
    const Section section = lattice_of_rings(6);
    const SectionSearch search(section);
    for (double u = -4; u <= 24; u += 0.5)
        for (double v = -4; v <= 24; v += 0.5) {
            const Section::Nearest fast = search.nearest({u, v}), slow = section.nearest({u, v});
            EXPECT_EQ(fast.distance, slow.distance);
            EXPECT_EQ(fast.position, slow.position);
            EXPECT_EQ(fast.outline, slow.outline);
            EXPECT_EQ(search.contains({u, v}), section.contains({u, v}));
        }
}

TEST(SectionSearch, VisitsTheOutlinesAroundAPoint) {
    const Section section = lattice_of_rings(3);
    std::vector<std::size_t> around;
    SectionSearch(section).visit_around({4.1, 0.2}, [&](std::size_t outline) { around.push_back(outline); });
    std::sort(around.begin(), around.end());
    EXPECT_EQ(around, (std::vector<std::size_t>{2, 3}));
}

TEST(SectionSearch, OfNothingIsEmptyAndInfinitelyFar) {
    const Section nothing;
    EXPECT_FALSE(SectionSearch(nothing).contains({0, 0}));
    EXPECT_TRUE(std::isinf(SectionSearch(nothing).clearance({0, 0})));
}

}  // namespace
}  // namespace kontur
