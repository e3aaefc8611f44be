// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kontur/shape/contour.h"
#include "kontur/shape/provenance.h"

namespace kontur {

struct ReadMarkupsOptions {
    double plane_tolerance_mm = ContourCheckOptions{}.plane_tolerance_mm;  ///< of a point from the plane fitted to its curve
};

/// Reads the closed curves of a 3D Slicer markups file (.mrk.json, schema 1.x): LPS or RAS, mm or um. Control points are
/// taken as the polygon's vertices, because the file does not tell the curve between them; those without a defined
/// position are left out. Each curve's plane is fitted. A curve with a control point described as "hole" is a hole. The set
/// is named after its curve, or after what the names of several have in common.
/// Throws Error naming file, markup and control point: unsupported (another type of markup, unit or schema), invalid_input
/// (fewer than 3 points, points on one line, a curve that is not planar, with the distance and the limit), corrupt_file.
ContourSet read_markups(const std::filesystem::path& path, const ReadMarkupsOptions& options = {});

/// Writes one closed curve per contour, in LPS and mm, whole or not at all. 3D Slicer draws a spline through the points, so
/// contours should be drawn finely. `provenance` goes into the key "kontur", which 3D Slicer passes over. Throws
/// Error(unsupported) for what the format cannot hold: open contours, interior and exterior points.
void write_markups(const std::filesystem::path& path, const ContourSet& set, const Provenance& provenance = {});

}  // namespace kontur
