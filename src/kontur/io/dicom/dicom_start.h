// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: how a DICOM file begins.

#include <filesystem>
#include <optional>

namespace kontur {

/// How a DICOM file begins (PS3.10 7.1). Files of old programs lack the preamble, some the meta information, too.
struct DicomStart {
    bool has_preamble = true;  ///< 128 bytes and "DICM"
    bool has_meta = true;      ///< elements of group 2 come first
    bool explicit_vr = true;   ///< of the elements that come first; little-endian
};

/// nullopt for a file that does not begin as DICOM does: with the preamble or, without it, with elements in ascending order,
/// two of group 2 or three of group 8, explicit or implicit, as no text and no other format does. Throws Error(io) for what
/// cannot be read or is no regular file.
std::optional<DicomStart> dicom_start(const std::filesystem::path& path);

/// Whether a file begins so; false for what is no regular file. Throws Error(io) for one that cannot be read.
bool has_dicom_prefix(const std::filesystem::path& path);

}  // namespace kontur
