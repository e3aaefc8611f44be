// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kontur/io/contours/curves.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/provenance.h"

namespace kontur {

struct ReadContoursOptions {
    /// RT structure sets: the ROI's name, in capitals or not, or its number; needed when several have contours. Other files
    /// hold one structure, whose name it then has to be, unless they are read together with a structure set.
    std::optional<std::string> roi;
    double plane_tolerance_mm = ContourCheckOptions{}.plane_tolerance_mm;  ///< for curves whose plane must be fitted
    std::optional<Curves> curves{};  ///< of 3D Slicer's markups, which one of the files has to be; nullopt: splines
};

struct ReadContours {
    ContourSet contours;
    std::string frame_of_reference_uid;  ///< of a ROI; of several files' the first; "" when none is named
    std::vector<std::string> notes;      ///< how the file was interpreted and what was left out, for the user to see
};

/// Reads kontur's contour file, 3D Slicer's markups, VTK's lines (.vtk, .vtp: closed curves, of which none has a name) or a
/// DICOM RT structure set; the content decides which. Throws
/// Error(unsupported) for any other file, Error(invalid_input) for a `roi` that it does not hold, a tolerance below 0,
/// `curves` of other files than markups, and what the format's own reader throws.
ReadContours read_contours(const std::filesystem::path& path, const ReadContoursOptions& options = {});

/// The contours of several files as one object, in the order of the files, named after the first that has a name, with the
/// attributes of the first that has any. Notes begin with their file's name.
ReadContours read_contours(const std::vector<std::filesystem::path>& paths, const ReadContoursOptions& options = {});

/// Writes 3D Slicer's markups to a name that ends in .mrk.json and kontur's contour file to any other .json. Throws
/// Error(unsupported) for another extension.
void write_contours(const std::filesystem::path& path, const ContourSet& set, const Provenance& provenance = {});

}  // namespace kontur
