// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kontur {

/// Whether `a` comes before `b` as people count: "frame 2" before "frame 10". Runs of digits count as numbers of any length,
/// other characters by their bytes; where all of that is equal, fewer leading zeros come first.
bool comes_before(std::string_view a, std::string_view b) noexcept;

}  // namespace kontur
