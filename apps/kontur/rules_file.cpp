// SPDX-License-Identifier: Apache-2.0
#include "rules_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <system_error>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"

namespace kontur::app {
namespace {

std::string without_comment(const std::string& line) {
    char quote = 0;
    for (std::size_t n = 0; n < line.size(); ++n) {
        if (quote == 0 && line[n] == '#') return line.substr(0, n);
        if (quote == 0 && (line[n] == '"' || line[n] == '\'')) quote = line[n];
        else if (line[n] == quote) quote = 0;
    }
    return line;
}

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

}  // namespace

std::vector<std::string> read_rules_file(const std::filesystem::path& path) {
    constexpr std::size_t kMostBytes = 1 << 20;
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path))
        throw Error(ErrorKind::io, fmt::format("cannot read {}", path.string()));
    std::vector<std::string> rules;
    std::size_t bytes = 0;
    for (std::string line; std::getline(file, line);) {
        if ((bytes += line.size() + 1) > kMostBytes)
            throw Error(ErrorKind::invalid_input,
                        fmt::format("{} is larger than {} bytes, and so no file of rules", path.string(), kMostBytes));
        if (rules.empty() && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
        if (std::string rule = trimmed(without_comment(line)); !rule.empty()) rules.push_back(std::move(rule));
    }
    for (const std::string& rule : rules) check_utf8(rule, "a rule of " + path.string());
    if (rules.empty())
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} holds 0 rules; at least 1 is needed, such as PTV = CTV + 5 mm", path.string()));
    return rules;
}

}  // namespace kontur::app
