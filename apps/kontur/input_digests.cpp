// SPDX-License-Identifier: Apache-2.0
#include "input_digests.h"

#include <fmt/chrono.h>

#include <cstdlib>
#include <ctime>

#include "kontur/io/dicom_seg.h"
#include "kontur/io/dicom_series.h"
#include "kontur/io/file_digest.h"
#include "kontur/io/read_provenance.h"
#include "kontur/io/rtstruct.h"

namespace kontur::app {

namespace {

namespace fs = std::filesystem;

/// A slice of a DICOM series stands for its folder.
std::string image_sha256(const fs::path& image, const Progress& progress) {
    std::error_code ignored;
    const bool is_slice =
        !fs::is_directory(image, ignored) && looks_like_dicom(image) && !is_dicom_seg(image) && !is_rtstruct(image);
    return file_sha256(is_slice ? fs::absolute(image).parent_path() : image, progress);
}

/// Appends what an input says of itself, `name` in front of each of its names. A file that came by very many steps keeps
/// what its last ones say.
void carry_on(Provenance& made, const std::string& name, const Provenance& input) {
    constexpr std::size_t kMostEntries = 100;
    for (const auto& [its_name, value] : input)
        if (made.size() < kMostEntries) made.emplace_back(fmt::format("{}_{}", name, its_name), value);
}

}  // namespace

Provenance input_digests(const SegmentCommand& command, const Progress& progress) {
    Provenance digests{{"contour_files_sha256", files_sha256(command.contours, progress)}};
    const fs::path& image = command.image.path;
    if (!image.empty()) digests.emplace_back("image_sha256", image_sha256(image, progress));
    return digests;
}

Provenance made_by(const std::string& command, const std::vector<std::pair<std::string, fs::path>>& inputs,
                   const std::string& options, const Progress& progress) {
    Provenance made{{"made_by", "kontur " + command}};
    for (const auto& [name, path] : inputs)
        if (!path.empty()) made.emplace_back(name + "_sha256", image_sha256(path, progress));
    made.emplace_back("version", KONTUR_VERSION);
    if (!options.empty()) made.emplace_back("options", options);
    for (const auto& [name, path] : inputs)
        if (!path.empty()) carry_on(made, name, read_provenance(path));
    return made;
}

std::string utc_date() {
    const char* const epoch = std::getenv("SOURCE_DATE_EPOCH");
    const std::time_t seconds = epoch ? static_cast<std::time_t>(std::strtoll(epoch, nullptr, 10)) : std::time(nullptr);
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(seconds));
}

}  // namespace kontur::app
