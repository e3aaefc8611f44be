// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kontur::app {

/// One row of a cohort's table: a call of `kontur segment`.
struct Case {
    std::size_t number = 0;  ///< of the row, from 1
    std::string name;
    std::vector<std::string> words;             ///< behind "kontur": segment, contours, options
    std::vector<std::filesystem::path> inputs;  ///< relative to the table's folder, as in the words
    std::vector<std::filesystem::path> outputs;
    std::filesystem::path report;  ///< "": not among the row's outputs
    bool has_threads = false;      ///< the row says with how many
};

/// Reads the table: columns `contours` (several files separated by ';') and `image` or `spacing-mm`, `output`, optionally
/// `case` (a name), and any other option of `segment` without its dashes; empty cells are options not given. Throws
/// Error(invalid_input), naming the line, for whatever `segment` would not accept and for an output of two rows.
std::vector<Case> read_cases(const std::filesystem::path& table);

/// What a case was made from: its words, and size and time of its inputs. A changed one has to be made again.
std::string fingerprint(const Case& one, const std::filesystem::path& folder);

}  // namespace kontur::app
