// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/bytes/base64.h"

#include <algorithm>
#include <cstdint>

namespace kontur {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

int value_of(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

}  // namespace

std::string to_base64(std::span<const unsigned char> bytes) {
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t n = 0; n < bytes.size(); n += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - n);
        std::uint32_t group = 0;
        for (std::size_t i = 0; i < 3; ++i) group = group << 8 | (i < count ? bytes[n + i] : 0u);
        for (std::size_t i = 0; i < 4; ++i) text += i <= count ? kDigits[group >> (18 - 6 * i) & 63] : '=';
    }
    return text;
}

std::string from_base64(std::string_view text, std::size_t most_bytes) {
    std::string bytes;
    std::uint32_t group = 0;
    int digits = 0, padding = 0;
    for (const char c : text) {
        if (bytes.size() >= most_bytes) break;
        if (c == ' ' || c == '\t' || c == '\n' || c == '\r') continue;
        const int value = value_of(c);
        if (value < 0 && c != '=') break;
        padding += c == '=';
        group = group << 6 | static_cast<std::uint32_t>(std::max(value, 0));
        if (++digits < 4) continue;
        for (int i = 0; i < 3 - std::min(padding, 2); ++i) bytes += static_cast<char>(group >> (16 - 8 * i) & 255);
        group = 0;
        digits = padding = 0;
    }
    if (bytes.size() > most_bytes) bytes.resize(most_bytes);
    return bytes;
}

}  // namespace kontur
