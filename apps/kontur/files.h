// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/base/progress.h"
#include "kontur/io/dicom_series.h"
#include "kontur/io/read_image_options.h"
#include "kontur/shape/grid.h"
#include "kontur/shape/volume.h"

// The one place that knows which of the library's readers and writers a file needs.

namespace kontur::app {

/// Compares without case: ".png" for picture.PNG, ".nii.gz" for mask.nii.gz.
bool has_extension(const std::filesystem::path& path, std::string_view extension);

enum class FileKind { image, contours, mesh };

/// What a file or folder holds: DICOM by its content, everything else by its name. An unknown name counts as an image, whose
/// reader then says what is wrong with it.
FileKind input_kind(const std::filesystem::path& path);

/// What a file of this name would hold, by its extension. Throws Error(unsupported), listing the known ones.
FileKind output_kind(const std::filesystem::path& path);

/// Throws Error(unsupported) unless a file of this name would hold `kind`.
void check_output_kind(const std::filesystem::path& path, FileKind kind);

/// An image that is one file (NIfTI, NRRD, MetaImage) or a DICOM series.
struct ImageInput {
    std::filesystem::path path;
    ReadImageOptions file;
    DicomSeriesOptions series;
};

/// What was read, and what had to be decided on the way (a gantry tilt kept, files left out).
struct LoadedImage {
    Image image;
    std::vector<std::string> notes;
};
LoadedImage load_image(const ImageInput& input, const Progress& progress);

/// The same without voxels.
struct LoadedGrid {
    Grid grid;
    std::vector<std::string> notes;
};
LoadedGrid load_grid(const ImageInput& input, const Progress& progress);

}  // namespace kontur::app
