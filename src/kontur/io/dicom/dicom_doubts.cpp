// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_doubts.h"
#include "kontur/base/counted.h"
#include "kontur/base/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

namespace kontur {
namespace {

namespace fs = std::filesystem;

bool is_hexadecimal(unsigned char c) { return std::isxdigit(c) != 0 || c == '.' || c == '-'; }

/// What the names of one series' files have in common: their folder and their extension or, where they have none, the name
/// with numbers of any kind made equal.
std::string shape_of(const fs::path& file) {
    const std::string extension = file.extension().string();
    const bool has_letter = std::any_of(extension.begin(), extension.end(), [](unsigned char c) { return std::isalpha(c); });
    std::string shape = file.parent_path().string() + "/";
    // "1.2.840.12a" has no extension.
    if (has_letter && !std::all_of(extension.begin(), extension.end(), is_hexadecimal)) return shape + lower_case(extension);
    for (const unsigned char c : file.filename().string())
        if (!is_hexadecimal(c)) shape += static_cast<char>(c);
        else if (shape.back() != '#') shape += '#';
    return shape;
}

class Likeness {
public:
    explicit Likeness(const DicomStack& stack) {
        for (const DicomHeader& slice : stack.slices) shapes_.insert(shape_of(slice.path));
    }
    bool operator()(const fs::path& file) const { return shapes_.contains(shape_of(file)); }

private:
    std::set<std::string> shapes_;
};

std::string count_of_files(std::size_t count, std::string_view kind) {
    return "left out " + counted(count, std::string(kind) + "file");
}

std::string name_of(const fs::path& file) { return file.filename().string(); }

void tell_of_others(const DicomContent& content, const Likeness& is_like_slices, DicomDoubts& doubts) {
    std::map<std::string, std::vector<std::string>> by_reason;
    std::vector<fs::path> suspects;
    for (const auto& [path, why] : content.others)
        if (!why.is_dicom && is_like_slices(path)) suspects.push_back(path);
        else if (why.reason != "RTSTRUCT" && why.reason != "SEG")  // whose place is beside their images
            by_reason[why.reason].push_back(name_of(path));
    for (const auto& [reason, names] : by_reason) doubts.notes.push_back(left_out_note(reason, names));
    if (suspects.empty()) return;
    std::error_code ignored;
    doubts.warnings.push_back(fmt::format("{}, named like the slices but no DICOM: {} ({} bytes){}; the volume may lack {}",
                                          count_of_files(suspects.size(), ""), name_of(suspects.front()),
                                          fs::file_size(suspects.front(), ignored), suspects.size() == 1 ? "" : ", ...",
                                          suspects.size() == 1 ? "a slice" : "slices"));
}

void tell_of_damage(const std::vector<const DamagedImage*>& images, const std::string& which, bool is_doubt,
                    DicomDoubts& doubts) {
    if (images.empty()) return;
    const std::string all = count_of_files(images.size(), "damaged ") + which;
    const DamagedImage& first = *images.front();
    const char* more = images.size() == 1 ? "" : ", ...";
    if (is_doubt) doubts.warnings.push_back(fmt::format("{}: {}{}", all, first.error.what(), more));
    else doubts.notes.push_back(fmt::format("{}: {}{}", all, name_of(first.path), more));
}

}  // namespace

DicomDoubts dicom_doubts(const DicomContent& content, const DicomStack& chosen, bool series_is_named) {
    DicomDoubts doubts;
    const Likeness is_like_slices(chosen);
    tell_of_others(content, is_like_slices, doubts);
    std::vector<const DamagedImage*> foreign, maybe, unlikely;
    for (const DamagedImage& image : content.damaged)
        if (image.series_uid) foreign.push_back(&image);
        else (!series_is_named || is_like_slices(image.path) ? maybe : unlikely).push_back(&image);
    tell_of_damage(foreign, " of other series", !series_is_named, doubts);
    tell_of_damage(unlikely, " of unknown series", false, doubts);
    tell_of_damage(maybe, " that may belong to the volume", true, doubts);
    return doubts;
}

}  // namespace kontur
