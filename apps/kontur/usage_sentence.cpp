// SPDX-License-Identifier: Apache-2.0
#include "usage_sentence.h"

#include <fmt/format.h>

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

}  // namespace kontur::app
