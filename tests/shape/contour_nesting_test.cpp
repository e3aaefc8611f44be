// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/contour_nesting.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/contour_sets.h"
#include "support/random.h"

namespace kontur {
namespace {

const Plane kPlane = make_plane({3, -40, 200}, {0.3, -0.5, 0.8});

Contour circle(double radius, double u, double v) { return test::circle(kPlane, radius, u, v); }

std::vector<std::size_t> depths(const std::vector<Contour>& contours) { return find_nesting(contours, 0.01).depth; }

TEST(FindNesting, CountsTheContoursAroundEachOne) {
    const std::vector<Contour> rings{circle(4, 1, 0), circle(20, 0, 0), circle(9, 2, 1), circle(3, -14, 0),
                                     circle(5, 40, 0)};
    EXPECT_EQ(depths(rings), (std::vector<std::size_t>{2, 0, 1, 1, 0}));
    EXPECT_TRUE(find_nesting(rings, 0.01).crossings.empty());
}

TEST(FindNesting, OfManyIsThatOfEveryPair) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> place(-40, 40), size(1, 15);
    std::vector<Contour> contours;
    for (int n = 0; n < 120; ++n) contours.push_back(circle(size(random), place(random), place(random)));
    const Nesting nesting = find_nesting(contours, 0.01);
    for (std::size_t a = 0; a < contours.size(); ++a) {
        std::vector<std::size_t> enclosing;
        for (std::size_t b = 0; b < contours.size(); ++b) {
            if (a == b) continue;
            const Nesting pair = find_nesting({contours[a], contours[b]}, 0.01);
            if (pair.depth[0] == 1) enclosing.push_back(b);
            EXPECT_EQ(
                std::count(nesting.crossings.begin(), nesting.crossings.end(), std::pair(std::min(a, b), std::max(a, b))),
                static_cast<std::ptrdiff_t>(pair.crossings.size()));
        }
        EXPECT_EQ(nesting.enclosing[a], enclosing);
        EXPECT_EQ(nesting.depth[a], enclosing.size());
    }
}

TEST(FindNesting, PlanesSeenFromTheirOtherSideOrAnotherOriginAreOne) {
    Plane back = make_plane(kPlane.from_uv(30, -70) + 0.004 * kPlane.normal, -kPlane.normal);
    Contour inner = circle(5, 2, 0);
    inner.plane = back;
    EXPECT_EQ(depths({circle(9, 0, 0), inner}), (std::vector<std::size_t>{0, 1}));
    inner.plane.origin += 0.1 * kPlane.normal;
    for (Vec3& p : inner.points) p += 0.1 * kPlane.normal;
    EXPECT_EQ(depths({circle(9, 0, 0), inner}), (std::vector<std::size_t>{0, 0})) << "another plane";
}

TEST(FindNesting, OpenContoursEncloseNothing) {
    Contour open = circle(20, 0, 0);
    open.closed = false;
    EXPECT_EQ(depths({circle(9, 0, 0), open, circle(4, 0, 0)}), (std::vector<std::size_t>{0, 0, 1}));
}

TEST(FindNesting, NamesContoursThatOverlapInPart) {
    const Nesting nesting = find_nesting({circle(9, 0, 0), circle(3, 30, 0), circle(9, 10, 0)}, 0.01);
    EXPECT_EQ(nesting.crossings, (std::vector<std::pair<std::size_t, std::size_t>>{{0, 2}}));
}

}  // namespace
}  // namespace kontur
