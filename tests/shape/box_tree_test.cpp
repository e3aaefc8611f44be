// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/box_tree.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace kontur {
namespace {

Box2 box_at(double u, double v, double width, double height) {
    Box2 box;
    box.extend(Point2{u, v});
    box.extend(Point2{u + width, v + height});
    return box;
}

/// Of all sizes, some of them equal, one of them empty.
std::vector<Box2> random_boxes(std::mt19937& random, int count) {
    std::uniform_real_distribution<double> place(-20, 20), size(0, 5);
    std::vector<Box2> boxes;
    for (int n = 0; n < count; ++n) boxes.push_back(box_at(place(random), place(random), size(random), size(random)));
    boxes.push_back(boxes[0]);
    boxes.push_back(Box2{});
    return boxes;
}

template <class Visit>
std::vector<std::size_t> sorted(const Visit& visit) {
    std::vector<std::size_t> found;
    visit([&](std::size_t i) { found.push_back(i); });
    std::sort(found.begin(), found.end());
    return found;
}

TEST(BoxTree, FindsWhatLookingAtAllBoxesFinds) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> coordinate(-22, 22);
    for (int count = 1; count < 60; ++count) {
        const std::vector<Box2> boxes = random_boxes(random, count);
        const BoxTree tree(boxes);
        for (int n = 0; n < 50; ++n) {
            const Point2 p{coordinate(random), coordinate(random)};
            const Box2 other = box_at(p[0], p[1], n % 7, n % 5);
            std::vector<std::size_t> around, meeting;
            double nearest2 = std::numeric_limits<double>::infinity(), found2 = nearest2;
            for (std::size_t i = 0; i < boxes.size(); ++i) {
                if (boxes[i].contains(p)) around.push_back(i);
                if (boxes[i].meets(other)) meeting.push_back(i);
                nearest2 = std::min(nearest2, boxes[i].distance2(p));
            }
            EXPECT_EQ(sorted([&](const auto& visit) { tree.visit_around(p, visit); }), around);
            EXPECT_EQ(sorted([&](const auto& visit) { tree.visit_meeting(other, visit); }), meeting);
            tree.visit([&](const Box2& box) { return box.distance2(p); }, [&] { return found2; },
                       [&](std::size_t i) { found2 = std::min(found2, boxes[i].distance2(p)); });
            EXPECT_EQ(found2, nearest2);
        }
    }
}

TEST(BoxTree, OfNothingHasNothing) {
    for (const BoxTree& tree : {BoxTree(), BoxTree({Box2{}})})
        tree.visit([](const Box2&) { return 0.0; }, [] { return 1.0; }, [](std::size_t) { FAIL(); });
}

/// Boxes that a search for the nearest one looks at, in a lattice of side * side of them, on average.
double looked_at(int side) {
    std::vector<Box2> boxes;
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) boxes.push_back(box_at(column, row, 0.6, 0.6));
    const BoxTree tree(boxes);
    int looks = 0, searches = 0;
    for (int row = 0; row < side; row += side / 8)
        for (int column = 0; column < side; column += side / 8, ++searches) {
            const Point2 p{column + 0.71, row + 0.83};
            double found2 = std::numeric_limits<double>::infinity();
            const auto key = [&](const Box2& box) {
                ++looks;
                return box.distance2(p);
            };
            tree.visit(
                key, [&] { return found2; }, [&](std::size_t i) { found2 = std::min(found2, boxes[i].distance2(p)); });
        }
    return static_cast<double>(looks) / searches;
}

TEST(BoxTree, SearchCostsTheLogarithmOfTheBoxes) {
    const double few = looked_at(16), many = looked_at(256);  // 256 times as many
    EXPECT_LT(few, 64);
    EXPECT_LT(many, few + 32);
}

}  // namespace
}  // namespace kontur
