// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <concepts>

namespace kontur {

/// std::from_chars for double as istreams have it, for libc++ before version 20, which lacks it. Takes no infinity and no
/// NaN.
std::from_chars_result double_from_chars(const char* first, const char* last, double& value);

/// std::from_chars of an integer or a floating-point number, in decimal and whatever the locale.
template <class Number>
std::from_chars_result number_from_chars(const char* first, const char* last, Number& value) {
#ifndef __cpp_lib_to_chars
    if constexpr (std::floating_point<Number>) {
        double wide = 0;
        const std::from_chars_result result = double_from_chars(first, last, wide);
        if (result.ec == std::errc()) value = static_cast<Number>(wide);
        return result;
    } else
#endif
        return std::from_chars(first, last, value);
}

}  // namespace kontur
