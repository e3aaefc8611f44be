// SPDX-License-Identifier: Apache-2.0
#include "input_digests.h"

#include <fmt/chrono.h>

#include <cstdlib>
#include <ctime>

#include "kontur/io/dicom_series.h"
#include "kontur/io/file_digest.h"

namespace kontur::app {

Provenance input_digests(const SegmentCommand& command, const Progress& progress) {
    namespace fs = std::filesystem;
    Provenance digests{{"contour_files_sha256", files_sha256(command.contours, progress)}};
    const fs::path& image = command.image.path;
    if (image.empty()) return digests;
    const bool is_slice = !fs::is_directory(image) && looks_like_dicom(image);
    digests.emplace_back("image_sha256", file_sha256(is_slice ? fs::absolute(image).parent_path() : image, progress));
    return digests;
}

std::string utc_date() {
    const char* const epoch = std::getenv("SOURCE_DATE_EPOCH");
    const std::time_t seconds = epoch ? static_cast<std::time_t>(std::strtoll(epoch, nullptr, 10)) : std::time(nullptr);
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(seconds));
}

}  // namespace kontur::app
