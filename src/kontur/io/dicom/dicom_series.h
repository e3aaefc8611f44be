// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/shape/volume.h"

namespace kontur {

struct DicomContent;

/// One volume found in a folder of DICOM files.
struct DicomSeries {
    std::string series_uid;
    std::string modality;     ///< "CT", "MR", "PT", ...
    std::string description;  ///< SeriesDescription; may be empty
    /// What sets this volume apart from others of the same series, such as "echo 2" or "time 1 of 20"; else empty.
    std::string distinction;
    std::string frame_of_reference_uid;  ///< "" when none is named, or by each file another
    /// One per slice, in the order of k; the same for frames of one file. Of slices that were resampled those that are
    /// there.
    std::vector<std::filesystem::path> files;
    std::vector<std::int64_t> frames;  ///< which frame of its file each slice is, from 1
    std::int64_t columns = 0;
    std::int64_t rows = 0;
    /// Of a heart: ms after the beat began, and from one beat to the next (TriggerTime, NominalInterval); the slices' means.
    std::optional<double> trigger_time_ms, beat_ms;
};

struct DicomSeriesOptions {
    /// Which series of the folder; may be left out when there is only one.
    std::optional<std::string> series_uid = std::nullopt;
    /// Which volume of the series, from 1; may be left out when there is only one.
    std::optional<int> volume = std::nullopt;
    /// Slices that do not lie evenly, or of which some are missing, get even steps: the grid goes from the first to the last
    /// one in steps near the usual one, and slices between two others are interpolated linearly. Otherwise they are refused.
    bool resample_slices = false;
    /// Larger volumes are refused before their pixels are read.
    std::int64_t max_voxels = 2'200'000'000;
    /// What `read_dicom_headers_of` found at the path; without it each call looks through the folder itself.
    std::shared_ptr<const DicomContent> content = nullptr;
};

struct DicomVolume {
    Image image;  ///< modality units (Hounsfield units for CT): rescale slope and intercept of each file applied
    DicomSeries series;
    std::vector<std::string> notes;  ///< what was decided for the user: gantry tilt, files left out, ...
    /// What may be wrong with the volume: files that could be slices of it and cannot be read.
    std::vector<std::string> warnings;
};

struct DicomGrid {
    Grid grid;
    DicomSeries series;
    std::vector<std::string> notes;
    std::vector<std::string> warnings;
};

/// True when the file starts as a DICOM file does, with a preamble or without one, or the folder or one below it holds such
/// a file. False for what is not there. Throws Error(io) for what cannot be read.
bool looks_like_dicom(const std::filesystem::path& path);

/// The headers of all files beside one, or in a folder, for calls that read volume after volume of it: as the `content` of
/// their options. Throws Error(io) as `read_dicom_series`.
std::shared_ptr<const DicomContent> read_dicom_headers_of(const std::filesystem::path& path, const Work& work = {});

/// The volumes in a folder, or, where it holds no images itself, in the folders below it, ordered by series UID; dose grids
/// are among them. Reads headers only. Damaged images are left out; their error is thrown where there are no others.
std::vector<DicomSeries> list_dicom_series(const std::filesystem::path& folder, const Work& work = {});

/// The volumes of one series, in their order: that of the file or the options, of which the volume does not count, or the
/// only one. Headers only. Throws as `read_dicom_series`.
std::vector<DicomSeries> list_dicom_volumes(const std::filesystem::path& path, const DicomSeriesOptions& options = {},
                                            const Work& work = {});

/// One slice alone, as an image one voxel deep: for previews. Where it names no thickness it is 1 mm thick. `frame` counts
/// from 1. Throws as `read_dicom_series`, and
/// Error(invalid_input) for a file that holds no image or fewer frames.
Image read_dicom_slice(const std::filesystem::path& file, std::int64_t frame = 1);

/// Reads one volume. `path` is a folder, or one file, which stands for its own series (and volume) in its folder. Where a
/// folder holds no images itself, the folders below it are searched (links to folders are not followed). Slices are ordered
/// by their position along the slice normal, never by name or number, so k runs along row x column direction and
/// the grid is right-handed; a gantry tilt is kept exactly, as a sheared grid. Files that are no images (text, RTSTRUCT,
/// SEG) are left out and noted, and so are identical copies and damaged files of other series; a damaged or empty file that
/// may be a slice of this one gives a warning. A dose grid (RTDOSE) is read, in its unit, where it or its series is named or
/// there is nothing else. The frames of an enhanced multi-frame image are slices like those in files of their own. Samples
/// take the narrowest type that holds all values; a fractional slope makes them float. PixelPaddingValue is kept as an
/// ordinary value. Throws Error(invalid_input) when the options leave more than one volume, listing them, or none, or their
/// limit is below 1, for two patients in one series and for different files with one SOP Instance UID; Error(unsupported)
/// for missing slices and irregular spacing (a UnevenSlicesError, unless they are resampled), several slices at one
/// position, colour, lookup tables and other compression than JPEG, JPEG-LS, JPEG 2000, RLE and deflate; Error(corrupt_file)
/// for damaged files of the series, naming the file; Error(too_large); Error(io) when there is nothing to read or a file
/// cannot be read.
DicomVolume read_dicom_series(const std::filesystem::path& path, const DicomSeriesOptions& options = {},
                              const Work& work = {});

/// The same volume's grid, from the headers only.
DicomGrid read_dicom_grid(const std::filesystem::path& path, const DicomSeriesOptions& options = {}, const Work& work = {});

}  // namespace kontur
