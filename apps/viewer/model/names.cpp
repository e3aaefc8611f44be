// SPDX-License-Identifier: Apache-2.0
#include "viewer/model/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "kontur/base/error.h"

namespace kontur::viewer {
namespace {

struct Character {
    std::uint32_t code = 0;
    std::size_t bytes = 1;
};

/// The character at the start of UTF-8 that has been checked.
Character first_of(std::string_view text) {
    const auto lead = static_cast<unsigned char>(text.front());
    const std::size_t bytes = lead < 0x80 ? 1 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
    std::uint32_t code = bytes == 1 ? lead : lead & (0x7fu >> bytes);
    for (std::size_t i = 1; i < bytes && i < text.size(); ++i)
        code = code << 6 | (static_cast<unsigned char>(text[i]) & 0x3fu);
    return {code, std::min(bytes, text.size())};
}

/// Unicode's categories Cc and Zl, Zp, and its marks and embeddings of direction.
bool is_refused(std::uint32_t code) {
    const bool is_control = code < 0x20 || (code >= 0x7f && code <= 0x9f) || code == 0x2028 || code == 0x2029;
    const bool is_direction = code == 0x061c || code == 0x200e || code == 0x200f || (code >= 0x202a && code <= 0x202e) ||
                              (code >= 0x2066 && code <= 0x2069);
    return is_control || is_direction;
}

}  // namespace

void check_name(std::string_view name) {
    while (!name.empty()) {
        const Character next = first_of(name);
        if (is_refused(next.code))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("the name holds the character U+{:04X}; names take no control characters and no "
                                    "text-direction marks. Type the name again",
                                    next.code));
        name.remove_prefix(next.bytes);
    }
}

std::string plain_text(std::string_view name) {
    std::string plain;
    while (!name.empty()) {
        const Character next = first_of(name);
        if (!is_refused(next.code)) plain += name.substr(0, next.bytes);
        name.remove_prefix(next.bytes);
    }
    return plain;
}

}  // namespace kontur::viewer
