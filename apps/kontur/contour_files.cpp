// SPDX-License-Identifier: Apache-2.0
#include "contour_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string>

#include "kontur/base/error.h"
#include "kontur/io/dicom/rtstruct.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

std::string list(const std::vector<fs::path>& paths) {
    std::string text;
    for (const fs::path& path : paths) text += (text.empty() ? "" : ", ") + path.string();
    return text;
}

[[noreturn]] void refuse(const std::string& files, const std::string& problem) {
    throw Error(ErrorKind::invalid_input, fmt::format("{}: {}", files, problem));
}

/// The first that a contour by itself is to blame for.
std::optional<std::string> problem_of_a_contour(ContourSet set) {
    drop_duplicate_points(set);
    const std::vector<std::string> all = contour_problems(set);
    return all.size() > set_problems(set).size() ? std::optional(all.front()) : std::nullopt;
}

/// Why there is nothing to fit; "" when the files say nothing. Of a single file, which is named anyway, without its name.
std::string reasons(const std::vector<fs::path>& paths, std::vector<std::string> notes) {
    const std::string start = paths.front().string() + ": ";
    for (std::string& note : notes)
        if (paths.size() == 1 && note.starts_with(start)) note.erase(0, start.size());
    return notes.empty() ? "" : fmt::format(" to fit ({})", fmt::join(notes, "; "));
}

}  // namespace

ReadContours read_contours_to_fit(const std::vector<fs::path>& paths, const ReadContoursOptions& options) {
    ReadContours all = read_contours(paths, options);
    if (all.contours.contours.empty())
        refuse(list(paths), fmt::format("{} no contour{}; at least 1 is needed",
                                        options.roi ? fmt::format("the structure '{}' has", *options.roi) : "there is",
                                        reasons(paths, all.notes)));
    ContourSet set = all.contours;
    drop_duplicate_points(set);
    const std::vector<std::string> problems = contour_problems(set);
    if (problems.empty()) return all;
    for (const fs::path& path : paths) {
        ReadContoursOptions of_this = options;
        if (!is_rtstruct(path)) of_this.roi.reset();
        check_each_contour(path, read_contours(path, of_this).contours);
    }
    refuse(list(paths), problems.front());
}

void check_each_contour(const fs::path& file, const ContourSet& contours) {
    if (const auto problem = problem_of_a_contour(contours)) refuse(file.string(), *problem);
}

void set_frame(ContourSet& contours, double frame) {
    for (Contour& contour : contours.contours) {
        contour.frame = frame;
        contour.time_s.reset();
    }
}

void put_notes_first(const std::vector<std::string>& notes, std::vector<std::string>& warnings) {
    // A note may begin with its file's name.
    std::erase_if(warnings, [&](const std::string& warning) {
        return std::ranges::any_of(notes, [&](const std::string& note) { return note.ends_with(warning); });
    });
    warnings.insert(warnings.begin(), notes.begin(), notes.end());
}

}  // namespace kontur::app
