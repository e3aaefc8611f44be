// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_content.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "kontur/base/error.h"
#include "kontur/io/bytes/input_file.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

bool same_bytes(const fs::path& a, const fs::path& b) {
    InputFile first(a), second(b);
    if (first.stored_bytes_left() != second.stored_bytes_left()) return false;
    std::array<unsigned char, 1 << 16> one, other;
    for (;;) {
        const std::size_t got = first.read_some(one.data(), one.size());
        if (got != second.read_some(other.data(), other.size())) return false;
        if (!std::equal(one.begin(), one.begin() + static_cast<std::ptrdiff_t>(got), other.begin())) return false;
        if (got == 0) return true;
    }
}

/// One image file's slices; all of them have its SOP Instance UID.
using Slices = std::vector<DicomHeader>;

class Collector {
public:
    Collector(fs::path root, std::optional<fs::path> preferred) : root_(std::move(root)), preferred_(std::move(preferred)) {}

    void add(const fs::path& file) {
        auto content = read_dicom_headers(file);
        if (auto* slices = std::get_if<Slices>(&content)) add_image(std::move(*slices));
        else if (auto* damaged = std::get_if<DamagedImage>(&content)) content_.damaged.push_back(std::move(*damaged));
        else content_.others.push_back({file, std::get<NotAnImage>(std::move(content))});
    }

    DicomContent result() && {
        Slices all;
        for (Slices& slices : images_) std::move(slices.begin(), slices.end(), std::back_inserter(all));
        content_.stacks = group_into_stacks(std::move(all));
        if (!copies_.empty()) content_.notes.push_back(left_out_note("identical copy of another", copies_));
        return std::move(content_);
    }

private:
    void add_image(Slices slices) {
        const DicomHeader& added = slices.front();
        const auto [known, is_new] = index_of_.emplace(added.sop_instance_uid, images_.size());
        if (is_new || added.sop_instance_uid.empty()) {
            images_.push_back(std::move(slices));
            return;
        }
        Slices& first = images_[known->second];
        if (!same_bytes(first.front().path, added.path)) {
            content_.damaged.push_back({added.path, added.series_uid, difference(first.front(), added)});
            return;
        }
        const bool is_preferred = preferred_ && added.path.filename() == preferred_->filename();
        copies_.push_back(name_of(is_preferred ? first.front().path : added.path));
        if (is_preferred) first = std::move(slices);
    }

    static Error difference(const DicomHeader& first, const DicomHeader& second) {
        return Error(ErrorKind::invalid_input,
                     fmt::format("{} and {} have the same SOP Instance UID {} and different content; take one of them away",
                                 first.path.string(), second.path.string(), first.sop_instance_uid));
    }

    std::string name_of(const fs::path& path) const { return path.lexically_relative(root_).string(); }

    fs::path root_;
    std::optional<fs::path> preferred_;
    std::vector<Slices> images_;
    std::map<std::string, std::size_t> index_of_;  ///< of an image by its SOP Instance UID
    std::vector<std::string> copies_;
    DicomContent content_;
};

/// Where every slice has one.
std::optional<double> mean_of(const DicomStack& stack, std::optional<double> DicomHeader::*value) {
    double sum = 0;
    for (const DicomHeader& slice : stack.slices) {
        if (!(slice.*value) || !std::isfinite(*(slice.*value))) return std::nullopt;
        sum += *(slice.*value);
    }
    return sum / static_cast<double>(stack.slices.size());
}

}  // namespace

DicomSeries described(const DicomStack& stack) {
    const DicomHeader& first = stack.slices.front();
    DicomSeries series;
    series.series_uid = first.series_uid;
    series.modality = first.modality;
    series.description = first.description;
    series.distinction = stack.distinction;
    const bool agree = std::all_of(stack.slices.begin(), stack.slices.end(), [&](const DicomHeader& slice) {
        return slice.frame_of_reference_uid == first.frame_of_reference_uid;
    });
    if (agree) series.frame_of_reference_uid = first.frame_of_reference_uid;
    series.columns = first.columns;
    series.rows = first.rows;
    series.trigger_time_ms = mean_of(stack, &DicomHeader::trigger_time_ms);
    series.beat_ms = mean_of(stack, &DicomHeader::beat_ms);
    for (const DicomHeader& slice : stack.slices) {
        series.files.push_back(slice.path);
        series.frames.push_back(slice.frame.value_or(1));
    }
    return series;
}

std::string left_out_note(const std::string& reason, const std::vector<std::string>& names) {
    const bool one = names.size() == 1;
    return fmt::format("left out {} file{} ({}): {}{}", names.size(), one ? "" : "s", reason, names.front(),
                       one ? "" : ", ...");
}

DicomContent read_dicom_content(const fs::path& root, const DicomFolder& folder, const std::optional<fs::path>& preferred,
                                const Work& work) {
    Collector collector(root, preferred);
    for (std::size_t n = 0; n < folder.files.size(); ++n) {
        work.report("read headers", static_cast<double>(n) / static_cast<double>(folder.files.size()));
        collector.add(folder.files[n]);
    }
    DicomContent content = std::move(collector).result();
    for (const auto& [reason, names] : folder.left_out) content.notes.push_back(left_out_note(reason, names));
    if (!folder.unsearched.empty())
        content.notes.push_back(fmt::format("images are not looked for in {}, because the folder itself holds some",
                                            fmt::join(folder.unsearched, ", ")));
    return content;
}

}  // namespace kontur
