// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace kontur::app {

/// The one of `names` that a misspelt `word` is nearest to, by characters changed, left out, added or swapped, whatever
/// their case; "" where the nearest differs in more than 2, or in more than a third of the word.
std::string nearest_name(std::string_view word, std::span<const std::string> names);

}  // namespace kontur::app
