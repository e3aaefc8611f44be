// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace kontur {

/// What public entry points ask of their options and arguments. Each throws Error(invalid_input) with one sentence that
/// names the thing, its value and the limit, when it does not hold; it never holds for NaN. `what` begins the sentence ("the
/// normal offset"), `unit` follows the value (" mm").
void check_above_0(std::string_view what, double value, std::string_view unit = {});      ///< and finite
void check_not_below_0(std::string_view what, double value, std::string_view unit = {});  ///< and finite
void check_finite(std::string_view what, double value, std::string_view unit = {});
void check_from_0_to_1(std::string_view what, double value);
void check_at_least(std::string_view what, std::int64_t value, std::int64_t least);
/// The number of threads: 0, the machine's, or more.
void check_threads(int threads);
/// `count` of one thing ("slopes") for as many of another ("points").
void check_same_count(std::string_view things, std::size_t count, std::string_view of, std::size_t expected);

}  // namespace kontur
