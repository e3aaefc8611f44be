// SPDX-License-Identifier: Apache-2.0
#include "viewer/images/arriving_slices.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

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
        if (name.starts_with('.') || !known_.insert(name).second) continue;
        files.emplace_back(at->last_write_time(ignored), at->path());
    }
    std::ranges::sort(files);
    for (const auto& [time, file] : files) add(file);
}

void ArrivingSlices::add(const fs::path& file) {
    for (const SlicePlace& one : slice_places(file))
        slices_.push_back({file.filename().string(), one.frame, one.along_normal_mm});
}

std::string ArrivingSlices::picture(std::optional<double> at_mm) {
    Slice shown;
    nlohmann::json header;
    fs::path place;
    {
        const std::scoped_lock lock(mutex_);
        const auto found = folder();
        if (!found) return "";
        place = *found;
        look_into(place);
        if (slices_.empty()) return "";
        const auto distance = [&](const Slice& one) { return std::abs(one.at_mm - *at_mm); };
        shown = at_mm ? *std::ranges::min_element(slices_, {}, distance) : slices_.back();
        const auto [first, last] = std::ranges::minmax(slices_, {}, &Slice::at_mm);
        header = {{"slices", slices_.size()}, {"at_mm", shown.at_mm}, {"first_mm", first.at_mm}, {"last_mm", last.at_mm}};
    }
    return slice_picture(read_dicom_slice(place / shown.file, shown.frame), kPixels, std::move(header));
}

}  // namespace kontur::viewer
