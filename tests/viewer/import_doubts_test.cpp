// SPDX-License-Identifier: Apache-2.0
#include "viewer/files/import_doubts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "viewer/drawn_contours.h"

namespace kontur::viewer {
namespace {

using Sentences = std::vector<std::string>;

/// A circle of 10 mm in the middle of the flat image, which reaches from -0.5 to 39.5 mm, moved along the first axis.
ContourSet moved(double by_mm, const std::string& name = "Liver") {
    Contour circle{test::kPlane, test::circle(100)};
    circle.plane.origin.x += by_mm;
    for (Vec3& p : circle.points) p.x += by_mm;
    return {name, {circle}, {}, {}};
}

Sentences doubts_of(const std::vector<ContourSet>& sets, const Source& drawn = {}, const Source& image = {}) {
    return import_doubts(sets, drawn, test::flat_image()->grid, image);
}

TEST(ImportDoubts, ThereAreNoneOfWhatLiesInTheImageOrReachesALittleOutOfIt) {
    EXPECT_EQ(doubts_of({moved(0), moved(10.4), moved(18)}), Sentences{});
    EXPECT_EQ(doubts_of({ContourSet{"Empty", {}, {}, {}}}), Sentences{});
}

TEST(ImportDoubts, NameWhatLiesOutsideAndHowFar) {
    EXPECT_EQ(doubts_of({moved(0), moved(800, "GTV")}), Sentences{"GTV lies 771 mm outside of the image."});
    EXPECT_EQ(doubts_of({moved(25)}), Sentences{"65 % of the points of Liver lie outside of the image."});
    EXPECT_EQ(doubts_of({moved(-800, "")}), Sentences{"What was drawn lies 770 mm outside of the image."});
}

TEST(ImportDoubts, CountTheStructuresBeyondTheFirstFive) {
    const Sentences doubts = doubts_of(std::vector<ContourSet>(40, moved(800)));
    ASSERT_EQ(doubts.size(), 6u);
    EXPECT_EQ(doubts.back(), "35 more structures lie outside of it.");
}

TEST(ImportDoubts, AnotherFrameOfReferenceIsOneAndAnUnknownOneIsNot) {
    EXPECT_EQ(doubts_of({moved(0)}, {"1.2.3"}, {"1.2.4"}),
              Sentences{"It was drawn on another scan than this one: their frames of reference differ."});
    EXPECT_EQ(doubts_of({moved(0)}, {"1.2.3"}, {"1.2.3"}), Sentences{});
    EXPECT_EQ(doubts_of({moved(0)}, {"1.2.3"}, {}), Sentences{});
    EXPECT_EQ(doubts_of({moved(0)}, {}, {"1.2.3"}), Sentences{});
}

TEST(ImportDoubts, NamePatientsInPlaceOfNumbers) {
    EXPECT_EQ(doubts_of({moved(0)}, {"1.2.3", "Doe, Jane (ID 7)"}, {"1.2.4", "Roe, Max (ID 8)"}),
              Sentences{"It was drawn on an image of Doe, Jane (ID 7), and this image is of Roe, Max (ID 8)."});
    EXPECT_EQ(
        doubts_of({moved(0)}, {"1.2.3", "Doe, Jane (ID 7)"}, {"1.2.4", "Doe, Jane (ID 7)"}),
        Sentences{"It was drawn on another scan of Doe, Jane (ID 7) than this one: their frames of reference differ."});
    EXPECT_EQ(doubts_of({moved(0)}, {"1.2.3", ""}, {"1.2.3", "Roe, Max (ID 8)"}), Sentences{});
}

TEST(ImportDoubts, FollowAnImagesOwnAxes) {
    // Turned by 45 degrees about the third axis: its box in the patient's axes is larger than itself.
    Grid turned = test::flat_image()->grid;
    const double s = std::sqrt(0.5);
    turned.index_to_mm.set_column(0, {s, s, 0});
    turned.index_to_mm.set_column(1, {-s, s, 0});
    const auto near_corner = [&](double i, double j) {
        ContourSet set = moved(0);
        const Vec3 by = turned.index_to_mm.apply({i, j, 20}) - test::kPlane.origin;
        for (Vec3& p : set.contours[0].points) p = test::kPlane.origin + 0.2 * (p - test::kPlane.origin) + by;
        return set;
    };
    EXPECT_EQ(import_doubts({near_corner(5, 5)}, {}, turned, {}), Sentences{});
    EXPECT_EQ(import_doubts({near_corner(-5, 30)}, {}, turned, {}),
              Sentences{"100 % of the points of Liver lie outside of the image."});
}

}  // namespace
}  // namespace kontur::viewer
