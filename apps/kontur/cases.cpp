// SPDX-License-Identifier: Apache-2.0
#include "cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <iterator>
#include <optional>
#include <span>

#include "command_line.h"
#include "csv.h"
#include "files.h"
#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/dicom/dicom_folder.h"
#include "kontur/io/images/image_files.h"
#include "kontur/shape/sha256.h"
#include "outputs.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& sentence) { throw Error(ErrorKind::invalid_input, sentence); }

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// The parts without the blanks around them; empty ones are left out.
std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find(separator, start), text.size());
        if (std::string part = trimmed(text.substr(start, end - start)); !part.empty()) parts.push_back(std::move(part));
        start = end + 1;
    }
    return parts;
}

/// Of UTF-8: no character begins here.
bool is_inside_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

bool is_one_of(const std::string& word, std::initializer_list<const char*> words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

/// What each column means; its name may have capitals and underscores.
std::vector<OptionName> meaning_of(const std::vector<std::string>& columns) {
    std::vector<OptionName> known{{"case"}, {"contours"}}, found;
    std::ranges::move(options_of_segment(), std::back_inserter(known));
    const auto find = [](const std::vector<OptionName>& options, const std::string& name) {
        return std::ranges::find(options, name, &OptionName::name);
    };
    for (const std::string& column : columns) {
        std::string name = lower_case(column);
        std::ranges::replace(name, '_', '-');
        const auto option = find(known, name);
        if (option == known.end())
            refuse(fmt::format("the column '{}' is neither case nor contours nor an option of kontur segment", column));
        if (find(found, name) != found.end()) refuse(fmt::format("the column '{}' is a second one for {}", column, name));
        found.push_back(*option);
    }
    for (const char* needed : {"contours", "output"})
        if (find(found, needed) == found.end()) refuse(fmt::format("there is no column '{}'", needed));
    return found;
}

void add_option(Case& one, const OptionName& option, const std::string& value) {
    if (option.is_flag) {
        const std::string answer = lower_case(value);
        if (is_one_of(answer, {"1", "true", "yes"})) one.options.push_back("--" + option.name);
        else if (!is_one_of(answer, {"0", "false", "no"}))
            refuse(fmt::format("{} is yes or no, not {}", option.name, value));
        return;
    }
    // As `segment` takes several ROIs: each named by an option of its own.
    const std::vector<std::string> values = option.name == "roi" ? split(value, ';') : std::vector{value};
    if (values.empty()) refuse(fmt::format("the cell below '{}' names none", option.name));
    for (const std::string& word : values) one.options.push_back(fmt::format("--{}={}", option.name, word));
    if (is_one_of(option.name, {"image", "rules"})) one.inputs.emplace_back(value);
    one.has_rules |= option.name == "rules";
    if (is_one_of(option.name, {"output", "rtstruct", "mesh", "picture", "uncertainty", "volumes", "report"}))
        one.outputs.emplace_back(value);
    if (option.name == "output") one.output = value;
    if (option.name == "report") one.report = value;
    one.has_threads |= option.name == "threads";
}

/// The row as words; `segment` itself judges them.
Case read_row(const std::vector<OptionName>& columns, const std::vector<std::string>& cells) {
    Case one;
    for (std::size_t n = 0; n < columns.size(); ++n) {
        if (cells[n].empty()) continue;
        if (columns[n].name == "case") one.name = cells[n];
        else if (columns[n].name == "contours") one.contours = split(cells[n], ';');
        else add_option(one, columns[n], cells[n]);
    }
    if (one.contours.empty()) refuse("the cell below 'contours' is empty");
    if (one.output.empty()) refuse("the cell below 'output' is empty");
    one.inputs.insert(one.inputs.end(), one.contours.begin(), one.contours.end());
    return one;
}

void check(const Case& one) {
    const std::vector<std::string> words = words_of(one);
    std::vector<const char*> argv{"kontur"};
    for (const std::string& word : words) argv.push_back(word.c_str());
    const Invocation invocation = parse_command_line(static_cast<int>(argv.size()), argv.data());
    if (!invocation.command) refuse(invocation.exit_code != 0 ? invocation.text : "is no call of segment");
    invocation.check();
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
    if (const auto file = inputs.find(place); file != inputs.end()) return file->second;
    for (fs::path above = place.parent_path(); above.has_relative_path(); above = above.parent_path())
        if (const auto series = inputs.find(above); series != inputs.end() && is_dicom_slice(place)) return series->second;
    return std::nullopt;
}

void note_outputs(const Case& one, const fs::path& table, std::size_t line, Lines& outputs) {
    for (const fs::path& output : one.outputs) {
        const fs::path place = destination(table.parent_path() / output);
        if (place == destination(table)) refuse(fmt::format("{} would replace the table", output.string()));
        if (const auto [known, is_new] = outputs.emplace(place, line); !is_new)
            refuse(fmt::format("{} is already an output of line {}", output.string(), known->second));
    }
}

/// Errors of `action` name the line.
void at_line(const fs::path& table, std::size_t line, const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        throw error.with_context(fmt::format("{}: line {}", table.string(), line));
    }
}

std::string size_and_time(const fs::path& file) {
    std::error_code failure;
    const auto bytes = fs::is_regular_file(file, failure) ? fs::file_size(file, failure) : 0;
    const auto time = fs::last_write_time(file, failure).time_since_epoch().count();
    return fmt::format("{} {}", bytes, time);
}

/// Of an image, all its files: voxels may stand beside their header. What cannot be read has nothing but its name.
std::string files_state(const fs::path& input) {
    std::vector<fs::path> files{input};
    try {
        files = image_files(input);
    } catch (const Error&) {
        // segment will say why
    }
    std::string state;
    for (const fs::path& file : files) state.append(state.empty() ? "" : " ").append(size_and_time(file));
    return state;
}

/// Names, sizes and times of files below a folder, as a digest: a series may have thousands.
std::string state_of(const std::vector<fs::path>& files, const fs::path& folder) {
    Sha256 hash;
    for (const fs::path& file : files) {
        const std::string line = fmt::format("{} {}\n", file.lexically_relative(folder).string(), size_and_time(file));
        hash.update(std::as_bytes(std::span(line)));
    }
    return hash.hex();
}

/// Of the slices of a DICOM series, in its folder or in those below it.
std::string series_state(const fs::path& folder) {
    try {
        std::vector<fs::path> files = dicom_folder(folder).files;
        std::erase_if(files, [](const fs::path& file) { return !is_dicom_slice(file); });
        return state_of(files, folder);
    } catch (const Error& error) {  // the case's own failure, which it tells itself
        return error.what();
    }
}

}  // namespace

std::vector<std::string> words_of(const Case& one, const std::vector<std::string>& more) {
    std::vector<std::string> words{"segment"};
    words.insert(words.end(), one.options.begin(), one.options.end());
    words.insert(words.end(), more.begin(), more.end());
    for (const std::string& file : one.contours) words.push_back(file.starts_with('-') ? "./" + file : file);
    return words;
}

Cohort read_cases(const fs::path& table, const fs::path& rules) {
    const CsvTable csv = read_csv(table);
    const fs::path folder = table.parent_path();
    std::vector<OptionName> columns;
    at_line(table, 1, [&] { columns = meaning_of(csv.columns); });
    Cohort cohort;
    std::map<std::string, std::size_t> names;
    for (std::size_t n = 0; n < csv.rows.size(); ++n)
        at_line(table, csv.lines[n], [&, line = csv.lines[n]] {
            Case& one = cohort.cases.emplace_back(read_row(columns, csv.rows[n]));
            if (!rules.empty() && !one.has_rules) {
                one.inputs.push_back(fs::absolute(rules));  // the case runs in the table's folder
                one.options.push_back("--rules=" + one.inputs.back().string());
            }
            one.number = n + 1;
            one.line = line;
            if (one.name.empty()) one.name = std::to_string(one.number);
            if (const auto [known, is_new] = names.emplace(one.name, line); !is_new)
                refuse(fmt::format("the case '{}' is already that of line {}", one.name, known->second));
            check(one);
            note_inputs(one, folder, line, cohort.inputs);
            note_outputs(one, table, line, cohort.outputs);
        });
    for (const Case& one : cohort.cases)
        at_line(table, one.line, [&] {
            for (const fs::path& output : one.outputs)
                if (const auto line = line_that_reads(destination(folder / output), cohort.inputs))
                    refuse(fmt::format("{} would replace an input of line {}", output.string(), *line));
        });
    if (cohort.cases.empty()) refuse(table.string() + " has no rows");
    return cohort;
}

void check_outputs(const Case& one, const fs::path& table) {
    at_line(table, one.line, [&] {
        for (const fs::path& output : one.outputs) check_output(table.parent_path() / output, {});
    });
}

void check_apart(const fs::path& target, const Cohort& cohort) {
    const auto replaces = [&](const char* what, std::size_t line) {
        refuse(fmt::format("{} would replace an {} of line {}", target.string(), what, line));
    };
    const fs::path place = destination(target);
    if (const auto line = line_that_reads(place, cohort.inputs)) replaces("input", *line);
    if (const auto found = cohort.outputs.find(place); found != cohort.outputs.end()) replaces("output", found->second);
}

std::string fingerprint(const Case& one, const fs::path& folder) {
    std::string text = fmt::format("{}", KONTUR_VERSION);
    for (const std::string& word : words_of(one)) text.append(1, '\n').append(word);
    for (const fs::path& input : one.inputs) {
        const fs::path path = folder / input;
        if (const fs::path series = series_folder(path); !series.empty()) {
            // Whatever else is put there, a mask in DICOM or a folder with results, changes no case.
            text.append(1, '\n').append(series_state(series));
            continue;
        }
        text.append(1, '\n').append(files_state(path));
    }
    return text;
}

std::string file_stem(const Case& one) {
    constexpr std::size_t kMostBytes = 40, kDigits = 12;
    std::string stem = one.output.filename().string();
    std::size_t length = std::min({stem.find('.', 1), kMostBytes, stem.size()});
    while (length > 0 && length < stem.size() && is_inside_character(stem[length])) --length;
    stem.resize(length);
    // Outputs of other folders may have the same name.
    Sha256 hash;
    hash.update(std::as_bytes(std::span(one.output.native())));
    return stem + "-" + hash.hex().substr(0, kDigits);
}

}  // namespace kontur::app
