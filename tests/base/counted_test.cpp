// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/counted.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace kontur {
namespace {

TEST(Counted, OneAloneHasNoPlural) {
    EXPECT_EQ(counted(std::size_t{0}, "contour"), "0 contours");
    EXPECT_EQ(counted(std::int64_t{1}, "voxel"), "1 voxel");
    EXPECT_EQ(counted(2, "more plane"), "2 more planes");
}

}  // namespace
}  // namespace kontur
