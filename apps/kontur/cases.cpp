// SPDX-License-Identifier: Apache-2.0
#include "cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "command_line.h"
#include "csv.h"
#include "kontur/base/error.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find(separator, start), text.size());
        if (end > start) parts.push_back(text.substr(start, end - start));
        start = end + 1;
    }
    return parts;
}

bool is_one_of(const std::string& word, std::initializer_list<const char*> words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

/// Columns may be written with underscores.
std::string option_of(std::string column) {
    std::replace(column.begin(), column.end(), '_', '-');
    return column;
}

void add_option(Case& one, const std::string& option, const std::string& value) {
    if (option == "allow-missing-geometry") {
        if (is_one_of(value, {"1", "true", "yes"})) one.words.push_back("--" + option);
        else if (!is_one_of(value, {"0", "false", "no"}))
            throw Error(ErrorKind::invalid_input, fmt::format("{} is yes or no, not {}", option, value));
        return;
    }
    one.words.insert(one.words.end(), {"--" + option, value});
    if (option == "image") one.inputs.emplace_back(value);
    if (is_one_of(option, {"output", "rtstruct", "mesh", "picture", "report"})) one.outputs.emplace_back(value);
    if (option == "report") one.report = value;
    one.has_threads |= option == "threads";
}

/// The row as words; `segment` itself judges them.
Case read_row(const std::vector<std::string>& columns, const std::vector<std::string>& cells, std::size_t number) {
    Case one;
    one.number = number;
    one.name = std::to_string(number);
    one.words = {"segment"};
    for (std::size_t n = 0; n < columns.size(); ++n) {
        const std::string option = option_of(columns[n]);
        if (cells[n].empty()) continue;
        if (option == "case") one.name = cells[n];
        else if (option == "contours")
            for (const std::string& file : split(cells[n], ';')) {
                one.words.push_back(file);
                one.inputs.emplace_back(file);
            }
        else add_option(one, option, cells[n]);
    }
    return one;
}

void check(const Case& one) {
    std::vector<const char*> argv{"kontur"};
    for (const std::string& word : one.words) argv.push_back(word.c_str());
    const Invocation invocation = parse_command_line(static_cast<int>(argv.size()), argv.data());
    if (!invocation.command)
        throw Error(ErrorKind::invalid_input, invocation.exit_code != 0 ? invocation.text : "is no call of segment");
}

}  // namespace

std::vector<Case> read_cases(const fs::path& table) {
    const CsvTable csv = read_csv(table);
    std::vector<Case> cases;
    std::map<fs::path, std::size_t> line_of;  // by output
    for (std::size_t n = 0; n < csv.rows.size(); ++n) try {
            cases.push_back(read_row(csv.columns, csv.rows[n], n + 1));
            check(cases.back());
            for (const fs::path& output : cases.back().outputs)
                if (const auto [known, is_new] = line_of.emplace(output.lexically_normal(), csv.lines[n]); !is_new)
                    throw Error(ErrorKind::invalid_input,
                                fmt::format("{} is already an output of line {}", output.string(), known->second));
        } catch (const Error& error) {
            throw error.with_context(fmt::format("{}: line {}", table.string(), csv.lines[n]));
        }
    if (cases.empty()) throw Error(ErrorKind::invalid_input, table.string() + " has no rows");
    return cases;
}

std::string fingerprint(const Case& one, const fs::path& folder) {
    std::string text = fmt::format("{}", KONTUR_VERSION);
    for (const std::string& word : one.words) text.append(1, '\n').append(word);
    for (const fs::path& input : one.inputs) {
        std::error_code failure;
        const fs::path path = folder / input;
        const auto bytes = fs::is_regular_file(path, failure) ? fs::file_size(path, failure) : 0;
        const auto time = fs::last_write_time(path, failure).time_since_epoch().count();
        text += fmt::format("\n{} {}", bytes, time);
    }
    return text;
}

}  // namespace kontur::app
