// SPDX-License-Identifier: Apache-2.0
#include "viewer/unkept.h"

#include <gtest/gtest.h>

#include "viewer/drawn_contours.h"

namespace kontur::viewer {
namespace {

using Sentences = std::vector<std::string>;

TEST(Unkept, EndsAndWeightsAreLeftOutInSoManyWords) {
    ContourSet set;
    const Contour closed{test::kPlane, test::circle(12)};
    Contour open = closed, flat = closed, weak = closed;
    open.closed = false;
    open.inside = Hand::right;
    flat.end = ContourEnd::flat;
    weak.weight = 0.5;
    set.contours = {closed, open, flat, weak, weak};
    EXPECT_EQ(leave_out_unkept(set), (Sentences{"left out: how the object ends at 1 contour, which the page does not keep",
                                                "left out: the weights of 2 contours, which the page does not keep; every "
                                                "contour counts as 1"}));
    ASSERT_EQ(set.contours.size(), 5u);
    for (const Contour& contour : set.contours) {
        EXPECT_EQ(contour.end, ContourEnd::automatic);
        EXPECT_EQ(contour.weight, 1);
    }
    EXPECT_FALSE(set.contours[1].closed);
    EXPECT_EQ(set.contours[1].inside, Hand::right);
    EXPECT_EQ(leave_out_unkept(set), Sentences{}) << "all that is left is kept";
}

}  // namespace
}  // namespace kontur::viewer
