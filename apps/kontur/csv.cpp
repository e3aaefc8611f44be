// SPDX-License-Identifier: Apache-2.0
#include "csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"

namespace kontur::app {
namespace {

Error corrupt(std::size_t line, const std::string& message) {
    return Error(ErrorKind::corrupt_file, fmt::format("line {}: {}", line, message));
}

class Scanner {
public:
    explicit Scanner(std::string text) : text_(std::move(text)) {
        if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;  // spreadsheets mark UTF-8 so
    }

    /// Where the next row starts.
    std::size_t line() const { return line_; }

    /// nullopt at the end.
    std::optional<std::vector<std::string>> row() {
        if (at_ >= text_.size()) return std::nullopt;
        std::vector<std::string> cells{cell()};
        while (at_ < text_.size() && text_[at_] == ',') {
            ++at_;
            cells.push_back(cell());
        }
        if (at_ < text_.size() && text_[at_] == '\r') ++at_;
        if (at_ < text_.size()) {
            if (text_[at_] != '\n') throw corrupt(line_, "a cell goes on behind its closing quote");
            ++at_;
        }
        ++line_;
        return cells;
    }

private:
    std::string cell() { return at_ < text_.size() && text_[at_] == '"' ? quoted() : plain(); }

    std::string plain() {
        const std::size_t end = std::min(text_.find_first_of(",\r\n", at_), text_.size());
        std::string cell = text_.substr(at_, end - at_);
        at_ = end;
        const auto first = cell.find_first_not_of(" \t");
        return first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(" \t") - first + 1);
    }

    std::string quoted() {
        const std::size_t start = line_;
        std::string cell;
        for (++at_; at_ < text_.size(); ++at_) {
            if (text_[at_] == '"' && text_.compare(at_, 2, "\"\"") != 0) {
                ++at_;
                return cell;
            }
            if (text_[at_] == '"') ++at_;
            line_ += text_[at_] == '\n';
            cell += text_[at_];
        }
        throw corrupt(start, "a quote is not closed");
    }

    std::string text_;
    std::size_t at_ = 0, line_ = 1;
};

std::string content_of(const std::filesystem::path& path) {
    constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 28;
    std::error_code failure;
    if (std::filesystem::exists(path, failure) && !std::filesystem::is_regular_file(path, failure))
        throw Error(ErrorKind::io, "cannot read: it is no regular file");
    if (const auto size = std::filesystem::file_size(path, failure); !failure && size > kMostBytes)
        throw Error(ErrorKind::too_large, fmt::format("the table has {} bytes; at most {} are read", size, kMostBytes));
    std::ifstream file(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (!file) throw Error(ErrorKind::io, fmt::format("cannot read: {}", std::strerror(errno)));
    if (!is_utf8(text)) throw Error(ErrorKind::corrupt_file, "it is not in UTF-8");
    return text;
}

void check_columns(const std::vector<std::string>& columns) {
    // What spreadsheets write where the comma is the decimal mark.
    if (columns.size() == 1)
        if (const std::size_t at = columns.front().find_first_of(";\t"); at != std::string::npos)
            throw corrupt(1, fmt::format("{} separate the columns; save the table with commas",
                                         columns.front()[at] == ';' ? "semicolons" : "tabs"));
    std::set<std::string> seen;
    for (const std::string& column : columns) {
        if (column.empty()) throw corrupt(1, "a column has no name");
        if (!seen.insert(column).second) throw corrupt(1, fmt::format("two columns are named '{}'", column));
    }
}

CsvTable parse(std::string text) {
    Scanner scanner(std::move(text));
    CsvTable table;
    table.columns = scanner.row().value_or(std::vector<std::string>{});
    check_columns(table.columns);
    for (std::size_t line = scanner.line(); auto row = scanner.row(); line = scanner.line()) {
        // Spreadsheets write rows that were once filled.
        if (std::all_of(row->begin(), row->end(), [](const std::string& cell) { return cell.empty(); })) continue;
        if (row->size() != table.columns.size())
            throw corrupt(line, fmt::format("{} cells stand below {} columns", row->size(), table.columns.size()));
        table.rows.push_back(std::move(*row));
        table.lines.push_back(line);
    }
    return table;
}

}  // namespace

CsvTable read_csv(const std::filesystem::path& path) {
    try {
        return parse(content_of(path));
    } catch (const Error& error) {
        throw error.with_context(path.string());
    }
}

}  // namespace kontur::app
