// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "kontur/function/implicit_function.h"

namespace kontur::test {

/// To the last bit.
inline void expect_same_function(const ImplicitFunction& a, const ImplicitFunction& b) {
    EXPECT_EQ(a.centers().x, b.centers().x);
    EXPECT_EQ(a.centers().y, b.centers().y);
    EXPECT_EQ(a.centers().z, b.centers().z);
    EXPECT_TRUE(std::ranges::equal(a.weights(), b.weights()));
    EXPECT_EQ(a.polynomial(), b.polynomial());
}

}  // namespace kontur::test
