// SPDX-License-Identifier: Apache-2.0
#include "usage_sentence.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <regex>

namespace kontur::app {
namespace {

bool is_number(const std::string& word) {
    double value = 0;
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    return failure == std::errc() && end == word.data() + word.size();
}

}  // namespace

std::string usage_sentence(const std::string& of_parser) {
    static const std::regex kNoNumber("Could not convert: (\\S+) = ([^]*)"),
        kMissing("(\\S+): (\\d+) required (\\S+) missing"), kRepeated("(\\S+): At Most (\\d+) required but received (\\d+)"),
        kOutOfRange("(--\\S+): (is [^]*)");
    std::smatch part;
    if (std::regex_match(of_parser, part, kNoNumber))
        return fmt::format("{} is {}, but must be a {}number", part.str(1), part.str(2),
                           is_number(part.str(2)) ? "whole " : "");
    if (std::regex_match(of_parser, part, kMissing))
        return fmt::format("{} needs {} {}", part.str(1), part.str(2), part.str(3));
    if (std::regex_match(of_parser, part, kRepeated))
        return fmt::format("{} is given {} times; {} is possible", part.str(1), part.str(3), part.str(2));
    if (std::regex_match(of_parser, part, kOutOfRange)) return part.str(1) + " " + part.str(2);
    return of_parser;
}

std::string with_typed_options(const std::string& of_library, std::span<const std::string> available) {
    static const std::regex kOption(
        "the option (label|roi|frame|prefer|allow_missing_geometry|series_uid|volume|resample_slices)\\b");
    std::string sentence;
    auto rest = of_library.cbegin();
    for (std::smatch part; std::regex_search(rest, of_library.cend(), part, kOption); rest = part.suffix().first) {
        std::string name = part.str(1) == "series_uid" ? "series" : part.str(1);
        std::replace(name.begin(), name.end(), '_', '-');
        name.insert(0, "--");
        const bool is_available = std::ranges::find(available, name) != available.end();
        sentence += part.prefix().str() + (is_available ? "" : "kontur convert ") + name;
    }
    return sentence + std::string(rest, of_library.cend());
}

}  // namespace kontur::app
