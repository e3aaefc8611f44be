// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kontur/shape/contour.h"

// Private to io/: contours in VTK's polygonal data, which `read_contours` reads.

namespace kontur {

struct VtkContours {
    ContourSet contours;             ///< without a name: the file has none
    std::vector<std::string> notes;  ///< how the file was understood
};

/// Reads the lines of a .vtk or .vtp file. Lines that end where others begin are joined, as programs that cut surfaces write
/// single edges; what comes back to its start is a closed contour, anything else an open one, with a note. A file without
/// lines has its polygons read as closed contours, unless they share edges and so are a surface. Points in LPS or RAS mm, as
/// the file says; LPS, with a note, where it says nothing. Planes are fitted, contours of one slice share one. Throws
/// Error(invalid_input) for points farther than `plane_tolerance_mm` from their contour's plane and for fewer than 3 points
/// (2 of an open one), Error(unsupported) for a surface, and what reading the file throws.
VtkContours read_vtk_contours(const std::filesystem::path& path, double plane_tolerance_mm);

/// Whether the file has lines, and so holds contours and no mesh. False, too, for what cannot be read.
bool has_vtk_lines(const std::filesystem::path& path);

}  // namespace kontur
