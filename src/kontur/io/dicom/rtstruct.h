// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kontur/io/dicom/dicom_series.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/provenance.h"

namespace kontur {

/// One region of interest of an RT structure set.
struct Roi {
    std::int64_t number = 0;
    std::string name;
    std::string frame_of_reference_uid;
    ContourSet contours;  ///< may be empty; its `name` is the ROI's, and its `attributes` what else the file says of it
    std::vector<std::string> notes;  ///< how the stored contours were interpreted, and what was left out
    std::string damage;              ///< why its contours cannot be read, naming ROI and contour; "" when they can
};

struct StructureSet {
    std::string label;
    std::vector<Roi> rois;             ///< in the file's order
    std::vector<std::string> notes{};  ///< what was left out that belongs to no ROI
};

/// True for a file that starts as a DICOM file does and says that it is an RT structure set. Reads a few elements only.
bool is_rtstruct(const std::filesystem::path& path);

/// Reads a DICOM RT structure set. Contour points are the file's, in mm (LPS); the contours of one slice share one plane.
/// Holes, in each of the three ways that files store them: a keyhole (one path that runs to the hole's rim and back through
/// a channel, retraced within 0.001 mm) becomes an outer and an inner contour; CLOSEDPLANAR_XOR contours and nested
/// CLOSED_PLANAR ones on one slice are filled even-odd, so those at odd depth are marked `hole`. OPEN_PLANAR contours are
/// open contours, POINT ones points on the surface, with a note each. OPEN_NONPLANAR contours, repeated ones and those
/// without area are left out, with a note each; a contour is repeated by another through the same points, rounded to 0.001
/// mm, whatever its start, direction and closing point. A ROI with coordinates that are no numbers, no triples or not as
/// many as declared has `damage` and no contours. Contours of a ROI that is not listed are left out, with a note. The
/// ROIs of an approved file are approved. Throws Error(invalid_input) when the file is no RTSTRUCT.
StructureSet read_rtstruct(const std::filesystem::path& path);

/// The ROI with this name or, if none has it, with this name but for case or with this number; without either, the only ROI
/// that has contours. Throws Error(invalid_input), listing the ROIs, when that leaves none or several, and
/// Error(corrupt_file) naming its damage.
Roi select_roi(const StructureSet& set, const std::optional<std::string>& name_or_number = std::nullopt);

/// How the holes of a slice are stored.
enum class HoleEncoding {
    keyhole,    ///< one path that runs to the hole's rim and back through a channel; understood everywhere
    exclusive,  ///< CLOSEDPLANAR_XOR contours; plain in the standard, unknown to most programs
    nested,     ///< a contour inside another, to be filled even-odd; some programs fill it
};

struct WriteRtstructOptions {
    HoleEncoding holes = HoleEncoding::keyhole;
    std::string series_description = "kontur contours";  ///< this default is followed by date and names
    std::int64_t series_number = 0;                      ///< 0: the time of day, hhmmss
    Provenance provenance{};  ///< how the contours were made: the description of kontur's contribution (equipment)
};

/// Writes a DICOM RT structure set (Implicit VR Little Endian, UTF-8) that refers to the images it was made on: patient,
/// study, frame of reference, and for each contour its slice. A ROI whose number is 0 has that of its attributes, or where
/// these name none, or another ROI has it, the lowest free one from 1 on; frames of reference and notes are not used.
/// Contours nested on one plane are filled even-odd, whatever their `hole` says. Coordinates are exact to 1e-9 mm. Names
/// have room for 64 characters, none of them a backslash; two that would become equal get a number. A ROI without a name is
/// "Structure_1" by its place: plastimatch ends at an empty name. The file is approved if all ROIs are. Returns what the
/// user should know, one sentence each: names and attributes that were changed, contours that lie on no slice, and images
/// without a frame of reference, for which a new one is named. Throws Error(invalid_input), naming ROI and contour, for open
/// contours, fewer than 3 points, coordinates that are not finite and a hole that nothing encloses, for two ROIs with one
/// number and for texts that are no UTF-8; Error(unsupported) for interior, exterior or surface points; Error(io). Source:
/// DICOM PS3.3 A.19 and C.8.8.5 to C.8.8.8.
std::vector<std::string> write_rtstruct(const std::filesystem::path& path, const StructureSet& set,
                                        const DicomSeries& images, const WriteRtstructOptions& options = {});

}  // namespace kontur
