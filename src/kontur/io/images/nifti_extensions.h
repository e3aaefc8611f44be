// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kontur/io/images/label_name.h"

namespace kontur {

/// What a .nii or .nii.gz holds between header and voxels. Internal to io, as is the rest of this file.
struct NiftiExtension {
    std::uint32_t code = 0;
    std::string content;
};

constexpr std::uint32_t kNiftiCommentCode = 6, kNiftiCaretCode = 30;

/// Those of the first megabyte, up to the first that is malformed; none in another file. Throws Error(io).
std::vector<NiftiExtension> read_nifti_extensions(const std::filesystem::path& path);

/// As the file stores it, in a multiple of 16 bytes.
std::string to_bytes(const NiftiExtension& extension);

/// The names in the first label table (the XML of Caret, which TotalSegmentator writes, too), but that of label 0; none
/// where there is no table. Labels without a whole number or a name are passed over, and so are repeated ones.
std::vector<LabelName> read_nifti_labels(const std::filesystem::path& path);

/// A label table that `read_nifti_labels` reads.
NiftiExtension label_table(const std::vector<LabelName>& labels);

}  // namespace kontur
