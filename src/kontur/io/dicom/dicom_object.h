// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kontur {

/// Which object a DICOM file holds.
struct DicomObject {
    std::string study_uid, series_uid, instance_uid;
    std::string modality;  ///< such as "SEG"; may be empty
};

/// Reads the elements before the pixels. Throws Error(io), and Error(corrupt_file) for no DICOM file and for one that does
/// not name its study, series and instance.
DicomObject dicom_object(const std::filesystem::path& file);

/// What the file says that kontur contributed (PS3.3 C.12.1.1.5): a description of each time. Throws likewise.
std::vector<std::string> kontur_contributions(const std::filesystem::path& file);

}  // namespace kontur
