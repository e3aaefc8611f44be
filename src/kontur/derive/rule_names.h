// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace kontur {

/// What the rule makes. Throws RuleError as read_rule does.
std::string name_made(const std::string& rule);

/// As a rule has to write it: in quotes, unless it is a word by itself. Throws Error(invalid_input) for a name with both
/// kinds of quotes.
std::string name_in_rules(std::string_view name);

/// The rule with another name for a structure that it makes or names; all else stays as it was written. Throws as both
/// above.
std::string with_name(const std::string& rule, std::string_view name, std::string_view other);

}  // namespace kontur
