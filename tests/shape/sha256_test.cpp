// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/sha256.h"

#include <gtest/gtest.h>

#include <string_view>

#include "kontur/shape/plain_sha256.h"

namespace kontur {
namespace {

std::string sha256(std::string_view text) {
    Sha256 hash;
    hash.update(std::as_bytes(std::span(text)));
    return hash.hex();
}

// NIST's examples for FIPS 180-4.
TEST(Sha256, GivesThePublishedDigests) {
    EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(sha256(std::string(1'000'000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, DoesNotDependOnThePieces) {
    const std::string text(300, 'k');
    for (std::size_t length = 0; length <= text.size(); ++length) {
        const std::string_view whole = std::string_view(text).substr(0, length);
        Sha256 hash;
        for (std::size_t begin = 0, piece = 1; begin < length; begin += piece, piece = piece * 5 % 67 + 1)
            hash.update(std::as_bytes(std::span(whole.substr(begin, piece))));
        EXPECT_EQ(hash.hex(), sha256(whole)) << length;
    }
}

TEST(PlainSha256, GivesOpenSslsDigestsOfEveryLengthAndInPieces) {
    std::string text;
    for (int n = 0; n < 300; ++n) text += static_cast<char>(37 * n % 251);
    for (std::size_t length = 0; length <= text.size(); ++length) {
        const std::string_view whole = std::string_view(text).substr(0, length);
        PlainSha256 hash;
        for (std::size_t begin = 0, piece = 1; begin < length; begin += piece, piece = piece * 5 % 67 + 1)
            hash.update(std::as_bytes(std::span(whole.substr(begin, piece))));
        EXPECT_EQ(hash.hex(), sha256(whole)) << length;
        EXPECT_EQ(hash.hex(), sha256(whole)) << "asking changes nothing";
    }
}

}  // namespace
}  // namespace kontur
