// SPDX-License-Identifier: Apache-2.0
#include "input_digests.h"

#include <fmt/chrono.h>

#include <charconv>
#include <cstdlib>
#include <ctime>
#include <string_view>

#include "kontur/base/error.h"
#include "kontur/io/file_digest.h"
#include "kontur/io/images/image_files.h"
#include "kontur/io/read_provenance.h"

namespace kontur::app {

namespace {

namespace fs = std::filesystem;

/// A slice of a DICOM series stands for its folder, a header for the file with its voxels, too.
std::string image_sha256(const fs::path& image, const Work& work) {
    const fs::path folder = series_folder(image);
    return folder.empty() ? files_sha256(image_files(image), work) : file_sha256(folder, work);
}

/// Appends what an input says of itself, `name` in front of each of its names. A file that came by very many steps keeps
/// what its last ones say.
void carry_on(Provenance& provenance, const std::string& name, const Provenance& input) {
    constexpr std::size_t kMostEntries = 100;
    for (const auto& [its_name, value] : input)
        if (provenance.size() < kMostEntries) provenance.emplace_back(fmt::format("{}_{}", name, its_name), value);
}

std::time_t seconds_since_1970(std::string_view text) {
    constexpr std::int64_t kEndOf9999 = 253'402'300'799;
    std::int64_t seconds = -1;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), seconds);
    if (failure != std::errc() || end != text.data() + text.size() || seconds < 0 || seconds > kEndOf9999)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("SOURCE_DATE_EPOCH is {}; it is a number of seconds from 0 to {}", text, kEndOf9999));
    return static_cast<std::time_t>(seconds);
}

}  // namespace

Provenance input_digests(const SegmentCommand& command, const Work& work) {
    Provenance digests{{"contour_files_sha256", files_sha256(command.contours, work)}};
    const fs::path& image = command.image.path;
    if (!image.empty()) digests.emplace_back("image_sha256", image_sha256(image, work));
    return digests;
}

Provenance made_by(const std::string& command, const std::vector<std::pair<std::string, fs::path>>& inputs,
                   const std::string& options, const Work& work) {
    Provenance provenance{{"made_by", "kontur " + command}};
    for (const auto& [name, path] : inputs)
        if (!path.empty()) provenance.emplace_back(name + "_sha256", image_sha256(path, work));
    provenance.emplace_back("version", KONTUR_VERSION);
    if (!options.empty()) provenance.emplace_back("options", options);
    for (const auto& [name, path] : inputs)
        if (!path.empty()) carry_on(provenance, name, read_provenance(path));
    return provenance;
}

std::string utc_date() {
    const char* const epoch = std::getenv("SOURCE_DATE_EPOCH");
    const std::time_t seconds = epoch ? seconds_since_1970(epoch) : std::time(nullptr);
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(seconds));
}

}  // namespace kontur::app
