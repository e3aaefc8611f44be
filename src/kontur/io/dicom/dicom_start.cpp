// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_start.h"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <system_error>

#include "kontur/io/bytes/input_file.h"

namespace kontur {
namespace {

constexpr std::size_t kPreambleBytes = 128;
constexpr std::size_t kHeadBytes = 1024;  ///< in which the first three elements lie: identifiers and dates
constexpr std::uint16_t kMetaGroup = 2, kIdentifyingGroup = 8;

using Bytes = std::span<const unsigned char>;

std::uint32_t number(Bytes bytes, std::size_t at, std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t n = 0; n < count; ++n) value |= std::uint32_t{bytes[at + n]} << 8 * n;
    return value;
}

struct Element {
    std::uint16_t group = 0, element = 0;
    std::size_t end = 0;  ///< where the next one begins
};

bool is_one_of(std::string_view vr, std::string_view list) { return list.find(vr) != std::string_view::npos; }

/// The little-endian element at `at`; nullopt where there is none.
std::optional<Element> element_at(Bytes head, std::size_t at, bool explicit_vr) {
    if (at + 12 > head.size()) return std::nullopt;
    Element found{static_cast<std::uint16_t>(number(head, at, 2)), static_cast<std::uint16_t>(number(head, at + 2, 2)), 0};
    const std::string_view vr(reinterpret_cast<const char*>(&head[at + 4]), 2);
    const bool is_long = is_one_of(vr, "OB UN UT SQ");
    if (explicit_vr && !is_long && !is_one_of(vr, "AE AS CS DA DT IS LO LT PN SH ST TM UI UL US")) return std::nullopt;
    const std::size_t length =
        !explicit_vr || is_long ? number(head, at + (explicit_vr ? 8 : 4), 4) : number(head, at + 6, 2);
    if (length > kHeadBytes) return std::nullopt;
    found.end = at + (explicit_vr && is_long ? 12 : 8) + length;
    return found;
}

bool starts_with_elements(Bytes head, bool explicit_vr) {
    // Meta information is always explicit, and what follows it may not be.
    const int elements = head.size() >= 2 && number(head, 0, 2) == kMetaGroup ? 2 : 3;
    std::size_t at = 0;
    std::uint32_t last = 0;
    for (int n = 0; n < elements; ++n) {
        const auto element = element_at(head, at, explicit_vr);
        if (!element || (element->group != kMetaGroup && element->group != kIdentifyingGroup)) return false;
        const std::uint32_t tag = std::uint32_t{element->group} << 16 | element->element;
        if (tag <= last) return false;
        last = tag;
        at = element->end;
    }
    return true;
}

}  // namespace

std::optional<DicomStart> dicom_start(const std::filesystem::path& path) {
    InputFile file(path);
    std::array<unsigned char, kHeadBytes> buffer{};
    const Bytes head = Bytes(buffer).first(file.read_some(buffer.data(), buffer.size()));
    if (head.size() >= kPreambleBytes + 4 &&
        std::string_view(reinterpret_cast<const char*>(&head[kPreambleBytes]), 4) == "DICM")
        return DicomStart{};
    for (const bool explicit_vr : {true, false})
        if (starts_with_elements(head, explicit_vr)) return DicomStart{false, number(head, 0, 2) == kMetaGroup, explicit_vr};
    return std::nullopt;
}

bool has_dicom_prefix(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return false;  // opening a pipe would wait for its writer
    return dicom_start(path).has_value();
}

}  // namespace kontur
