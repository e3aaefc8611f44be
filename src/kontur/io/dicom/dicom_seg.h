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
#include "kontur/io/dicom/dicom_series.h"
#include "kontur/shape/provenance.h"
#include "kontur/shape/structure_attributes.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// One segment of a DICOM segmentation.
struct DicomSegment {
    std::int64_t number = 1;                       ///< from 1; its label in label maps
    std::string label;                             ///< its name
    std::string algorithm_type = "SEMIAUTOMATIC";  ///< or "AUTOMATIC" or "MANUAL"
    std::string algorithm_name = "";
    std::optional<std::array<std::uint8_t, 3>> color = std::nullopt;  ///< sRGB
    std::string description = "";                                     ///< in words; may be empty
    std::optional<CodedConcept> category = std::nullopt;              ///< what sort of thing it is; "tissue" where unset
    std::optional<CodedConcept> code = std::nullopt;                  ///< what it is; "tissue" where unset
    std::int64_t voxels = 0;                                          ///< set by reading
    std::int64_t shared_voxels = 0;  ///< those of them that lie in other segments, too; set by reading
};

/// A segment of a structure whose surface kontur fits: what is said of it, without name and number.
DicomSegment fitted_segment(const StructureAttributes& attributes);

/// What a DICOM segmentation says about itself, and how much each segment holds.
struct DicomSegmentation {
    Grid grid;  ///< from the first to the last stored slice; slices without a frame between them belong to it
    std::vector<DicomSegment> segments;
    std::string frame_of_reference_uid;
    std::string referenced_series_uid;  ///< of the images it was made on; "" when not given
    std::vector<std::string> notes;
};

/// True for a file that starts as a DICOM file does and says that it is a segmentation. Reads a few elements only.
bool is_dicom_seg(const std::filesystem::path& path);

/// Reads all but the voxels' places; a note says which segments overlap. Binary segmentations, fractional ones, which
/// count as inside from one half on (a note says so), and label maps, in which PixelPaddingValue or else 0 is no segment.
/// Compressed ones as RLE, JPEG 2000, JPEG-LS, lossless JPEG, or deflated as a whole or frame by frame. Frames lie in any
/// order, with any slices left out. Throws Error(unsupported) for other kinds of segmentation, frames that are not parallel
/// or not on one regular lattice; Error(corrupt_file) and Error(too_large).
DicomSegmentation read_dicom_segmentation(const std::filesystem::path& path, std::int64_t max_voxels = 2'200'000'000);

struct DicomSeg {
    Image labels;
    std::vector<std::string> notes;
};

/// The segments' numbers on the segmentation's grid; with `segment` that one alone. Throws Error(invalid_input), naming
/// two, when segments overlap, and for a segment that is not there, listing those that are.
DicomSeg read_dicom_seg(const std::filesystem::path& path, std::optional<std::int64_t> segment = {},
                        std::int64_t max_voxels = 2'200'000'000, const Work& work = {});

/// The voxels of each segment, in the order of `read_dicom_segmentation` and on its grid, whether they overlap or not.
/// Throws Error(too_large) when all masks together have more than `max_voxels`.
std::vector<Mask> read_dicom_seg_masks(const std::filesystem::path& path, std::int64_t max_voxels = 2'200'000'000,
                                       const Work& work = {});

/// A segmentation as a whole.
struct DicomSegments {
    DicomSegmentation about;
    std::vector<Mask> masks;  ///< of each segment
};

/// Both at once, from one look at the file. Throws as `read_dicom_seg_masks`.
DicomSegments read_dicom_segments(const std::filesystem::path& path, std::int64_t max_voxels = 2'200'000'000,
                                  const Work& work = {});

/// What a segment says of its structure, beside its name.
StructureAttributes attributes_of(const DicomSegment& segment);

/// How segments were made, for those who audit them (DICOM PS3.3 table 10-19).
struct DicomAlgorithm {
    std::string name;  ///< "" : nothing is said
    std::string version;
    std::string parameters;  ///< free text
};

struct WriteDicomSegOptions {
    std::string series_description = "kontur segmentation";  ///< this default is followed by date and names
    std::int64_t series_number = 0;                          ///< 0: the time of day, hhmmss
    DicomAlgorithm algorithm{};
    Provenance provenance{};  ///< how the file was made: the description of kontur's contribution (equipment)
};

/// A label map, and what its values are.
struct LabelledSegments {
    const Image& labels;
    const std::vector<DicomSegment>& segments;
};

/// Segments that may overlap: one mask for each, in the order given, whatever their numbers are.
struct MaskedSegments {
    const std::vector<Mask>& masks;
    const std::vector<DicomSegment>& segments;
};

/// Writes a binary DICOM segmentation (Explicit VR Little Endian, UTF-8) that refers to the images it was made on: patient,
/// study, frame of reference, and for each frame its source slice. Each segment covers the voxels of `labels` whose value is
/// its number; in the file they are numbered from 1 in the order given, as DICOM wants it. The frames are all slices of the
/// images, so a mask comes back on their grid. `labels` may be turned, mirrored or cropped against the images as long as its
/// voxels lie on theirs. Throws Error(invalid_input) when they do not, naming the distance in voxels, and how many lie
/// outside of the images, for a value without a segment and for a segment without voxels; Error(too_large) beyond DICOM's 4
/// GiB; Error(io). Names have room for 64 characters, none of them a backslash; two that would become equal get a number.
/// Returns what the user should know, one sentence each: names, descriptions and codes that were changed. Source: DICOM
/// PS3.3 A.51 and C.8.20.
std::vector<std::string> write_dicom_seg(const std::filesystem::path& path, const LabelledSegments& content,
                                         const DicomSeries& images, const WriteDicomSegOptions& options = {},
                                         const Work& work = {});

/// Segments that move: of each its masks at the volumes of a series, in their order.
struct MovingSegments {
    const std::vector<std::span<const Mask>>& masks;
    const std::vector<DicomSegment>& segments;
    const std::vector<DicomSeries>& volumes;
};

/// The same for segments over time: each frame names the slice of its own volume, and its temporal position, which is a
/// dimension of its own. Throws Error(invalid_input) also unless each segment has a mask for each volume.
std::vector<std::string> write_dicom_seg_over_time(const std::filesystem::path& path, const MovingSegments& content,
                                                   const WriteDicomSegOptions& options = {}, const Work& work = {});

/// Throws Error(invalid_input) also when there are not as many masks as segments.
std::vector<std::string> write_dicom_seg_masks(const std::filesystem::path& path, const MaskedSegments& content,
                                               const DicomSeries& images, const WriteDicomSegOptions& options = {},
                                               const Work& work = {});

}  // namespace kontur
