// SPDX-License-Identifier: Apache-2.0
#include "viewer/files/export_fits.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "viewer/drawn_contours.h"

namespace kontur::viewer {
namespace {

/// Two balls beside each other, of one circle each.
State two_circles(bool shares_borders) {
    State state;
    state.borders.shared = shares_borders;
    for (const Id id : {3, 4}) {
        state.structures[id] = {.id = id, .name = id == 3 ? "Left" : "Right"};
        DrawnContour contour = as_drawn({test::kPlane, test::circle(40, 6), true, false});
        for (Vec3& p : contour.points) p.x += id == 3 ? -8 : 8;
        for (ControlPoint& c : contour.control) c.at.x += id == 3 ? -8 : 8;
        contour.id = id + 10;
        contour.structure = id;
        state.contours[contour.id] = std::make_shared<const DrawnContour>(contour);
    }
    return state;
}

State with_larger_left(State state) {
    DrawnContour contour = *state.contours.at(13);
    for (Vec3& p : contour.points) p.y = 20 + 1.2 * (p.y - 20);
    state.contours[13] = std::make_shared<const DrawnContour>(contour);
    return state;
}

TEST(ExportFits, WhatIsDrawnTheSameIsFittedOnce) {
    for (const bool shares : {false, true}) {
        ExportFits fits(test::flat_image());
        const State state = two_circles(shares);
        const ExportFits::Fits first = fits.all(state, {});
        ASSERT_EQ(first->size(), 2u);
        EXPECT_EQ(fits.all(two_circles(shares), {}), first) << "other contours of the same points";
        const ExportFits::Fits second = fits.all(with_larger_left(state), {});
        EXPECT_NE(second, first);
        EXPECT_NE(second->front().segmentation.mask.values, first->front().segmentation.mask.values);
        EXPECT_EQ(fits.all(state, {}), first) << "after undo";
    }
}

TEST(ExportFits, AStructureIsTheOneOfAllWhereBordersAreShared) {
    ExportFits fits(test::flat_image());
    const State state = two_circles(true);
    const ExportFits::Fits all = fits.all(state, {});
    EXPECT_EQ(fits.one(state, 4, {}).get(), &all->back());
}

TEST(ExportFits, AStructureAloneStaysWhileOthersChange) {
    ExportFits fits(test::flat_image());
    const State state = two_circles(false);
    const auto right = fits.one(state, 4, {});
    EXPECT_EQ(right->structure.name, "Right");
    EXPECT_EQ(fits.one(with_larger_left(state), 4, {}), right);
    State renamed = state;
    renamed.structures.at(4).name = "Other";
    EXPECT_EQ(fits.one(renamed, 4, {})->structure.name, "Other");
}

TEST(ExportFits, AReviewComesAlongWithoutAnotherFit) {
    ExportFits fits(test::flat_image());
    const State state = two_circles(false);
    const auto first = fits.one(state, 4, {});
    State reviewed = state;
    reviewed.structures.at(4).attributes.review.approved = Approval{"Doe", "2026-01-02T03:04:05"};
    StopSource stop;
    stop.request_stop();  // a fit would be cancelled
    const auto again = fits.one(reviewed, 4, {.stop = stop.token()});
    EXPECT_EQ(again->structure, reviewed.structures.at(4));
    EXPECT_EQ(again->set.attributes.review, reviewed.structures.at(4).attributes.review);
    EXPECT_EQ(again->segmentation.mask.values, first->segmentation.mask.values);
    EXPECT_FALSE(fits.one(state, 4, {.stop = stop.token()})->set.attributes.review.approved) << "after undo";
    EXPECT_FALSE(first->set.attributes.review.approved) << "others may still read it";
    State smoother = reviewed;
    smoother.structures.at(4).smoothing = 0.3;
    EXPECT_KONTUR_ERROR(fits.one(smoother, 4, {.stop = stop.token()}), ErrorKind::cancelled, "");
}

TEST(ExportFits, TellsWhatHasNoContours) {
    ExportFits fits(test::flat_image());
    State state = two_circles(false);
    state.contours.clear();
    EXPECT_KONTUR_ERROR(fits.all(state, {}), ErrorKind::invalid_input, "no structure has contours");
    EXPECT_THROW(fits.one(state, 3, {}), Error);
}

}  // namespace
}  // namespace kontur::viewer
