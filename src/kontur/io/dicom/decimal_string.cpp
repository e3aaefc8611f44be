// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/decimal_string.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>

#include "kontur/base/error.h"

namespace kontur {
namespace {

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kPadding(" \t\r\n\0", 5);
    const auto first = text.find_first_not_of(kPadding);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kPadding) - first + 1);
}

/// Of a decimal number that is out of a double's range.
bool is_below_one(std::string_view digits) {
    const auto exponent = digits.find_first_of("eE");
    if (exponent != std::string_view::npos) return digits.substr(exponent + 1).starts_with('-');
    return digits.substr(digits.starts_with('-') ? 1 : 0).find_first_not_of('0') == digits.find('.');
}

double parse_number(std::string_view field, std::size_t ordinal) {
    std::string_view digits = trimmed(field);
    if (digits.starts_with('+')) digits.remove_prefix(1);
    double value = 0;
    const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    // A value too small for a double is 0 as good as any; one too large is as useless as a letter. `value` does not tell.
    const bool underflow = status == std::errc::result_out_of_range && is_below_one(digits);
    if ((status != std::errc() && !underflow) || end != digits.data() + digits.size() || !std::isfinite(value))
        throw Error(ErrorKind::corrupt_file, "value " + std::to_string(ordinal) + " is not a decimal number");
    return value;
}

}  // namespace

std::vector<double> parse_decimal_string(std::string_view text) {
    std::vector<double> values;
    text = trimmed(text);
    if (text.empty()) return values;
    values.reserve(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\\')) + 1);
    for (;;) {
        const auto separator = text.find('\\');
        values.push_back(parse_number(text.substr(0, separator), values.size() + 1));
        if (separator == std::string_view::npos) return values;
        text.remove_prefix(separator + 1);
    }
}

std::string to_decimal_string(double value) {
    constexpr std::ptrdiff_t kMaxLength = 16;
    assert(std::isfinite(value));
    if (value == 0) return "0";  // without a minus sign
    std::array<char, 40> text{};
    char* const begin = text.data();
    char* end = std::to_chars(begin, begin + text.size(), value).ptr;
    for (int digits = 15; end - begin > kMaxLength; --digits)
        end = std::to_chars(begin, begin + text.size(), value, std::chars_format::general, digits).ptr;
    return {begin, end};
}

}  // namespace kontur
