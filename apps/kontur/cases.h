// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace kontur::app {

/// One row of a cohort's table: a call of `kontur segment`.
struct Case {
    std::size_t number = 0;  ///< of the row, from 1
    std::size_t line = 0;    ///< of the table, from 1
    std::string name;
    std::vector<std::string> options;           ///< of segment, each one word: --NAME=VALUE or --NAME
    std::vector<std::string> contours;          ///< files
    std::vector<std::filesystem::path> inputs;  ///< relative to the table's folder, as in the row
    std::vector<std::filesystem::path> outputs;
    std::filesystem::path output;  ///< the mask, which no other row writes
    std::filesystem::path report;  ///< "": not among the row's outputs
    bool has_rules = false;        ///< the row names a file of rules
    bool has_threads = false;      ///< the row says with how many
};

/// What stands behind "kontur" to make the case, with some options more.
std::vector<std::string> words_of(const Case& one, const std::vector<std::string>& more = {});

/// A table's rows, and the lines that name the files and DICOM folders in them (by their `destination`) first.
struct Cohort {
    std::vector<Case> cases;
    std::map<std::filesystem::path, std::size_t> inputs, outputs;
};

/// Reads the table: columns `contours` (several files separated by ';') and `image` or `spacing-mm`, `output`, optionally
/// `case` (a name), `roi` (several, too), and any other option of `segment` without its dashes; empty cells are options not
/// given. Cases that name no file of rules get `rules`, unless it is empty. Throws Error(invalid_input), naming the line,
/// for a column that is none of these, whatever `segment` would not accept, a name or an output of two rows, and an output
/// that would replace the table or an input of any row.
Cohort read_cases(const std::filesystem::path& table, const std::filesystem::path& rules = {});

/// Throws what writing the case's outputs would throw after the work, naming the line: for a folder that does not exist,
/// say.
void check_outputs(const Case& one, const std::filesystem::path& table);

/// Throws Error(invalid_input) when writing to `target` would replace an input or an output of the cohort.
void check_apart(const std::filesystem::path& target, const Cohort& cohort);

/// What a case was made from: its words, and names, sizes and times of the files that it reads: the slices in a DICOM
/// folder, and the data file of a detached header. A changed one has to be made again.
std::string fingerprint(const Case& one, const std::filesystem::path& folder);

/// A name for files about the case that other rows of the table do not have, wherever the row stands in it.
std::string file_stem(const Case& one);

}  // namespace kontur::app
