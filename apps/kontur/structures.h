// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "files.h"
#include "kontur/base/work.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/image.h"

// What files say about the structures in them, and the structures one by one.

namespace kontur::app {

constexpr std::array<std::uint8_t, 3> kStructureColor{230, 179, 77};  ///< that of masks in .seg.nrrd

/// Of the structures of one file that say none, by which neighbours are told apart: of the n-th, from 0.
std::array<std::uint8_t, 3> structure_color(std::size_t n);

/// The image; with `label` its voxels of that value alone, the others 0. Throws Error(invalid_input) when it has none.
Image read_labels(const ImageInput& input, std::optional<std::int64_t> label, const Work& work);

/// What a DICOM SEG, a .seg.nrrd or a NIfTI file with a table of labels says about its segments, of the layer that is read
/// or of all; empty for other files.
std::vector<DicomSegment> named_segments(const ImageInput& source);

/// The same with all tags of 3D Slicer.
std::vector<LabelName> label_names(const ImageInput& source);

/// Throws Error(invalid_input), naming the source, when an image read from it is no label map.
void check_labels(const Image& image, const ImageInput& source);

/// One segment for each label of an image read from `source`, named as there where that names them.
std::vector<DicomSegment> segments_of(const Image& image, const ImageInput& source);

/// Masks on one grid or several, which may overlap, each with what is said about it.
struct Structures {
    std::vector<DicomSegment> segments;
    std::vector<Mask> masks;
    std::vector<std::string> tags{};  ///< of 3D Slicer, one for each where the file has them
};

/// A label map of one structure.
Image label_map(const Mask& mask, std::int64_t label);

/// What 3D Slicer's tags say of one of them.
std::string tags_of(const Structures& structures, std::size_t n);

/// Whether a label map of this name says what its labels are.
bool has_label_names(const std::filesystem::path& output);

/// Whether structures that overlap can be written to a file of this name: a SEG, or a .seg.nrrd on layers.
bool has_room_for_overlap(const std::filesystem::path& output);

/// Whether a label map cannot hold what the file does: segments of a DICOM SEG overlap, or a .seg.nrrd has layers.
bool may_overlap(const ImageInput& input);

/// All structures of a file. Tells `on_note` what the reader decided. Those that it does not name are named after the file,
/// and by their label where it has several.
Structures read_structures(const ImageInput& input, const Work& work);

}  // namespace kontur::app
