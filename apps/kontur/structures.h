// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "files.h"
#include "kontur/base/work.h"
#include "kontur/io/dicom_seg.h"

// What files say about the structures in them, and the structures one by one.

namespace kontur::app {

constexpr std::array<std::uint8_t, 3> kStructureColor{230, 179, 77};  ///< that of masks in .seg.nrrd

/// From levels between 0 and 1.
std::array<std::uint8_t, 3> to_rgb8(const std::array<double, 3>& color);

/// The same from 0 to 1.
std::array<double, 3> to_levels(const std::array<std::uint8_t, 3>& color);

/// A segment of a structure whose surface kontur fits: what is said of it, without name, number and default colour.
DicomSegment segment_like(const StructureAttributes& attributes);

/// What a fitted structure's ROI says: the same as the drawn one's, but for how it was made.
StructureAttributes fitted_attributes(StructureAttributes drawn);

/// The image; with `label` its voxels of that value alone, the others 0. Throws Error(invalid_input) when it has none.
Image read_labels(const ImageInput& input, std::optional<std::int64_t> label, const Work& work);

/// What a DICOM SEG or a .seg.nrrd says about its segments, of the layer that is read; empty for other files.
std::vector<DicomSegment> named_segments(const ImageInput& source);

/// One segment for each label of an image read from `source`, named as there where that names them.
std::vector<DicomSegment> segments_of(const Image& image, const ImageInput& source);

/// Masks on one grid or several, which may overlap, each with what is said about it.
struct Structures {
    std::vector<DicomSegment> segments;
    std::vector<Mask> masks;
};

/// Whether a label map cannot hold what the file does: segments of a DICOM SEG overlap, or a .seg.nrrd has layers.
bool may_overlap(const ImageInput& input);

/// All structures of a file. Tells `on_note` what the reader decided. Those that it does not name are named after the file,
/// and by their label where it has several.
Structures read_structures(const ImageInput& input, const Work& work);

}  // namespace kontur::app
