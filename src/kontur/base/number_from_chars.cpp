// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/number_from_chars.h"

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>
#include <string>

namespace kontur {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Behind the longest decimal number that begins here; `first` where none does.
const char* end_of_number(const char* first, const char* last) {
    const char* at = first != last && *first == '-' ? first + 1 : first;
    const char* const whole = at;
    at = std::find_if_not(at, last, is_digit);
    auto digits = at - whole;
    if (at != last && *at == '.') {
        const char* const fraction = at + 1;
        at = std::find_if_not(fraction, last, is_digit);
        digits += at - fraction;
    }
    if (digits == 0) return first;
    if (at == last || (*at != 'e' && *at != 'E')) return at;
    const char* power = at + 1;
    if (power != last && (*power == '-' || *power == '+')) ++power;
    const char* const end = std::find_if_not(power, last, is_digit);
    return end == power ? at : end;
}

}  // namespace

std::from_chars_result double_from_chars(const char* first, const char* last, double& value) {
    const char* const end = end_of_number(first, last);
    if (end == first) return {first, std::errc::invalid_argument};
    std::istringstream stream(std::string(first, end));
    stream.imbue(std::locale::classic());
    double number = 0;
    stream >> number;
    if (stream.fail() || std::isinf(number)) return {end, std::errc::result_out_of_range};
    value = number;
    return {end, std::errc()};
}

}  // namespace kontur
