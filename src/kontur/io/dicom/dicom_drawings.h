// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "kontur/base/work.h"

namespace kontur {

/// What a file says of structures that were drawn on images, without their contours or voxels.
struct DicomDrawing {
    std::filesystem::path file;
    std::string modality;                 ///< "RTSTRUCT" or "SEG"
    std::string label;                    ///< what the file calls itself; may be empty
    std::vector<std::string> structures;  ///< names of regions or segments, in the file's order
    std::string frame_of_reference_uid;   ///< of the first region; "" when none is named
    std::set<std::string> series_uids;    ///< of the images that it refers to
};

/// nullopt for other files, and for one that cannot be read. Internal to io, the command line and the viewer.
std::optional<DicomDrawing> dicom_drawing(const std::filesystem::path& file);

/// Those that lie where hospitals put what belongs to a series: beside its files, in the folder above theirs and in the
/// folders beside theirs, in the order of their paths. Files of `images` are not opened; of more than a few thousand others
/// only the first are.
std::vector<DicomDrawing> dicom_drawings_near(const std::filesystem::path& folder,
                                              const std::vector<std::filesystem::path>& images, const Work& work = {});

}  // namespace kontur
