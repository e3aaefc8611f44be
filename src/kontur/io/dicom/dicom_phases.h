// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/io/dicom/dicom_series.h"

namespace kontur {

/// Series that show one body at the moments of a motion, such as a breath.
struct DicomPhases {
    std::vector<DicomSeries> series{};     ///< in the order of time; fewer than 2: there are none
    std::optional<double> step_percent{};  ///< of the cycle, where their descriptions count in even steps of it
    std::vector<std::string> others{};     ///< descriptions of further series in the folder
};

/// Phases are series of one volume each, of one modality, patient, frame of reference and description but for its numbers.
/// They come in the order of the per cent in their descriptions ("Gated, 30.0%"), or of the numbers after "phase", "frame",
/// "time", "gate" or "bin"; where the descriptions are equal, of their temporal positions or trigger times. Of several such
/// groups it is the one with `options.series_uid`, and without it there are none. Reads headers only. Throws as
/// `list_dicom_series`, and Error(invalid_input) where phases have different grids.
DicomPhases list_dicom_phases(const std::filesystem::path& folder, const DicomSeriesOptions& options = {},
                              const Work& work = {});

/// The phases of a folder of which no series was chosen; else, and where there are none, the volumes of one series.
std::vector<DicomSeries> list_dicom_frames(const std::filesystem::path& path, const DicomSeriesOptions& options = {},
                                           const Work& work = {});

/// Among which the images of a series are frames: the phases of its folder of which it is one, else its own volumes.
std::vector<DicomSeries> list_dicom_frames_with(const std::filesystem::path& path, const std::string& series_uid,
                                                const Work& work = {});

}  // namespace kontur
