// SPDX-License-Identifier: Apache-2.0
#include "drawn_images.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_series.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

/// Of a home folder all that the user has would be read.
bool is_too_wide(const fs::path& folder) {
    const char* home = std::getenv("HOME");
    std::error_code ignored;
    return folder == folder.root_path() || (home && fs::equivalent(folder, home, ignored));
}

std::vector<DicomSeries> series_in(const fs::path& folder, const Work& work) {
    if (is_too_wide(folder)) return {};
    try {
        return list_dicom_series(folder, work);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::cancelled) throw;
        return {};  // there is none, or too much
    }
}

/// The series that it names or, where it names none, the only one in its frame of reference.
std::optional<DicomSeries> drawn_on(const DicomDrawing& drawing, std::vector<DicomSeries> all) {
    std::erase_if(all, [&](const DicomSeries& one) {
        return drawing.series_uids.empty() ? one.frame_of_reference_uid != drawing.frame_of_reference_uid
                                           : !drawing.series_uids.contains(one.series_uid);
    });
    const bool is_one = !all.empty() && (!drawing.series_uids.empty() || all.size() == 1);
    return is_one ? std::optional(all.front()) : std::nullopt;
}

}  // namespace

std::optional<ImageInput> images_of(const DicomDrawing& drawing, const Work& work) {
    const fs::path folder = fs::absolute(drawing.file).lexically_normal().parent_path();
    for (const fs::path& place : {folder, folder.parent_path()}) {
        const std::optional<DicomSeries> found = drawn_on(drawing, series_in(place, work));
        if (!found) continue;
        ImageInput input{found->files.front().parent_path(), {}};
        input.options.dicom.series_uid = found->series_uid;
        return input;
    }
    return std::nullopt;
}

}  // namespace kontur::app
