// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/correct_mask.h"
#include "kontur/io/dicom/dicom_series.h"
#include "kontur/io/image.h"
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

/// Label maps of all structures, one for each time. Values are those of `label_values`; a voxel in several structures
/// belongs to the smallest of them at that time, so that a lesion in an organ is not lost.
class LabelFrames {
public:
    /// All structures at the next time, the same ones each time.
    void add(const std::vector<FittedStructure>& all);

    /// The first one in any format of a label map; all, as write_label_maps does. With names, where there is room.
    void write_first(const std::filesystem::path& path) const;
    void write(const std::filesystem::path& path, std::optional<double> step_s) const;
    /// What the user should know, one sentence each: how many voxels lie in two structures.
    std::vector<std::string> notes() const;

private:
    std::vector<Image> frames_;
    std::vector<LabelName> names_;
    Provenance provenance_;
    std::map<std::pair<std::size_t, std::size_t>, std::int64_t> shared_;  ///< of the larger and the smaller structure
};

/// Writes the file of this name, one of `kExportsOfAll`. A label map is that of LabelFrames; in DICOM objects a voxel
/// in several structures belongs to all.
/// Returns what the user should know, one sentence each. Throws Error(invalid_input) for a DICOM object without DICOM
/// images.
std::vector<std::string> write_structures(const std::filesystem::path& path, std::string_view name,
                                          const std::vector<FittedStructure>& all, const std::optional<DicomSeries>& images,
                                          const Work& work);

}  // namespace kontur::viewer
