// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <string>

namespace kontur::test {

/// A generator whose seed follows from the running test's name.
inline std::mt19937 random_of_this_test() {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    return std::mt19937(
        static_cast<unsigned>(std::hash<std::string>{}(std::string(test->test_suite_name()) + test->name())));
}

}  // namespace kontur::test
