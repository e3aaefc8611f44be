// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace kontur::archive {

/// So much of a file holds what `media_storage_uid` looks for.
inline constexpr std::size_t kMetaBytes = 4096;

/// Which object a DICOM file holds, by its file meta information (DICOM PS3.10, 7.1), from the file's beginning. Empty where
/// that is no such file, or does not say it.
std::string media_storage_uid(std::string_view beginning);

}  // namespace kontur::archive
