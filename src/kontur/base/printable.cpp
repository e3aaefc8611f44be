// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/printable.h"

#include "kontur/base/error.h"

namespace kontur {
namespace {

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

/// Length of the well-formed UTF-8 sequence at the front; 0 when there is none.
std::size_t utf8_sequence(std::string_view text) {
    const auto lead = static_cast<unsigned char>(text[0]);
    const std::size_t length = lead < 0x80                   ? 1
                               : lead >= 0xC2 && lead < 0xE0 ? 2
                               : (lead & 0xF0) == 0xE0       ? 3
                               : lead >= 0xF0 && lead < 0xF5 ? 4
                                                             : 0;
    if (length == 0 || text.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if (!is_continuation(text[i])) return 0;
    const auto second = length > 1 ? static_cast<unsigned char>(text[1]) : 0;
    const bool overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
    const bool surrogate = lead == 0xED && second >= 0xA0, beyond = lead == 0xF4 && second >= 0x90;
    return overlong || surrogate || beyond ? 0 : length;
}

/// Terminals obey those of one byte and, some of them, U+0080 to U+009F.
bool is_control(std::string_view character) {
    const auto first = static_cast<unsigned char>(character[0]);
    if (character.size() == 1) return first < 0x20 || first == 0x7F;
    return first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0;
}

}  // namespace

bool is_utf8(std::string_view text) noexcept {
    while (!text.empty()) {
        const std::size_t length = utf8_sequence(text);
        if (length == 0) return false;
        text.remove_prefix(length);
    }
    return true;
}

void check_utf8(std::string_view text, std::string_view what) {
    constexpr std::size_t kMostQuoted = 160;
    if (!is_utf8(text))
        throw Error(ErrorKind::invalid_input, std::string(what) + " '" + shortened(text, kMostQuoted) +
                                                  "' is not UTF-8, the encoding of names in files");
}

std::string printable_utf8(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::size_t length = utf8_sequence(text);
        if (length == 0 || is_control(text.substr(0, length))) result += '?';
        else result += text.substr(0, length);
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return result;
}

std::string shortened(std::string_view text, std::size_t most_bytes) {
    constexpr std::string_view kMore = " [...]";
    if (text.size() <= most_bytes) return printable_utf8(text);
    std::size_t length = most_bytes - kMore.size();
    while (length > 0 && is_continuation(text[length])) --length;
    return printable_utf8(text.substr(0, length)) + std::string(kMore);
}

std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

std::string without_case(std::string_view text) {
    std::string small(text);
    for (std::size_t i = 0; i < small.size(); ++i) {
        const auto byte = static_cast<unsigned char>(small[i]),
                   before = static_cast<unsigned char>(i > 0 ? small[i - 1] : 0);
        const bool is_latin1_capital = before == 0xC3 && byte >= 0x80 && byte <= 0x9E && byte != 0x97;  // U+00D7 is a sign
        if ((byte >= 'A' && byte <= 'Z') || is_latin1_capital) small[i] = static_cast<char>(byte + 0x20);
    }
    return small;
}

std::string latin1_to_utf8(std::string_view text) {
    std::string utf8;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x80) utf8 += c;
        else utf8 += {static_cast<char>(0xC0 | byte >> 6), static_cast<char>(0x80 | (byte & 0x3F))};
    }
    return utf8;
}

}  // namespace kontur
