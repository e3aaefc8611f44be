// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace kontur {

/// What a file's meta information says about what follows it.
struct DicomMeta {
    std::string syntax;             ///< TransferSyntaxUID; "" where it names none
    std::uint64_t data_offset = 0;  ///< of the first element behind it
};

/// Of a file that begins with a preamble or with meta information (group 2). Throws Error(io), and Error(corrupt_file) where
/// the meta information breaks off. Internal to io.
DicomMeta read_dicom_meta(const std::filesystem::path& path);

/// Throws Error(corrupt_file) for a DICOM file whose sequences are nested more than 100 deep, counted over all of the file.
/// DCMTK reads and frees each level by a call within the call before, so that a hostile file of a few hundred kilobytes
/// would exhaust the stack and end the process. Also for a deflated one whose elements claim more than there is, or than
/// 128 MB beside the pixels, or cannot be followed: DCMTK takes what memory an element claims. Reads the heads of elements
/// and skips their values (deflated files: inflates all). What is no DICOM file, or ends early, passes: DCMTK says so
/// better. Returns where zeros begin that fill the file up behind its last element. Internal to io.
std::optional<std::uint64_t> check_dicom_nesting(const std::filesystem::path& path);

}  // namespace kontur
