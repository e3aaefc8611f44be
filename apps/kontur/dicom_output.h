// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "files.h"
#include "kontur/base/work.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/image.h"
#include "kontur/segment.h"
#include "structures.h"

// What the writers of several formats have in common with those of DICOM, whose files (.dcm) refer to images.

namespace kontur::app {

/// What lists of series tell a DICOM output by.
struct SeriesWords {
    std::int64_t number = 0;    ///< 0: the time of day
    std::string description{};  ///< "": kontur's, with date and names
};

/// Throws Error(invalid_input), before any work is done, when DICOM is to be written without DICOM images to refer to.
void check_dicom_images(const std::filesystem::path& output, const std::filesystem::path& images);

/// Throws Error(invalid_input) when it was said how to store holes, but no contours go to DICOM.
void check_holes(const std::optional<HoleEncoding>& holes, bool is_rtstruct);

/// Throws Error(invalid_input) for words that no list of series has room for, and when none of the outputs is DICOM.
void check_series(const SeriesWords& series, std::span<const std::filesystem::path> outputs);

WriteRtstructOptions rtstruct_options(const std::optional<HoleEncoding>& holes, const SeriesWords& series,
                                      const Provenance& provenance);

/// The frame of reference that a mask names: of a DICOM segmentation; else "".
std::string frame_of_reference_of(const std::filesystem::path& mask);

/// The frame of reference of DICOM images or of a segmentation; "" when none is named.
std::string frame_of_reference_of(const ImageInput& images);

/// What the user should know, in one sentence, where contours or a mask name another frame of reference than the images;
/// nothing where either names none.
std::vector<std::string> frame_of_reference_notes(const std::string& uid, const ImageInput& images);

/// Writes contours to .json, .mrk.json or, as a structure set with one ROI, to .dcm; how they were made is in
/// `options.provenance`. Returns what the user should know.
std::vector<std::string> write_contours(const std::filesystem::path& path, const ContourSet& set, const ImageInput& images,
                                        const WriteRtstructOptions& options);

/// Writes several structures as one structure set; how they were made is in `options.provenance`.
std::vector<std::string> write_contours_of_all(const std::filesystem::path& path, const std::vector<ContourSet>& sets,
                                               const ImageInput& images, const WriteRtstructOptions& options);

/// A file to write, in the format of its name, and what DICOM has to know of it.
struct OutputFile {
    const std::filesystem::path& path;
    const ImageInput& images;  ///< that a DICOM file refers to
    const SeriesWords& series;
    const Provenance& provenance;
};

/// Writes the mask of a fit in the format of the name; in .dcm with the way it was made and what is said of the structure.
std::vector<std::string> write_mask(const OutputFile& file, const Segmentation& result,
                                    const StructureAttributes& attributes, const LabelName& label, const Work& work);

/// Writes masks of fits over time as a DICOM segmentation on volumes of a series: of each segment one for each volume.
std::vector<std::string> write_masks_over_time(const OutputFile& file, const std::vector<std::span<const Mask>>& masks,
                                               const std::vector<DicomSegment>& segments, const Work& work);

/// Writes an image read from `source` in the format of the name; in .dcm and .seg.nrrd with one segment for each label,
/// named as in the source where that names them. In NIfTI these names go into a table.
std::vector<std::string> write_image(const OutputFile& file, const Image& image, const ImageInput& source, const Work& work);

/// Writes a label map as a DICOM segmentation with one segment for each label.
std::vector<std::string> write_labels(const OutputFile& file, const Image& labels, const std::vector<DicomSegment>& segments,
                                      const Work& work);

/// Writes a DICOM segmentation whose segments may overlap.
std::vector<std::string> write_structures(const OutputFile& file, const Structures& structures, const Work& work);

}  // namespace kontur::app
