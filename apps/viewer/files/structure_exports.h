// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/correct_mask.h"
#include "kontur/io/dicom/dicom_series.h"
#include "kontur/segment.h"
#include "viewer/model/model.h"

// Files with all structures of a project at once.

namespace kontur::viewer {

/// Their names, which say the format: label maps on the image's grid, DICOM objects that refer to the images, and surfaces,
/// one file for each structure in an archive.
inline constexpr std::array kExportsOfAll{"labels.nii.gz", "labels.nrrd",  "labels.seg.nrrd", "labels.mha",
                                          "seg.dcm",       "rtstruct.dcm", "meshes.stl.zip",  "meshes.ply.zip"};
bool is_export_of_all(std::string_view name);

/// A structure as `segment` makes it of its contours.
struct FittedStructure {
    Structure structure;
    ContourSet set;
    Segmentation segmentation;
    bool shares_border = false;  ///< mask and mesh are not those that the function alone would give
    std::shared_ptr<const CorrectedMask>
        corrected{};          ///< of a mask to be corrected, on its own grid; `made` has no function
    bool is_derived = false;  ///< a rule made it: `set` has its outlines on the slices, and `made` has no function
};

/// How it was made, for its files.
Provenance provenance_of(const FittedStructure& one);

/// All structures that have contours or a mask, in the order they were made, hidden ones too, on the image's grid; with
/// their surfaces if wished. The image is asked where the project uses it. Where its structures share borders, masks and
/// surfaces do, by its rules (see segment_together); masks to be corrected follow each other. Throws Error(invalid_input)
/// where there is none, and what `segment` throws, with the structure's name.
std::vector<FittedStructure> fit_structures(const State& state, const Image& image, bool with_mesh, const Work& work);

/// The same on another grid, for the values of another image there: masks only, and only of the structures whose contours
/// reach into the grid. Those on the image's own grid are the same.
std::vector<FittedStructure> fit_structures_on(const Grid& grid, const State& state, const Image& image, const Work& work);

/// One of them; only where borders are shared are the others fitted, too.
FittedStructure fit_structure(const State& state, Id structure, const Image& image, bool with_mesh, const Work& work);

/// Writes the file of this name, one of `kExportsOfAll`. A label map has the values of
/// `label_values` and, where the format has room, names; a voxel in several structures belongs to the smallest, so that a
/// lesion in an organ is not lost; in DICOM objects it belongs to all.
/// Returns what the user should know, one sentence each. Throws Error(invalid_input) for a DICOM object without DICOM
/// images.
std::vector<std::string> write_structures(const std::filesystem::path& path, std::string_view name,
                                          const std::vector<FittedStructure>& all, const std::optional<DicomSeries>& images,
                                          const Work& work);

}  // namespace kontur::viewer
