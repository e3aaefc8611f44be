// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/number_from_chars.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <string>

#include "support/random.h"

namespace kontur {
namespace {

void expect_the_same(const std::string& text) {
    double expected = 7, value = 7;
    const char *first = text.data(), *last = first + text.size();
    const auto [end, error] = std::from_chars(first, last, expected);
    const auto [own_end, own_error] = double_from_chars(first, last, value);
    EXPECT_EQ(own_end - first, end - first) << text;
    EXPECT_EQ(own_error, error) << text;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(expected)) << text;
}

TEST(NumberFromChars, ReadsEveryDoubleAsTheStandardLibraryDoes) {
    std::mt19937_64 random(test::random_of_this_test()());
    for (int i = 0; i < 20000; ++i) {
        const auto value = std::bit_cast<double>(random());
        if (std::fpclassify(value) != FP_NORMAL) continue;
        std::array<char, 64> text;
        for (const std::chars_format format : {std::chars_format::general, std::chars_format::scientific})
            expect_the_same({text.data(), std::to_chars(text.data(), text.data() + text.size(), value, format).ptr});
    }
}

TEST(NumberFromChars, StopsWhereTheStandardLibraryStops) {
    for (const char* text :
         {"",     "-",    ".",    "-.",    "+1", " 1",  "1 ",    "1.",     ".5",      "-.5", "1.5.2", "1e",  "1e+",
          "1e5x", "1E-3", "0x10", "12abc", "e5", "--1", "1e400", "-1e400", "00012.5", "1,5", "-0",    "1e05"})
        expect_the_same(text);
}

}  // namespace
}  // namespace kontur
