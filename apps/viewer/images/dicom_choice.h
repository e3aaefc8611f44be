// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "kontur/base/work.h"

// What a page shows of DICOM folders before one of their volumes is opened (docs/viewer-protocol.md).

namespace kontur::viewer {

/// The volumes of a folder, or of those below it, with whose they are. Throws as `list_dicom_series`.
nlohmann::json dicom_volumes(const std::filesystem::path& folder, const Work& work);

/// A small picture of one slice, as a binary reply. Throws as `read_dicom_slice`.
std::string thumbnail(const std::filesystem::path& file, std::int64_t frame);
/// The same of the middle slice of a file's frame, from 1. Throws what `read_image` throws.
std::string frame_thumbnail(const std::filesystem::path& file, std::int64_t frame);

}  // namespace kontur::viewer
