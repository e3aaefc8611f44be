// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/rule_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/derive/rule.h"
#include "kontur/derive/rule_words.h"

namespace kontur {
namespace {

/// Whether the name alone is one word that means nothing else.
bool is_word(const std::string& name) {
    if (name == "or" || name == "and") return false;
    try {
        const std::vector<RuleWord> words = words_of(name);
        return words.size() == 2 && words.front().kind == WordKind::name && words.front().text == name;
    } catch (const Error&) {
        return false;
    }
}

/// Of the name that stands at a place of the rule, with its quotes.
std::size_t bytes_of_name(const std::vector<RuleWord>& words, std::size_t place) {
    const auto found = std::find_if(words.begin(), words.end(), [&](const RuleWord& word) { return word.place == place; });
    return found->text.size() + (found->kind == WordKind::quoted_name ? 2 : 0);
}

}  // namespace

std::string name_made(const std::string& rule) { return read_rule(rule).name; }

std::string name_in_rules(std::string_view name) {
    const std::string text(name);
    if (is_word(text)) return text;
    const bool has_single = text.find('\'') != std::string::npos, has_double = text.find('"') != std::string::npos;
    if (has_single && has_double)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("the name {} has single and double quotes; rules take names with one kind of them", text));
    return has_single ? fmt::format("\"{}\"", text) : fmt::format("'{}'", text);
}

std::string with_name(const std::string& rule, std::string_view name, std::string_view other) {
    const Rule read = read_rule(rule);
    const std::vector<RuleWord> words = words_of(rule);
    std::vector<std::size_t> places;
    if (read.name == name) places.push_back(read.name_place);
    for (const NamedPlace& one : names_in(read.expression))
        if (one.name == name) places.push_back(one.place);
    std::sort(places.rbegin(), places.rend());
    std::string text = rule;
    for (const std::size_t place : places) text.replace(place, bytes_of_name(words, place), name_in_rules(other));
    return text;
}

}  // namespace kontur
