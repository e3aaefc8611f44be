// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/printable.h"

#include <gtest/gtest.h>

#include "kontur/base/error.h"

namespace kontur {
namespace {

TEST(Printable, KeepsTextOfAllLanguages) {
    EXPECT_EQ(printable_utf8("L\u00e4sion \u809d \U0001F600"), "L\u00e4sion \u809d \U0001F600");
}

TEST(Printable, ReplacesWhatTerminalsObeyAndWhatIsNoText) {
    EXPECT_EQ(printable_utf8("a\nb\x1b[31mc\x7f"), "a?b?[31mc?");
    EXPECT_EQ(printable_utf8("\u009b31m"), "?31m");                   // the same escape as one character
    EXPECT_EQ(printable_utf8("\xff\xc0\x80\xed\xa0\x80"), "??????");  // no UTF-8, overlong, a surrogate
    EXPECT_EQ(printable_utf8("\xe4"), "?");
    EXPECT_TRUE(is_utf8("\u809d"));
    EXPECT_FALSE(is_utf8("\xe4"));
}

TEST(Printable, ShortensBetweenCharacters) {
    EXPECT_EQ(shortened("short", 20), "short");
    const std::string text = shortened(std::string(50, 'x').append("\u00e4\u00e4\u00e4"), 20);
    EXPECT_EQ(text, "xxxxxxxxxxxxxx [...]");
    EXPECT_TRUE(is_utf8(shortened("\u00e4\u00e4\u00e4\u00e4\u00e4\u00e4\u00e4\u00e4\u00e4\u00e4", 11)));
}

TEST(Error, IsOneShortPrintableSentenceWhateverItQuotes) {
    const Error error(ErrorKind::corrupt_file, "the frame is \"" + std::string(1'000'000, '\n') + "\"");
    const Error outer = error.with_context("x.json");
    EXPECT_LE(std::string(outer.what()).size(), 1500u);
    EXPECT_TRUE(std::string(outer.what()).starts_with("x.json: the frame is \"???"));
}

}  // namespace
}  // namespace kontur
