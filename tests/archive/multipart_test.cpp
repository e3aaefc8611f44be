// SPDX-License-Identifier: Apache-2.0
#include "archive/multipart.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "kontur/base/error.h"

namespace kontur::archive {
namespace {

struct Parts : PartSink {
    std::vector<std::string> whole;
    std::string current;
    bool is_open = false;
    void begin_part() override {
        EXPECT_FALSE(is_open);
        is_open = true;
        current.clear();
    }
    void piece(std::string_view bytes) override { current += bytes; }
    void end_part() override {
        is_open = false;
        whole.push_back(current);
    }
};

std::string body_of(const std::vector<std::string>& parts, const std::string& border) {
    std::string body;
    for (const std::string& part : parts)
        body += "--" + border + "\r\nContent-Type: application/dicom\r\n\r\n" + part + "\r\n";
    return body + "--" + border + "--\r\n";
}

/// All of it, or the first error.
std::vector<std::string> read(const std::string& body, const std::string& border, std::size_t step) {
    Parts parts;
    MultipartReader reader(border, parts);
    for (std::size_t at = 0; at < body.size(); at += step) reader.feed(std::string_view(body).substr(at, step));
    reader.finish();
    return parts.whole;
}

/// Bytes of which many begin like a border.
std::vector<std::string> tricky_parts() {
    std::mt19937 random(52);
    std::vector<std::string> parts{"", "\r\n", "\r\n--", "--b", "\r\n--c", std::string(9, '\0')};
    for (int n = 0; n < 20; ++n) {
        std::string part;
        for (std::size_t length = random() % 300; length-- > 0;) part += "\r\n-c\0x"[random() % 6];
        parts.push_back(part);
    }
    return parts;
}

TEST(Multipart, PartsComeBackForEveryStep) {
    const std::vector<std::string> parts = tricky_parts();
    const std::string body = body_of(parts, "bord");
    for (std::size_t step = 1; step < 70; ++step) ASSERT_EQ(read(body, "bord", step), parts) << step;
    EXPECT_EQ(read(body, "bord", body.size()), parts);
}

TEST(Multipart, EveryTruncationIsToldAndKeepsWhatWasWhole) {
    const std::vector<std::string> parts{"first", "second", "third"};
    const std::string body = body_of(parts, "b");
    const std::size_t end = body.rfind("--\r\n") + 2;
    for (std::size_t length = 0; length < end; ++length) {
        Parts found;
        MultipartReader reader("b", found);
        reader.feed(body.substr(0, length));
        EXPECT_THROW(reader.finish(), Error) << length;
        for (std::size_t n = 0; n < found.whole.size(); ++n) EXPECT_EQ(found.whole[n], parts[n]);
    }
    EXPECT_EQ(read(body.substr(0, end), "b", 3), parts);
}

TEST(Multipart, WordsAroundAndBlanksBehindBordersAreNoParts) {
    EXPECT_EQ(read("preface\r\n--b \t\r\n\r\nx\r\n--b--epilogue", "b", 2), std::vector<std::string>{"x"});
    EXPECT_EQ(read("--b--", "b", 1), std::vector<std::string>{});
}

TEST(Multipart, AnotherBorderIsRefusedSoon) {
    Parts parts;
    MultipartReader reader("right", parts);
    EXPECT_THROW(
        {
            for (int n = 0; n < 100; ++n) reader.feed(std::string(100, 'x'));
        },
        Error);
    EXPECT_TRUE(parts.whole.empty());
    EXPECT_THROW(read(body_of({"x"}, "wrong"), "right", 7), Error);
    EXPECT_THROW(read(body_of({"x"}, "right-and-more"), "right", 7), Error);
}

TEST(Multipart, AHeadThatDoesNotEndIsRefused) {
    EXPECT_THROW(read("--b\r\n" + std::string(100'000, 'h'), "b", 1000), Error);
    EXPECT_THROW(read("--b" + std::string(100'000, ' '), "b", 1000), Error);
}

TEST(Multipart, TheBorderIsInTheType) {
    EXPECT_EQ(border_of("multipart/related; type=\"application/dicom\"; boundary=a-b"), "a-b");
    EXPECT_EQ(border_of("Multipart/Related; Boundary=\"a b;c\"; type=x"), "a b;c");
    EXPECT_EQ(border_of("multipart/related; boundary=abc; type=x"), "abc");
    for (const char* type : {"", "text/html", "multipart/related", "multipart/related; boundary=",
                             "multipart/related; boundary=\"\"", "application/dicom; boundary=x"})
        EXPECT_THROW(border_of(type), Error) << type;
    EXPECT_THROW(border_of("multipart/related; boundary=" + std::string(71, 'x')), Error);
}

}  // namespace
}  // namespace kontur::archive
