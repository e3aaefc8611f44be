// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "kontur/io/contours.h"
#include "kontur/io/dicom/dicom_series.h"

namespace kontur {

/// `read_contours` where structure sets were drawn on images in time, whose volumes these are (see `read_rtstruct_in_time`).
ReadContours read_contours_in_time(const std::vector<std::filesystem::path>& paths, const ReadContoursOptions& options,
                                   const std::vector<DicomSeries>& frames);

}  // namespace kontur
