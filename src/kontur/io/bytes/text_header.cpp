// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/bytes/text_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "kontur/base/number_from_chars.h"

namespace kontur {
namespace {

template <typename Value>
std::optional<Value> parse_all(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    Value value{};
    const auto [end, error] = number_from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

template <typename Value>
std::optional<std::vector<Value>> parse_list(std::string_view text, std::size_t count) {
    std::vector<Value> values;
    for (const std::string_view word : words(text)) {
        const auto value = parse_all<Value>(word);
        if (!value) return std::nullopt;
        values.push_back(*value);
    }
    if (values.size() != count) return std::nullopt;
    return values;
}

}  // namespace

void TextHeader::add(std::string_view key, std::string_view value) {
    const auto [field, is_new] = fields_.emplace(key, trimmed(value));
    if (!is_new && field->second != trimmed(value))
        refuse(ErrorKind::corrupt_file, fmt::format("its header has the field \"{}\" twice, with two values", key));
}

std::optional<std::string> TextHeader::find(const std::string& key) const {
    const auto found = fields_.find(key);
    if (found == fields_.end()) return std::nullopt;
    return found->second;
}

std::string TextHeader::text(const std::string& key) const {
    const auto value = find(key);
    if (!value) refuse(ErrorKind::corrupt_file, fmt::format("its header lacks the field \"{}\"", key));
    return *value;
}

std::vector<double> TextHeader::numbers(const std::string& key, std::size_t count) const {
    if (const auto values = parse_list<double>(text(key), count)) return *values;
    refuse_value(key, std::to_string(count) + (count == 1 ? " number is" : " numbers are"));
}

std::vector<std::int64_t> TextHeader::integers(const std::string& key, std::size_t count) const {
    if (const auto values = parse_list<std::int64_t>(text(key), count)) return *values;
    refuse_value(key, std::to_string(count) + (count == 1 ? " integer is" : " integers are"));
}

void TextHeader::refuse(ErrorKind kind, const std::string& reason) const {
    throw Error(kind, path_.string() + ": " + reason);
}

void TextHeader::refuse_value(const std::string& key, const std::string& expected) const {
    refuse(ErrorKind::corrupt_file, fmt::format("its field \"{}\" is \"{}\"; {} expected", key, text(key), expected));
}

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::vector<std::string_view> words(std::string_view text) {
    std::vector<std::string_view> found;
    for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
        const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
        found.push_back(word);
        text.remove_prefix(word.size());
    }
    return found;
}

std::optional<double> parse_number(std::string_view text) { return parse_all<double>(text); }

std::optional<std::int64_t> parse_integer(std::string_view text) { return parse_all<std::int64_t>(text); }

}  // namespace kontur
