// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kontur/shape/contour.h"

namespace kontur {

/// One region of interest of an RT structure set.
struct Roi {
    std::int64_t number = 0;
    std::string name;
    std::string interpreted_type;  ///< "GTV", "ORGAN", "EXTERNAL", ...; may be empty
    std::string frame_of_reference_uid;
    std::optional<std::array<std::uint8_t, 3>> color;  ///< red, green, blue
    ContourSet contours;                               ///< `contours.name` is the ROI's name; may be empty
    std::vector<std::string> notes;                    ///< how the stored contours were interpreted, and what was left out
};

struct StructureSet {
    std::string label;
    std::vector<Roi> rois;  ///< in the file's order
};

/// True for a file that starts as a DICOM file does and says that it is an RT structure set. Reads a few elements only.
bool is_rtstruct(const std::filesystem::path& path);

/// Reads a DICOM RT structure set. Contour points are the file's, in mm (LPS); the contours of one slice share one plane.
/// Holes, in each of the three ways that files store them: a keyhole (one path that runs to the hole's rim and back through
/// a channel, retraced within 0.001 mm) becomes an outer and an inner contour; CLOSEDPLANAR_XOR contours and nested
/// CLOSED_PLANAR ones on one slice are filled even-odd, so those at odd depth are marked `hole`. POINT and open contours,
/// repeated ones and those without area are left out, with a note each.
/// Throws Error(invalid_input) when the file is no RTSTRUCT and Error(corrupt_file), naming ROI and contour, for coordinates
/// that are no numbers, no triples or not as many as declared.
StructureSet read_rtstruct(const std::filesystem::path& path);

/// The ROI with this name or, if none has it, with this number; without either, the only ROI that has contours. Throws
/// Error(invalid_input), listing the ROIs, when that leaves none or several.
Roi select_roi(const StructureSet& set, const std::optional<std::string>& name_or_number = std::nullopt);

}  // namespace kontur
