// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kontur::app {

/// A table with a line of column names. Every row has a cell for each of them.
struct CsvTable {
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
    std::vector<std::size_t> lines;  ///< where each row starts in the file, from 1
};

/// Reads comma-separated UTF-8 (RFC 4180): cells in double quotes may hold commas, line ends and doubled quotes. Rows whose
/// cells are all empty are left out. Throws Error(io), and Error(corrupt_file), naming the line, for a row with another
/// number of cells than there are columns, an unclosed quote, columns without a name or of one name, and column names that
/// semicolons or tabs separate.
CsvTable read_csv(const std::filesystem::path& path);

}  // namespace kontur::app
