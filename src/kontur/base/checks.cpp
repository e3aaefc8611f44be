// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/checks.h"

#include <fmt/format.h>

#include <cmath>

#include "kontur/base/error.h"

namespace kontur {

void check_above_0(std::string_view what, double value, std::string_view unit) {
    if (!(value > 0 && std::isfinite(value)))
        throw Error(ErrorKind::invalid_input, fmt::format("{} is {:g}{}; it must be finite and above 0", what, value, unit));
}

void check_not_below_0(std::string_view what, double value, std::string_view unit) {
    if (!(value >= 0 && std::isfinite(value)))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} is {:g}{}; it must be finite and at least 0", what, value, unit));
}

void check_at_least(std::string_view what, std::int64_t value, std::int64_t least) {
    if (value < least)
        throw Error(ErrorKind::invalid_input, fmt::format("{} is {}; it must be at least {}", what, value, least));
}

void check_threads(int threads) { check_at_least("the number of threads", threads, 0); }

void check_same_count(std::string_view things, std::size_t count, std::string_view of, std::size_t expected) {
    if (count != expected)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("there are {} {} for {} {}; there must be one for each", count, things, expected, of));
}

}  // namespace kontur
