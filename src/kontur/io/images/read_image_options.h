// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "kontur/io/dicom/dicom_series.h"

namespace kontur {

/// NIfTI's two ways to say where a voxel lies.
enum class NiftiTransform { qform, sform };

struct ReadImageOptions {
    /// Which of several frames, layers or channels to read, counted from 1; without it such a file is refused.
    std::optional<std::int64_t> frame;
    /// Which transform counts when a NIfTI file has two that differ by more than 0.1 mm; without it such a file is refused.
    std::optional<NiftiTransform> prefer;
    /// Accept a file that does not say how it lies in the patient: axes along the format's own frame (NIfTI: R, A, S;
    /// else L, P, S), origin 0 and the spacing it does state. Without it such a file is refused.
    bool allow_missing_geometry = false;
    /// Files with more voxels (of one frame) are refused.
    std::int64_t max_voxels = 2'200'000'000;
    /// Which DICOM series and volume of a folder.
    DicomSeriesOptions dicom = {};
    /// Called with each sentence on what the reader decided for the user (a gantry tilt kept, files left out).
    std::function<void(std::string_view)> on_note = {};
    /// Called with each sentence on what may be wrong with what was read (a file that may be a missing slice); without it
    /// `on_note` is.
    std::function<void(std::string_view)> on_warning = {};
};

}  // namespace kontur
