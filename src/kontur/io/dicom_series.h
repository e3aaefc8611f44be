// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kontur/base/progress.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// One volume found in a folder of DICOM files.
struct DicomSeries {
    std::string series_uid;
    std::string modality;     ///< "CT", "MR", "PT", ...
    std::string description;  ///< SeriesDescription; may be empty
    /// What sets this volume apart from others of the same series, such as "echo 2" or "time 1 of 20"; else empty.
    std::string distinction;
    std::string frame_of_reference_uid;        ///< "" when none is named, or by each file another
    std::vector<std::filesystem::path> files;  ///< one per slice, in the order of k; the same for frames of one file
    std::vector<std::int64_t> frames;          ///< which frame of its file each slice is, from 1
    std::int64_t columns = 0;
    std::int64_t rows = 0;
};

struct DicomSeriesOptions {
    /// Which series of the folder; may be left out when there is only one.
    std::optional<std::string> series_uid = std::nullopt;
    /// Which volume of the series, from 1; may be left out when there is only one.
    std::optional<int> volume = std::nullopt;
    /// Larger volumes are refused before their pixels are read.
    std::int64_t max_voxels = 2'200'000'000;
};

struct DicomVolume {
    Image image;  ///< modality units (Hounsfield units for CT): rescale slope and intercept of each file applied
    DicomSeries series;
    std::vector<std::string> notes;  ///< what was decided for the user: gantry tilt, files left out, ...
};

struct DicomGrid {
    Grid grid;
    DicomSeries series;
    std::vector<std::string> notes;
};

/// True when the file starts as a DICOM file does, or the folder holds such a file.
bool looks_like_dicom(const std::filesystem::path& path);

/// The volumes in a folder (its subfolders are not searched), ordered by series UID. Reads headers only. Damaged images are
/// left out; their error is thrown where there are no others.
std::vector<DicomSeries> list_dicom_series(const std::filesystem::path& folder);

/// Reads one volume. `path` is a folder, or one file, which stands for its own series (and volume) in its folder. Slices are
/// ordered by their position along the slice normal, never by name or number, so k runs along row x column direction and
/// the grid is right-handed; a gantry tilt is kept exactly, as a sheared grid. Files that are no images (text, RTSTRUCT,
/// SEG) are left out and noted, and so are damaged images of other series than the one that the options or the file name.
/// The frames of an enhanced multi-frame image are slices like those in files of their own. Samples take the narrowest type
/// that holds all values; a fractional slope makes them float. PixelPaddingValue is kept as an ordinary value. Throws
/// Error(invalid_input) when the options leave more than one volume, listing them, or none; Error(unsupported) for missing
/// slices, irregular spacing, several slices at one position, colour, lookup tables and other compression than JPEG,
/// JPEG-LS, JPEG 2000, RLE and deflate; Error(corrupt_file) for damaged files, naming the file; Error(too_large); Error(io)
/// when there is nothing to read.
DicomVolume read_dicom_series(const std::filesystem::path& path, const DicomSeriesOptions& options = {},
                              const Progress& progress = {});

/// The same volume's grid, from the headers only.
DicomGrid read_dicom_grid(const std::filesystem::path& path, const DicomSeriesOptions& options = {},
                          const Progress& progress = {});

}  // namespace kontur
