// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_nesting.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include "kontur/io/dicom/decimal_string.h"
#include "support/damage.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

std::string le(std::uint64_t value, int bytes) {
    std::string text;
    for (int n = 0; n < bytes; ++n) text += static_cast<char>(value >> 8 * n & 255);
    return text;
}

std::string element(int group, int number, const std::string& vr, const std::string& value) {
    return le(static_cast<unsigned>(group), 2) + le(static_cast<unsigned>(number), 2) + vr + le(value.size(), 2) + value;
}

std::string head(std::string syntax) {
    if (syntax.size() % 2) syntax += '\0';
    const std::string meta = element(2, 0x10, "UI", syntax);
    return std::string(128, '\0') + "DICM" + element(2, 0, "UL", le(meta.size(), 4)) + meta;
}

const std::string kExplicit = "1.2.840.10008.1.2.1", kImplicit = "1.2.840.10008.1.2";
const std::string kItem = le(0xFFFE, 2) + le(0xE000, 2), kItemEnd = le(0xFFFE, 2) + le(0xE00D, 2) + le(0, 4),
                  kSequenceEnd = le(0xFFFE, 2) + le(0xE0DD, 2) + le(0, 4);

/// ReferencedImageSequence in itself, of undefined or of known length.
std::string nested(int levels, bool is_explicit, bool known_length) {
    std::string inner;
    for (int n = 0; n < levels; ++n) {
        const std::string item = kItem + (known_length ? le(inner.size(), 4) + inner : le(~0u, 4) + inner + kItemEnd);
        const std::string length = known_length ? le(item.size(), 4) : le(~0u, 4);
        inner = le(8, 2) + le(0x1140, 2) + (is_explicit ? "SQ" + le(0, 2) : "") + length + item +
                (known_length ? "" : kSequenceEnd);
    }
    return inner;
}

TEST(DicomNesting, AcceptsAHundredLevelsAndRefusesMoreHoweverTheyAreWritten) {
    const test::TemporaryFolder folder;
    for (const bool is_explicit : {true, false})
        for (const bool known_length : {true, false}) {
            test::write_bytes(folder / "a",
                              head(is_explicit ? kExplicit : kImplicit) + nested(100, is_explicit, known_length));
            EXPECT_NO_THROW(check_dicom_nesting(folder / "a"));
            test::write_bytes(folder / "a",
                              head(is_explicit ? kExplicit : kImplicit) + nested(101, is_explicit, known_length));
            EXPECT_KONTUR_ERROR(check_dicom_nesting(folder / "a"), ErrorKind::corrupt_file, "more than 100 deep");
        }
}

TEST(DicomNesting, CountsWithoutPreambleAndWithoutMetaInformation) {
    const test::TemporaryFolder folder;
    const auto without_meta = [](bool is_explicit) {
        const auto plain = [&](int number, const std::string& value) {
            return is_explicit ? element(8, number, "UI", value)
                               : le(8, 2) + le(static_cast<unsigned>(number), 2) + le(value.size(), 4) + value;
        };
        return plain(0x14, "1.2.3.40") + plain(0x16, "1.2.3.40") + plain(0x18, "1.2.3.40");
    };
    for (const bool is_explicit : {true, false})
        for (const int levels : {100, 101}) {
            const std::string inner = nested(levels, is_explicit, false);
            for (const std::string& start :
                 {without_meta(is_explicit),
                  head(is_explicit ? kExplicit : kImplicit).substr(132) + without_meta(is_explicit)}) {
                test::write_bytes(folder / "a", start + inner);
                if (levels == 100) EXPECT_NO_THROW(check_dicom_nesting(folder / "a"));
                else EXPECT_KONTUR_ERROR(check_dicom_nesting(folder / "a"), ErrorKind::corrupt_file, "more than 100 deep");
            }
        }
}

TEST(DicomNesting, SequencesHiddenInUnknownElementsCount) {
    const test::TemporaryFolder folder;
    const std::string unknown = le(9, 2) + le(0x1001, 2) + "UN" + le(0, 2) + le(~0u, 4) + kItem + le(~0u, 4);
    test::write_bytes(folder / "a", head(kExplicit) + unknown + nested(100, false, false));
    EXPECT_KONTUR_ERROR(check_dicom_nesting(folder / "a"), ErrorKind::corrupt_file, "more than 100 deep");
}

TEST(DicomNesting, DisorderIsAcceptedWhileItCannotNestDeep) {
    const test::TemporaryFolder folder;
    std::string few = head(kExplicit) + "\x09\x10\x01\x01??";
    for (int n = 0; n < 1000; ++n) few += kItem;
    test::write_bytes(folder / "a", few);
    EXPECT_NO_THROW(check_dicom_nesting(folder / "a"));
    std::string many = few;
    for (int n = 0; n < 3000; ++n) many += kItem;
    test::write_bytes(folder / "a", many);
    EXPECT_KONTUR_ERROR(check_dicom_nesting(folder / "a"), ErrorKind::corrupt_file, "do not follow one another");
}

TEST(DicomNesting, FollowsMetaInformationWithoutItsLengthAndZerosBehindTheLastElement) {
    const test::TemporaryFolder folder;
    for (const bool is_explicit : {true, false}) {
        const std::string with_length = head(is_explicit ? kExplicit : kImplicit), zeros(512, '\0');
        const std::string without = with_length.substr(0, 132) + with_length.substr(144);
        std::string siblings = le(8, 2) + le(0x1140, 2) + (is_explicit ? "SQ" + le(0, 2) : "") + le(~0u, 4);
        for (int n = 0; n < 5000; ++n) siblings += kItem + le(0, 4);
        siblings += kSequenceEnd;
        for (const std::string& bytes : {without + siblings, with_length + siblings + zeros, without + siblings + zeros}) {
            test::write_bytes(folder / "a", bytes);
            EXPECT_NO_THROW(check_dicom_nesting(folder / "a"));
        }
        test::write_bytes(folder / "a", without + nested(101, is_explicit, false));
        EXPECT_KONTUR_ERROR(check_dicom_nesting(folder / "a"), ErrorKind::corrupt_file, "more than 100 deep");
        test::write_bytes(folder / "a", with_length + siblings + zeros + "x");
        EXPECT_KONTUR_ERROR(check_dicom_nesting(folder / "a"), ErrorKind::corrupt_file, "do not follow one another");
    }
}

TEST(DicomNesting, ManySiblingsAreNoDepth) {
    const test::TemporaryFolder folder;
    std::string siblings = le(8, 2) + le(0x1140, 2) + "SQ" + le(0, 2) + le(~0u, 4);
    for (int n = 0; n < 50'000; ++n) siblings += kItem + le(0, 4);
    test::write_bytes(folder / "a", head(kExplicit) + siblings + kSequenceEnd);
    EXPECT_NO_THROW(check_dicom_nesting(folder / "a"));
}

/// As the deflated transfer syntax stores a data set: raw, without zlib's frame.
std::string deflated(const std::string& data_set) {
    z_stream stream{};
    EXPECT_EQ(deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
    std::string out(deflateBound(&stream, data_set.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data_set.data()));
    stream.avail_in = static_cast<uInt>(data_set.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

TEST(DicomNesting, DeflatedElementsThatClaimGigabytesAreRefusedBeforeTheyAreRead) {
    const test::TemporaryFolder folder;
    const auto scan = [&](const std::string& data_set) {
        test::write_bytes(folder / "a", head("1.2.840.10008.1.2.1.99") + deflated(data_set));
        check_dicom_nesting(folder / "a");
    };
    const auto claim = [](int group, std::uint64_t bytes) {
        return le(static_cast<unsigned>(group), 2) + le(0x10, 2) + "OB" + le(0, 2) + le(bytes, 4);
    };
    EXPECT_KONTUR_ERROR(scan(claim(9, 3'861'907'456)), ErrorKind::corrupt_file,
                        "claim 3683 MB beside the pixels; at most 128 MB");
    const std::string half = claim(9, 70 << 20) + std::string(70 << 20, '\0');
    EXPECT_NO_THROW(scan(half));
    EXPECT_KONTUR_ERROR(scan(half + half), ErrorKind::corrupt_file, "claim 140 MB");
    EXPECT_KONTUR_ERROR(scan(claim(0x7FE0, 3'000'000'000)), ErrorKind::corrupt_file,
                        "claims 3000000000 bytes, more than there are");
    EXPECT_NO_THROW(scan(claim(0x7FE0, 200 << 20) + std::string(200 << 20, '\0')));
    EXPECT_KONTUR_ERROR(scan("\x09\x10\x01\x01??"), ErrorKind::corrupt_file, "do not follow one another");
}

TEST(DecimalString, NumbersBeyondADoubleAreNoZeros) {
    for (const char* text : {"9e999", "-9e999", "1e+400"})
        EXPECT_KONTUR_ERROR(parse_decimal_string(text), ErrorKind::corrupt_file, "not a decimal number");
    EXPECT_KONTUR_ERROR(parse_decimal_string(std::string(400, '9')), ErrorKind::corrupt_file, "not a decimal number");
    for (const char* text : {"9e-999", "-1E-400"}) EXPECT_EQ(parse_decimal_string(text), std::vector<double>{0.0});
    EXPECT_EQ(parse_decimal_string("0." + std::string(400, '0') + "1"), std::vector<double>{0.0});
}

}  // namespace
}  // namespace kontur
