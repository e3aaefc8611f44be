// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "kontur/io/dicom/dicom_series.h"
#include "kontur/io/dicom/rtstruct.h"

namespace kontur {

/// `read_rtstruct` of a file that was drawn on images in time, whose volumes these are. Contours of a ROI get a `frame`,
/// from 1, where each refers to slices of one volume alone; holes are then looked for in each frame. Where some do and some
/// do not, none gets one, with a note.
StructureSet read_rtstruct_in_time(const std::filesystem::path& path, const std::vector<DicomSeries>& frames);

}  // namespace kontur
