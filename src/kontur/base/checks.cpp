// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/checks.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "kontur/base/error.h"

namespace kontur {
namespace {

[[noreturn]] void refuse(std::string_view what, const std::string& value, std::string_view must_be) {
    throw Error(ErrorKind::invalid_input, std::string(what) + " is " + value + "; it must be " + std::string(must_be));
}

std::string text(double value, std::string_view unit) {
    std::array<char, 32> digits{};
    std::snprintf(digits.data(), digits.size(), "%g", value);
    return digits.data() + std::string(unit);
}

}  // namespace

void check_above_0(std::string_view what, double value, std::string_view unit) {
    if (!(value > 0 && std::isfinite(value))) refuse(what, text(value, unit), "finite and above 0");
}

void check_not_below_0(std::string_view what, double value, std::string_view unit) {
    if (!(value >= 0 && std::isfinite(value))) refuse(what, text(value, unit), "finite and at least 0");
}

void check_finite(std::string_view what, double value, std::string_view unit) {
    if (!std::isfinite(value)) refuse(what, text(value, unit), "finite");
}

void check_from_0_to_1(std::string_view what, double value) {
    if (!(value >= 0 && value <= 1)) refuse(what, text(value, {}), "from 0 to 1");
}

void check_at_least(std::string_view what, std::int64_t value, std::int64_t least) {
    if (value < least) refuse(what, std::to_string(value), "at least " + std::to_string(least));
}

void check_threads(int threads) { check_at_least("the number of threads", threads, 0); }

void check_same_count(std::string_view things, std::size_t count, std::string_view of, std::size_t expected) {
    if (count == expected) return;
    throw Error(ErrorKind::invalid_input, "there are " + std::to_string(count) + " " + std::string(things) + " for " +
                                              std::to_string(expected) + " " + std::string(of) +
                                              "; there must be one for each");
}

}  // namespace kontur
