// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/rule_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kontur/base/error.h"
#include "kontur/base/number_from_chars.h"

namespace kontur {
namespace {

constexpr std::size_t kMostBytes = 4000;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_name_start(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}
bool is_name_part(char c) { return is_name_start(c) || is_digit(c) || c == '.'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

class Reader {
public:
    explicit Reader(const std::string& rule) : rule_(rule) {}

    std::vector<RuleWord> all() {
        std::vector<RuleWord> words;
        while (true) {
            while (at_ < rule_.size() && is_blank(rule_[at_])) ++at_;
            if (at_ == rule_.size()) break;
            words.push_back(next());
        }
        words.push_back({WordKind::end, "", 0, rule_.size()});
        return words;
    }

private:
    RuleWord next() {
        const char c = rule_[at_];
        if (c == '"' || c == '\'') return quoted(c);
        if (is_name_start(c)) return name();
        if (is_digit(c) || (c == '.' && at_ + 1 < rule_.size() && is_digit(rule_[at_ + 1]))) return number();
        constexpr std::string_view kSigns = "=+-|&(){},";
        if (kSigns.find(c) != std::string_view::npos) return {WordKind::sign, std::string(1, c), 0, at_++};
        refuse_rule(rule_, at_,
                    fmt::format("'{}' has no meaning here; names with other signs than letters, digits, '_' and "
                                "'.' stand in quotes",
                                c));
    }

    RuleWord quoted(char quote) {
        const std::size_t start = at_, end = rule_.find(quote, at_ + 1);
        if (end == std::string::npos) refuse_rule(rule_, start, "the quotes of this name are not closed");
        if (end == start + 1) refuse_rule(rule_, start, "this name is empty");
        at_ = end + 1;
        return {WordKind::quoted_name, rule_.substr(start + 1, end - start - 1), 0, start};
    }

    RuleWord name() {
        const std::size_t start = at_;
        while (at_ < rule_.size() && is_name_part(rule_[at_])) ++at_;
        return {WordKind::name, rule_.substr(start, at_ - start), 0, start};
    }

    RuleWord number() {
        RuleWord word{WordKind::number, "", 0, at_};
        const char* const first = rule_.data() + at_;
        const std::size_t after = std::min(rule_.find_first_not_of("0123456789.", at_), rule_.size());  // no exponents
        const auto [end, failure] = number_from_chars(first, rule_.data() + after, word.number);
        if (failure != std::errc() || !std::isfinite(word.number)) refuse_rule(rule_, at_, "this is no number");
        word.text.assign(first, end);
        at_ += static_cast<std::size_t>(end - first);
        return word;
    }

    const std::string& rule_;
    std::size_t at_ = 0;
};

std::string marked(const std::string& rule, std::size_t place, std::string_view sentence) {
    constexpr std::size_t kAround = 200;  // bytes of a long rule beside the place
    const std::string_view all = rule;
    const std::size_t from = place > kAround ? place - kAround : 0;
    const auto column = 1 + std::count_if(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(place),
                                          [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
    return fmt::format("rule `{}^{}`, column {}: {}", all.substr(from, place - from), all.substr(place, kAround), column,
                       sentence);
}

}  // namespace

RuleError::RuleError(const std::string& rule, std::size_t place, std::string_view sentence)
    : Error(ErrorKind::invalid_input, marked(rule, place, sentence)), rule_(rule), sentence_(sentence), place_(place) {}

std::vector<RuleWord> words_of(const std::string& rule) {
    if (rule.size() > kMostBytes)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("a rule has {} bytes; {} are possible. Several rules may follow each other", rule.size(),
                                kMostBytes));
    return Reader(rule).all();
}

void refuse_rule(const std::string& rule, std::size_t place, std::string_view sentence) {
    throw RuleError(rule, place, sentence);
}

}  // namespace kontur
