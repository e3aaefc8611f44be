// SPDX-License-Identifier: Apache-2.0
#include "cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <optional>
#include <span>

#include "command_line.h"
#include "csv.h"
#include "files.h"
#include "kontur/base/error.h"
#include "kontur/base/sha256.h"
#include "outputs.h"

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
    if (is_one_of(option, {"allow-missing-geometry", "date", "quiet"})) {
        if (is_one_of(value, {"1", "true", "yes"})) one.options.push_back("--" + option);
        else if (!is_one_of(value, {"0", "false", "no"}))
            throw Error(ErrorKind::invalid_input, fmt::format("{} is yes or no, not {}", option, value));
        return;
    }
    one.options.push_back(fmt::format("--{}={}", option, value));
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
    for (std::size_t n = 0; n < columns.size(); ++n) {
        const std::string option = option_of(columns[n]);
        if (cells[n].empty()) continue;
        if (option == "case") one.name = cells[n];
        else if (option == "contours")
            for (const std::string& file : split(cells[n], ';')) {
                one.contours.push_back(file);
                one.inputs.emplace_back(file);
            }
        else add_option(one, option, cells[n]);
    }
    return one;
}

void check(const Case& one) {
    const std::vector<std::string> words = words_of(one);
    std::vector<const char*> argv{"kontur"};
    for (const std::string& word : words) argv.push_back(word.c_str());
    const Invocation invocation = parse_command_line(static_cast<int>(argv.size()), argv.data());
    if (!invocation.command)
        throw Error(ErrorKind::invalid_input, invocation.exit_code != 0 ? invocation.text : "is no call of segment");
}

using Lines = std::map<fs::path, std::size_t>;

void note_inputs(const Case& one, const fs::path& folder, std::size_t line, Lines& inputs) {
    std::error_code failure;  // an input that cannot be found is the case's own failure
    for (const fs::path& input : one.inputs)
        for (const fs::path& read : {folder / input, series_folder(folder / input)})
            if (!read.empty()) inputs.emplace(fs::weakly_canonical(fs::absolute(read), failure), line);
}

/// The line that names what writing to `place` would replace.
std::optional<std::size_t> line_that_reads(const fs::path& place, const Lines& inputs) {
    const auto file = inputs.find(place), series = inputs.find(place.parent_path());
    if (file != inputs.end()) return file->second;
    if (series != inputs.end() && is_dicom_slice(place)) return series->second;
    return std::nullopt;
}

void note_outputs(const Case& one, const fs::path& folder, std::size_t line, Lines& outputs) {
    for (const fs::path& output : one.outputs)
        if (const auto [known, is_new] = outputs.emplace(destination(folder / output), line); !is_new)
            throw Error(ErrorKind::invalid_input,
                        fmt::format("{} is already an output of line {}", output.string(), known->second));
}

/// Calls `action` for each case and its line; errors name both.
void for_each_row(const fs::path& table, const CsvTable& csv, const std::function<void(std::size_t, std::size_t)>& action) {
    for (std::size_t n = 0; n < csv.rows.size(); ++n) try {
            action(n, csv.lines[n]);
        } catch (const Error& error) {
            throw error.with_context(fmt::format("{}: line {}", table.string(), csv.lines[n]));
        }
}

std::string size_and_time(const fs::path& file) {
    std::error_code failure;
    const auto bytes = fs::is_regular_file(file, failure) ? fs::file_size(file, failure) : 0;
    const auto time = fs::last_write_time(file, failure).time_since_epoch().count();
    return fmt::format("{} {}", bytes, time);
}

/// A .mhd or .nhdr: text that names the file with the voxels, which lies beside it.
std::string text_of_detached_header(const fs::path& input) {
    constexpr std::size_t kMostBytes = 1 << 16;
    if (!has_extension(input, ".mhd") && !has_extension(input, ".nhdr")) return "";
    std::string text(kMostBytes, '\0');
    std::ifstream file(input, std::ios::binary);
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(file.gcount()));
    return text;
}

/// Names, sizes and times of the files of a folder for which `counts` holds, as a digest: a series may have thousands.
std::string folder_state(const fs::path& folder, const std::function<bool(const fs::path&)>& counts) {
    std::vector<std::string> lines;
    std::error_code failure;
    for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure))
        if (counts(entry->path()))
            lines.push_back(fmt::format("{} {}\n", entry->path().filename().string(), size_and_time(entry->path())));
    std::sort(lines.begin(), lines.end());
    Sha256 hash;
    for (const std::string& line : lines) hash.update(std::as_bytes(std::span(line)));
    return hash.hex();
}

}  // namespace

std::vector<std::string> words_of(const Case& one, const std::vector<std::string>& more) {
    std::vector<std::string> words{"segment"};
    words.insert(words.end(), one.options.begin(), one.options.end());
    words.insert(words.end(), more.begin(), more.end());
    for (const std::string& file : one.contours) words.push_back(file.starts_with('-') ? "./" + file : file);
    return words;
}

Cohort read_cases(const fs::path& table) {
    const CsvTable csv = read_csv(table);
    const fs::path folder = table.parent_path();
    Cohort cohort;
    for_each_row(table, csv, [&](std::size_t n, std::size_t line) {
        const Case& one = cohort.cases.emplace_back(read_row(csv.columns, csv.rows[n], n + 1));
        check(one);
        note_inputs(one, folder, line, cohort.inputs);
        note_outputs(one, folder, line, cohort.outputs);
    });
    for_each_row(table, csv, [&](std::size_t n, std::size_t) {
        for (const fs::path& output : cohort.cases[n].outputs)
            if (const auto line = line_that_reads(destination(folder / output), cohort.inputs))
                throw Error(ErrorKind::invalid_input,
                            fmt::format("{} would replace an input of line {}", output.string(), *line));
    });
    if (cohort.cases.empty()) throw Error(ErrorKind::invalid_input, table.string() + " has no rows");
    return cohort;
}

void check_apart(const fs::path& target, const Cohort& cohort) {
    const auto refuse = [&](const char* what, std::size_t line) {
        throw Error(ErrorKind::invalid_input, fmt::format("{} would replace an {} of line {}", target.string(), what, line));
    };
    const fs::path place = destination(target);
    if (const auto line = line_that_reads(place, cohort.inputs)) refuse("input", *line);
    if (const auto found = cohort.outputs.find(place); found != cohort.outputs.end()) refuse("output", found->second);
}

std::string fingerprint(const Case& one, const Cohort& cohort, const fs::path& folder) {
    std::string text = fmt::format("{}", KONTUR_VERSION);
    for (const std::string& word : words_of(one)) text.append(1, '\n').append(word);
    for (const fs::path& input : one.inputs) {
        const fs::path path = folder / input;
        if (const fs::path series = series_folder(path); !series.empty()) {
            const fs::path place = destination(series);
            const auto is_read = [&](const fs::path& file) { return !cohort.outputs.contains(place / file.filename()); };
            text.append(1, '\n').append(folder_state(place, is_read));
            continue;
        }
        text.append(1, '\n').append(size_and_time(path));
        const std::string header = text_of_detached_header(path);
        const auto is_named = [&](const fs::path& file) {
            return header.find(file.filename().string()) != std::string::npos;
        };
        if (!header.empty()) text.append(1, ' ').append(folder_state(path.parent_path(), is_named));
    }
    return text;
}

}  // namespace kontur::app
