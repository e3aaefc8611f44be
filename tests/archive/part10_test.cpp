// SPDX-License-Identifier: Apache-2.0
#include "archive/part10.h"

#include <gtest/gtest.h>

namespace kontur::archive {
namespace {

std::string element(unsigned char number, const std::string& vr, const std::string& value) {
    std::string bytes{'\2', '\0', static_cast<char>(number), '\0'};
    bytes += vr;
    if (vr == "OB") bytes += std::string(2, '\0');
    bytes += static_cast<char>(value.size());
    bytes += std::string(vr == "OB" ? 3 : 1, '\0');
    return bytes + value;
}

std::string beginning(const std::string& uid) {
    std::string bytes(128, '\0');
    bytes.append("DICM");
    bytes.append(element(0, "UL", std::string("\x50\0\0\0", 4)));
    bytes.append(element(1, "OB", std::string("\0\1", 2)));
    bytes.append(element(2, "UI", "1.2.840.10008.5.1.4.1.1.2"));
    bytes.append(element(3, "UI", uid));
    bytes.append(element(16, "UI", "1.2.840.10008.1.2.1"));
    return bytes.append("\x08\0\x05\0CS\x04\0abcd", 12);
}

TEST(Part10, NamesItsObject) {
    EXPECT_EQ(media_storage_uid(beginning("1.2.34")), "1.2.34");
    EXPECT_EQ(media_storage_uid(beginning(std::string("1.2.3\0", 6))), "1.2.3");
}

TEST(Part10, WhatIsNoUidNamesNoFile) {
    EXPECT_EQ(media_storage_uid(beginning("../../etc/x")), "");
    EXPECT_EQ(media_storage_uid(beginning("")), "");
}

TEST(Part10, EveryTruncationNamesThatOrNothing) {
    const std::string whole = beginning("1.2.34");
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const std::string uid = media_storage_uid(std::string_view(whole).substr(0, length));
        EXPECT_TRUE(uid.empty() || uid == "1.2.34") << length << " " << uid;
    }
}

TEST(Part10, EveryFlippedByteIsSurvived) {
    const std::string whole = beginning("1.2.34");
    for (std::size_t at = 0; at < whole.size(); ++at)
        for (const char flip : {'\x01', '\x80', '\xff'}) {
            std::string bytes = whole;
            bytes[at] = static_cast<char>(bytes[at] ^ flip);
            media_storage_uid(bytes);
        }
}

}  // namespace
}  // namespace kontur::archive
