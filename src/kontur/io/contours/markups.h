// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "kontur/io/contours/curves.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/provenance.h"

namespace kontur {

struct ReadMarkupsOptions {
    double plane_tolerance_mm = ContourCheckOptions{}.plane_tolerance_mm;  ///< of a point from the plane fitted to its curve
    Curves curves = Curves::spline;                   ///< of files that kontur did not write; its own are polygons
    std::function<void(std::string_view)> on_note{};  ///< what was left out, one sentence each
    std::function<void(double off_mm)> on_spline{};   ///< each curve that its spline takes so far off straight lines
};

/// Reads a 3D Slicer markups file (.mrk.json, schema 1.x): LPS or RAS, mm or um. Closed curves are contours, curves open
/// contours, point lists ("Fiducial") points on the surface; a point described as "inside" or "outside" lies there instead.
/// A closed curve with a control point described as "hole" is a hole. Control points without a defined position are left
/// out. The file does not tell the line between them: it is the spline that 3D Slicer draws, within 0.0001 of the curve's
/// extent, or straight. Each curve's plane is fitted; a straight open curve takes the direction of another's. A curve of
/// which no point is placed is left out, with a note. The set is named after its curve, or after what the names of several
/// have in common, and has the colour of the first that has another than 3D Slicer gives to all.
/// Throws Error naming file, markup and control point: unsupported (another type of markup, unit or schema), invalid_input
/// (too few points, a tolerance below 0, points on one line, a curve that is not planar, with the distance and the limit),
/// corrupt_file.
ContourSet read_markups(const std::filesystem::path& path, const ReadMarkupsOptions& options = {});
/// The same from the text of such a file.
ContourSet parse_markups(std::string_view text, const ReadMarkupsOptions& options = {});

/// Writes one curve per contour and one point list for all single points, in LPS and mm, whole or not at all. 3D Slicer
/// draws a spline through the points, so contours should be drawn finely; `read_markups` gives the same points again. What
/// the format has no place for is lost: the contours' `end`, `inside` and `weight`, the surface points' `outward`, all
/// attributes but the colour. `provenance` goes into the key "kontur", by which kontur knows its own files and which 3D
/// Slicer passes over. Throws Error(invalid_input) for NaN or infinite coordinates and a name that is no UTF-8.
void write_markups(const std::filesystem::path& path, const ContourSet& set, const Provenance& provenance = {});

}  // namespace kontur
