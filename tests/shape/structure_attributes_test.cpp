// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/structure_attributes.h"

#include <gtest/gtest.h>

namespace kontur {
namespace {

TEST(Colors, EveryByteComesBack) {
    for (int byte = 0; byte <= 255; ++byte) {
        const auto level = static_cast<std::uint8_t>(byte);
        const std::array<std::uint8_t, 3> rgb{level, 0, 255};
        EXPECT_EQ(to_rgb8(to_levels(rgb)), rgb);
    }
}

TEST(Colors, LevelsAreRoundedToTheNearestAndCut) {
    using Rgb8 = std::array<std::uint8_t, 3>;
    EXPECT_EQ(to_rgb8({0.4999, 0.5, 0.9999}), (Rgb8{127, 128, 255}));
    EXPECT_EQ(to_rgb8({-3, 1.5, 0}), (Rgb8{0, 255, 0}));
}

TEST(FittedAttributes, SayAllButHowItWasMade) {
    StructureAttributes drawn{.interpreted_type = "GTV", .generation_algorithm = "MANUAL", .description = "of the left"};
    const StructureAttributes fitted = fitted_attributes(drawn);
    EXPECT_EQ(fitted.generation_algorithm, "SEMIAUTOMATIC");
    drawn.generation_algorithm = fitted.generation_algorithm;
    EXPECT_EQ(fitted, drawn);
}

TEST(FittedAttributes, AreApprovedAndLockedByNobody) {
    const Review review{Approval{"Doe", "2026-11-30T21:02:43"}, "cropped", true};
    EXPECT_EQ(fitted_attributes({.review = review}).review, (Review{.comment = "cropped"}));
}

}  // namespace
}  // namespace kontur
