// SPDX-License-Identifier: Apache-2.0
#include "viewer/model/label_values.h"

#include <gtest/gtest.h>

namespace kontur::viewer {
namespace {

using Own = std::vector<std::optional<std::int64_t>>;
using Values = std::vector<std::int64_t>;

TEST(LabelValues, OwnOnesStayAndOthersGetTheSmallestThatIsFree) {
    EXPECT_EQ(label_values(Own{}), Values{});
    EXPECT_EQ(label_values(Own{{}, {}, {}}), (Values{1, 2, 3}));
    EXPECT_EQ(label_values(Own{26, 27, 33}), (Values{26, 27, 33}));
    EXPECT_EQ(label_values(Own{{}, 1, {}, 3, {}}), (Values{2, 1, 4, 3, 5}));
}

TEST(LabelValues, OfTwoWithOneValueTheFirstKeepsIt) { EXPECT_EQ(label_values(Own{5, 5, {}}), (Values{5, 1, 2})); }

TEST(LabelValues, TheOwnerOfALabelIsAnotherStructure) {
    State state;
    state.structures[1] = {.id = 1, .name = "Liver", .label_value = 5};
    state.structures[2] = {.id = 2, .name = "Spleen"};
    ASSERT_NE(owner_of_label(state, 5, 2), nullptr);
    EXPECT_EQ(owner_of_label(state, 5, 2)->name, "Liver");
    EXPECT_EQ(owner_of_label(state, 5, 1), nullptr);
    EXPECT_EQ(owner_of_label(state, 1, 2), nullptr);
}

}  // namespace
}  // namespace kontur::viewer
