// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/base/error.h"

namespace kontur {

/// What separates words in text.
inline constexpr std::string_view kBlanks = " \t\r\n\f\v";

/// The fields of a header made of text lines, as NRRD and MetaImage have. Internal to io.
class TextHeader {
public:
    explicit TextHeader(std::filesystem::path path) : path_(std::move(path)) {}

    const std::filesystem::path& path() const { return path_; }

    /// Refuses another value for a field that is there already.
    void add(std::string_view key, std::string_view value);

    bool has(const std::string& key) const { return fields_.contains(key); }
    std::optional<std::string> find(const std::string& key) const;
    /// These throw Error(corrupt_file), naming the field, when it is missing or not of this form.
    std::string text(const std::string& key) const;
    std::vector<double> numbers(const std::string& key, std::size_t count) const;
    std::vector<std::int64_t> integers(const std::string& key, std::size_t count) const;

    [[noreturn]] void refuse(ErrorKind kind, const std::string& reason) const;

private:
    [[noreturn]] void refuse_value(const std::string& key, const std::string& expected) const;

    std::filesystem::path path_;
    std::map<std::string, std::string> fields_;
};

std::string_view trimmed(std::string_view text);
/// Split at blanks.
std::vector<std::string_view> words(std::string_view text);
/// The whole text as a number, whatever the locale. nan and inf are numbers here: who needs a finite one must check.
std::optional<double> parse_number(std::string_view text);
std::optional<std::int64_t> parse_integer(std::string_view text);

}  // namespace kontur
