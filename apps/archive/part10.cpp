// SPDX-License-Identifier: Apache-2.0
#include "archive/part10.h"

#include "archive/address.h"

namespace kontur::archive {
namespace {

constexpr std::size_t kPreamble = 128;
constexpr unsigned kMediaStorageSopInstanceUid = 0x0003;

unsigned number(std::string_view bytes, std::size_t at, std::size_t count) {
    unsigned value = 0;
    for (std::size_t n = count; n-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + n]);
    return value;
}

bool has_long_length(std::string_view vr) {
    return vr == "OB" || vr == "OW" || vr == "OF" || vr == "SQ" || vr == "UN" || vr == "UT";
}

}  // namespace

std::string media_storage_uid(std::string_view beginning) {
    if (beginning.size() < kPreamble + 4 || beginning.substr(kPreamble, 4) != "DICM") return "";
    // Group 2 is in explicit VR, little endian, whatever the rest is in.
    for (std::size_t at = kPreamble + 4; at + 12 <= beginning.size() && number(beginning, at, 2) == 0x0002;) {
        const unsigned element = number(beginning, at + 2, 2);
        const bool is_long = has_long_length(beginning.substr(at + 4, 2));
        const std::size_t start = at + (is_long ? 12 : 8),
                          length = number(beginning, at + (is_long ? 8 : 6), is_long ? 4 : 2);
        if (length > beginning.size() - start) return "";
        std::string_view value = beginning.substr(start, length);
        at = start + length;
        if (element != kMediaStorageSopInstanceUid) continue;
        while (!value.empty() && (value.back() == '\0' || value.back() == ' ')) value.remove_suffix(1);
        return is_uid(value) ? std::string(value) : "";
    }
    return "";
}

}  // namespace kontur::archive
