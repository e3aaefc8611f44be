// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace kontur {

/// The files of a folder among which its DICOM series are looked for.
struct DicomFolder {
    std::vector<std::filesystem::path> files;  ///< regular ones, in the order of their paths
    /// Names of what cannot be followed, by the reason: links in a circle, links to folders.
    std::map<std::string, std::vector<std::string>> left_out;
    bool nested = false;                  ///< those of its subfolders are among the files
    std::vector<std::string> unsearched;  ///< names of subfolders that are not, because the folder itself holds images
};

/// The folder's own files where one of them is a DICOM image (a damaged one, too), else all files below it, as archives and
/// disks of hospitals have them. Hidden folders are passed over, links to folders are not followed, so that there is no
/// circle. Throws Error(io) for a file or folder that cannot be read and Error(too_large) for more than 200,000 files or
/// folders in each other more than 30 deep. Internal to io and the command line.
DicomFolder dicom_folder(const std::filesystem::path& folder);

/// The folder's own files alone.
DicomFolder dicom_files_in(const std::filesystem::path& folder);

}  // namespace kontur
