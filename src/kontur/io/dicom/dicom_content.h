// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: what the files of a folder hold.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/io/dicom/dicom_folder.h"
#include "kontur/io/dicom/dicom_series.h"
#include "kontur/io/dicom/dicom_stack.h"

namespace kontur {

/// A file that takes no part, and why.
struct LeftOutFile {
    std::filesystem::path path;
    NotAnImage why;
};

struct DicomContent {
    std::vector<DicomStack> stacks;
    std::vector<DamagedImage> damaged;
    std::vector<LeftOutFile> others;
    std::vector<std::string> notes;  ///< on copies and on what was not searched
};

/// Reads the headers of a folder's files. Of several files with one SOP Instance UID, which by the standard are one object,
/// all but the first are left out, or all but `preferred`, with a note; where their bytes differ, the later one counts as
/// damaged. Throws Error(io).
DicomContent read_dicom_content(const std::filesystem::path& root, const DicomFolder& folder,
                                const std::optional<std::filesystem::path>& preferred, const Work& work);

/// What users are told of a stack.
DicomSeries described(const DicomStack& stack);

/// "left out 3 files (RTSTRUCT): a.dcm, ..."
std::string left_out_note(const std::string& reason, const std::vector<std::string>& names);

}  // namespace kontur
