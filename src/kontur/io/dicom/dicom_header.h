// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: what one DICOM image file says about itself, without its pixels.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/base/geometry.h"

namespace kontur {

/// Where a slice lies: the centre of its first pixel, and unit vectors along its rows and columns.
struct SlicePlacement {
    Vec3 position;                       ///< mm, LPS (ImagePositionPatient)
    Vec3 row_direction;                  ///< of increasing column number i
    Vec3 column_direction;               ///< of increasing row number j
    std::array<double, 2> spacing_mm{};  ///< step along i, step along j

    Vec3 normal() const { return cross(row_direction, column_direction); }
};

/// How the stored values of a slice become modality units.
struct DicomRescale {
    double slope = 1;
    double intercept = 0;
};

/// A slice: a file of its own, or one frame of an enhanced multi-frame image.
struct DicomHeader {
    std::filesystem::path path;
    std::string sop_class_uid;
    std::string sop_instance_uid;
    std::string series_uid;
    std::string frame_of_reference_uid;
    std::string patient_id;
    std::string modality;
    std::string description;
    std::string transfer_syntax;  ///< its name, such as "JPEG 2000 (Lossless only)"
    bool decodable = true;        ///< false: compressed in a way that cannot be read here
    std::int64_t rows = 0;
    std::int64_t columns = 0;
    std::int64_t frames = 1;              ///< in the file
    std::optional<std::int64_t> frame{};  ///< which of them this is, from 1; unset: the file holds one slice
    std::int64_t bits_stored = 0;
    bool is_signed = false;
    std::string photometric_interpretation;
    bool has_lookup_table = false;  ///< a ModalityLUTSequence instead of slope and intercept
    DicomRescale rescale;
    SlicePlacement placement;
    std::optional<double> thickness_mm;
    // What tells slices at one position apart (time, echo, acquisition, ...).
    std::string frame_type;  ///< such as "ORIGINAL\\PRIMARY\\M\\NONE"; of frames only
    std::string dose;        ///< of dose grids, each of which is a volume: such as "PHYSICAL PLAN in RD.dcm"
    std::string dose_unit;   ///< "GY" or "RELATIVE"
    std::optional<double> echo_time_ms;
    std::optional<double> b_value;
    std::optional<std::int64_t> temporal_position;
    std::optional<std::int64_t> acquisition_number;
    std::optional<std::int64_t> echo_number;
    std::optional<double> trigger_time_ms;
    std::optional<double> beat_ms;  ///< from one heartbeat to the next, as the images are sorted; tells nothing apart
    std::optional<std::int64_t> instance_number;
};

/// Why a file takes no part in a series, such as "not a DICOM file" or "RTSTRUCT".
struct NotAnImage {
    std::string reason;
    std::string detail = "";  ///< what it lacks, such as an element; may be empty
    bool is_dicom = true;
};

/// A DICOM file that cannot be read. nullopt: it breaks off before it names its series.
struct DamagedImage {
    std::filesystem::path path;
    std::optional<std::string> series_uid;
    Error error;
};

/// "slice.dcm", or "enhanced.dcm, frame 7".
std::string name_of(const DicomHeader& slice);

/// Reads everything before the pixels: one header for each slice in the file, in the order of its frames. Damaged is an
/// image with a contradictory header (orientation vectors that are not perpendicular unit vectors, a spacing that is not
/// positive, a slope of 0, or more uncompressed pixels than the file has bytes: Error(corrupt_file) naming file and
/// element), one that ends within its header or cannot be parsed, and a mosaic of slices (Error(unsupported)). Throws
/// Error(io) for what cannot be read.
std::variant<std::vector<DicomHeader>, NotAnImage, DamagedImage> read_dicom_headers(const std::filesystem::path& path);

}  // namespace kontur
