// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/io/image.h"
#include "kontur/io/images/frames.h"

namespace kontur {

/// How many frames an image has, and what its file says of time: NIfTI and DICOM of hearts do. Of a DICOM series the volumes
/// are its frames; of a folder the images, or the DICOM series that are phases of one motion. Reads no voxels, but each
/// header once. Throws as read_image does.
ImageFrames read_image_frames(const std::filesystem::path& path, const ReadImageOptions& options = {},
                              const Work& work = {});

/// Those of which the DICOM series that the options name is one; a count of 1 where it is none. Throws as
/// list_dicom_phases.
ImageFrames frames_beside(const std::filesystem::path& folder, const DicomSeriesOptions& options, const Work& work = {});

/// An image and how to read it.
struct ImageSource {
    std::filesystem::path path;
    ReadImageOptions options;
};

/// Of one of its frames, from 1. Reading it opens this frame's files alone. Throws Error(invalid_input) for a frame that is
/// not there.
ImageSource source_of_frame(const ImageSource& image, const ImageFrames& frames, std::int64_t frame);

/// The images of a folder with a file for each frame; empty: the path is no such folder. Throws Error(invalid_input) where
/// they have different grids, or one holds several frames. Internal to io.
std::vector<std::filesystem::path> checked_frame_files(const std::filesystem::path& folder, const ReadImageOptions& options);

/// Writes masks of one grid as the frames of one file: .nii or .nii.gz, with this value inside. Throws Error(unsupported)
/// for another name, and Error(invalid_input) for no mask, masks of different grids and as write_mask does.
void write_masks(const std::filesystem::path& path, std::span<const Mask> masks, std::optional<double> step_s = {},
                 std::int64_t label_value = 1, const Provenance& provenance = {});

/// Likewise label maps, all of 8 or all of 16 bits, with a table of the names.
void write_label_maps(const std::filesystem::path& path, std::span<const Image> frames, std::optional<double> step_s = {},
                      std::vector<LabelName> names = {}, const Provenance& provenance = {});

/// Throws Error(unsupported), as write_masks does, for a name of a format that holds one frame.
void check_frames_name(const std::filesystem::path& path);

}  // namespace kontur
