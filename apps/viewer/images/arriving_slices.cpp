// SPDX-License-Identifier: Apache-2.0
#include "viewer/images/arriving_slices.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_series.h"
#include "kontur/io/dicom/slice_places.h"
#include "viewer/images/slice_picture.h"

namespace kontur::viewer {
namespace {

namespace fs = std::filesystem;

constexpr int kPixels = 384;  // with 192 lesions are hard to see, with 768 a picture has four times the bytes

}  // namespace

std::optional<fs::path> ArrivingSlices::folder() const {
    std::error_code ignored;
    const auto found = std::ranges::find_if(folders_, [&](const fs::path& one) { return fs::is_directory(one, ignored); });
    return found == folders_.end() ? std::nullopt : std::optional(*found);
}

/// Those that are not whole have hidden names.
void ArrivingSlices::look_into(const fs::path& folder) {
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    std::error_code ignored;
    for (auto at = fs::directory_iterator(folder, ignored); at != fs::directory_iterator(); at.increment(ignored)) {
        const std::string name = at->path().filename().string();
        if (name.starts_with('.') || known_.contains(name)) continue;
        files.emplace_back(at->last_write_time(ignored), at->path());
    }
    std::ranges::sort(files);
    for (const auto& [time, file] : files) add(file);
}

void ArrivingSlices::add(const fs::path& file) {
    for (const SlicePlace& one : slice_places(file))
        slices_.push_back({file.filename().string(), one.frame, one.along_normal_mm});
    known_.insert(file.filename().string());
}

std::string ArrivingSlices::picture_in(const fs::path& folder, std::optional<double> at_mm) {
    Slice shown;
    nlohmann::json header;
    {
        const std::scoped_lock lock(mutex_);
        look_into(folder);
        if (slices_.empty()) return "";
        const auto distance = [&](const Slice& one) { return std::abs(one.at_mm - *at_mm); };
        shown = at_mm ? *std::ranges::min_element(slices_, {}, distance) : slices_.back();
        const auto [first, last] = std::ranges::minmax(slices_, {}, &Slice::at_mm);
        header = {{"slices", slices_.size()}, {"at_mm", shown.at_mm}, {"first_mm", first.at_mm}, {"last_mm", last.at_mm}};
    }
    return slice_picture(read_dicom_slice(folder / shown.file, shown.frame), kPixels, std::move(header));
}

std::string ArrivingSlices::picture(std::optional<double> at_mm) {
    const std::optional<fs::path> place = folder();
    if (!place) return "";
    try {
        return picture_in(*place, at_mm);
    } catch (const Error&) {
        const std::optional<fs::path> now = folder();
        if (now == place) throw;
        return now ? picture_in(*now, at_mm) : "";  // the series is whole, and its folder has another name
    }
}

}  // namespace kontur::viewer
