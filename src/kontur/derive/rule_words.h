// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/base/error.h"

namespace kontur {

enum class WordKind { name, quoted_name, number, sign, end };

/// A word of a rule.
struct RuleWord {
    WordKind kind;
    std::string text;  ///< without quotes
    double number = 0;
    std::size_t place = 0;  ///< of its first byte in the rule
};

/// The words of a rule, with one of kind `end` behind the last. Names are letters, digits, '_', '.' and whatever is no
/// ASCII, and begin with none of the digits; all others stand in quotes, single or double. Throws as `refuse_rule` does.
std::vector<RuleWord> words_of(const std::string& rule);

/// What is wrong with a rule, and where. Its sentence has a mark before the place and its column, from 1.
class RuleError : public Error {
public:
    RuleError(const std::string& rule, std::size_t place, std::string_view sentence);

    const std::string& rule() const noexcept { return rule_; }
    /// In bytes.
    std::size_t place() const noexcept { return place_; }
    /// Without rule and column.
    const std::string& sentence() const noexcept { return sentence_; }

private:
    std::string rule_, sentence_;
    std::size_t place_;
};

/// Throws RuleError(invalid_input).
[[noreturn]] void refuse_rule(const std::string& rule, std::size_t place, std::string_view sentence);

}  // namespace kontur
