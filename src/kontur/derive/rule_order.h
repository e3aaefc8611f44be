// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kontur/derive/rule.h"

namespace kontur {

/// Throws Error(invalid_input) for two rules that make one structure.
std::vector<Rule> read_rules(std::span<const std::string> texts);

/// The rules so that each comes behind those whose structures it names; of several that could come next the first. Throws
/// Error(invalid_input) with the names of all members for rules in a circle.
std::vector<std::size_t> order_of(const std::vector<Rule>& rules);

}  // namespace kontur
