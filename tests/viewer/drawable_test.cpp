// SPDX-License-Identifier: Apache-2.0
#include "viewer/drawable.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "viewer/drawn_contours.h"

namespace kontur::viewer {
namespace {

using Sentences = std::vector<std::string>;

TEST(Drawable, OpenLinesEndsAndWeightsAreLeftOutInSoManyWords) {
    ContourSet set;
    const Contour closed{test::kPlane, test::circle(12)};
    Contour open = closed, flat = closed, weak = closed;
    open.closed = false;
    flat.end = ContourEnd::flat;
    weak.weight = 0.5;
    set.contours = {closed, open, flat, weak, weak};
    EXPECT_EQ(leave_out_undrawable(set),
              (Sentences{"left out: 1 open line; the page draws closed contours only",
                         "left out: how the object ends at 1 contour, which the page does not keep",
                         "left out: the weights of 2 contours, which the page does not keep; every "
                         "contour counts as 1"}));
    ASSERT_EQ(set.contours.size(), 4u);
    for (const Contour& contour : set.contours) {
        EXPECT_TRUE(contour.closed);
        EXPECT_EQ(contour.weight, 1);
    }
    EXPECT_EQ(leave_out_undrawable(set), Sentences{}) << "all that is left can be drawn";
}

TEST(Drawable, OpenLinesAloneAreRefused) {
    ContourSet set;
    set.contours = {{test::kPlane, test::circle(12), false}, {test::kPlane, test::circle(12), false}};
    EXPECT_EQ(leave_out_undrawable(set).front(), "left out: 2 open lines; the page draws closed contours only");
    EXPECT_KONTUR_ERROR(check_is_drawable(set), ErrorKind::unsupported, "all its contours are open lines");
}

}  // namespace
}  // namespace kontur::viewer
