// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/natural_order.h"

#include <gtest/gtest.h>

#include <array>
#include <string_view>

namespace kontur {
namespace {

TEST(NaturalOrder, CountsAsPeopleDo) {
    constexpr std::array<std::string_view, 12> kOrdered{
        "",      "2", "10", "a", "a 1.nii", "a 01.nii", "a 2.nii", "a 10.nii", "a 10b.nii", "a 99999999999999999999999.nii",
        "a.nii", "b"};
    for (std::size_t i = 0; i < kOrdered.size(); ++i)
        for (std::size_t j = 0; j < kOrdered.size(); ++j)
            EXPECT_EQ(comes_before(kOrdered[i], kOrdered[j]), i < j) << kOrdered[i] << " and " << kOrdered[j];
}

TEST(NaturalOrder, TellsNamesApartThatDifferInZerosAlone) {
    EXPECT_TRUE(comes_before("x1y02", "x01y2") != comes_before("x01y2", "x1y02"));
    EXPECT_FALSE(comes_before("x007", "x007"));
}

}  // namespace
}  // namespace kontur
