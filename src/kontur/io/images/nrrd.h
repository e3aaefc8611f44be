// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/io/images/image_view.h"
#include "kontur/io/images/read_image_options.h"
#include "kontur/shape/provenance.h"

namespace kontur {

/// Reads NRRD 1 to 5 (.nrrd, and .nhdr whose data file is a plain name in the same folder): raw, gzip, bzip2 and text
/// encoding, both byte orders, all scalar types, three axes of space and at most one of layers or channels, before or behind
/// them. The space may be LPS, RAS or any other of left/right, anterior/posterior, superior/inferior; lengths in mm, cm, m,
/// um. A file without a named space, directions and an origin is refused unless `allow_missing_geometry`. Shear is kept.
/// Errors: corrupt_file, unsupported, too_large, io. Source: the NRRD file format specification (teem, nrrd/format.html).
Image read_nrrd(const std::filesystem::path& path, const ReadImageOptions& options = {}, const Work& work = {});

/// The geometry alone, from the header.
Grid read_nrrd_grid(const std::filesystem::path& path, const ReadImageOptions& options = {});

/// The file that the header names for its voxels; nullopt when they are behind it or in several files.
std::optional<std::string> nrrd_data_file(const std::filesystem::path& path);

/// Writes NRRD 4, LPS, gzip, the same bytes each time. Geometry in full double precision, shear included.
void write_nrrd(const std::filesystem::path& path, const ImageView& image);

/// One segment of a 3D Slicer segmentation (.seg.nrrd).
struct NrrdSegment {
    std::string name;
    std::array<double, 3> color{};  ///< red, green, blue from 0 to 1
    std::int64_t label_value = 1;
    std::int64_t layer = 0;  ///< from 0; the file's frame `layer + 1` holds it
    std::string tags = "";   ///< NAME:VALUE with bars between them, see terms_in_tags
};

/// Writes a label map of integers as 3D Slicer reads it, one segment for each of its values that is listed. Throws
/// Error(invalid_input) for a name that is no UTF-8. Error(unsupported) for floats.
void write_seg_nrrd(const std::filesystem::path& path, const ImageView& labels, std::span<const NrrdSegment> segments);

/// The same for masks of one grid that may overlap, on layers; with the segments' own labels where all differ, else 1, 2,
/// ... Throws Error(invalid_input) also for other than one segment for each mask and for different grids.
void write_seg_nrrd_masks(const std::filesystem::path& path, std::span<const Mask> masks,
                          std::span<const NrrdSegment> segments, const Provenance& provenance = {});

/// The segments that a file names, in its order; none in a plain NRRD file. Names that are no UTF-8 count as Latin-1.
std::vector<NrrdSegment> read_nrrd_segments(const std::filesystem::path& path);

/// What the segments of one file are told apart by: their label values, or where two share one, their places from 1 on.
std::vector<std::int64_t> segment_numbers(std::span<const NrrdSegment> segments);

/// The segment with this number; nullptr without one.
const NrrdSegment* segment_of_number(std::span<const NrrdSegment> segments, std::int64_t number);

/// Throws Error(invalid_input), naming file and segments, where none of several that a file names has this number, and
/// without a number where they lie on several layers.
void check_segment_choice(std::span<const NrrdSegment> segments, std::optional<std::int64_t> number,
                          const std::filesystem::path& path);

}  // namespace kontur
