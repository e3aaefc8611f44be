// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "kontur/io/image_frames.h"

// The one place that knows which of the library's readers and writers a file needs.

namespace kontur::app {

using ImageInput = ImageSource;

/// Compares without case: ".png" for picture.PNG, ".nii.gz" for mask.nii.gz.
bool has_extension(const std::filesystem::path& path, std::string_view extension);

enum class FileKind { image, contours, mesh };

/// What a file or folder holds: DICOM by its content, everything else by its name. An unknown name counts as an image, whose
/// reader then says what is wrong with it.
FileKind input_kind(const std::filesystem::path& path);

/// What a file of this name would hold, by its extension; nullopt for .dcm, which holds contours or a mask. Throws
/// Error(unsupported), listing the known ones.
std::optional<FileKind> output_kind(const std::filesystem::path& path);

/// A slice of a DICOM series, by its content: no segmentation and no structure set. A damaged one counts, too.
bool is_dicom_slice(const std::filesystem::path& path);

/// The folder whose slices are read when a DICOM series is given by its folder or by one of its slices; "" for another file.
std::filesystem::path series_folder(const std::filesystem::path& input);

/// Whether `path` is this folder or lies below it; links are followed. False for an empty folder.
bool is_within(const std::filesystem::path& path, const std::filesystem::path& folder);

/// A name for DICOM output: it ends with .dcm.
bool is_dicom_name(const std::filesystem::path& path);

/// Throws Error(invalid_input) where an image or a folder stands in the place of contours.
void refuse_images(const std::vector<std::filesystem::path>& contours);

/// Throws Error(unsupported) unless a file of this name could hold `kind`.
void check_output_kind(const std::filesystem::path& path, FileKind kind);

}  // namespace kontur::app
