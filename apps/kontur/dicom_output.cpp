// SPDX-License-Identifier: Apache-2.0
#include "dicom_output.h"

#include <fmt/format.h>

#include <algorithm>

#include "in_faults_of.h"
#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/contours.h"
#include "kontur/io/dicom/dicom_phases.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/images/nrrd.h"
#include "kontur/io/images/segment_tags.h"
#include "kontur/labels/scattered.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

/// Also tells `on_warning` what the reader doubts; its notes are said where the images are read for more than this.
DicomSeries series_of(const ImageInput& images) {
    DicomGrid found = read_dicom_grid(images.path, images.options.dicom);
    if (images.options.on_warning)
        for (const std::string& warning : found.warnings) images.options.on_warning(warning);
    return std::move(found.series);
}

WriteDicomSegOptions seg_options(const SeriesWords& series, const Provenance& provenance) {
    WriteDicomSegOptions options;
    options.series_number = series.number;
    if (!series.description.empty()) options.series_description = series.description;
    options.provenance = provenance;
    return options;
}

std::string text_of(const Provenance& provenance) {
    std::string text;
    for (const auto& [name, value] : provenance) text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", name, value);
    return text;
}

/// What makes a fit reproducible.
std::string parameters(const SegmentReport& report, const Provenance& provenance) {
    return fmt::format("contours={} points={}; {}", report.contours, report.points, text_of(provenance));
}

}  // namespace

void check_dicom_images(const fs::path& output, const fs::path& images) {
    if (!is_dicom_name(output)) return;
    if (images.empty())
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} would refer to the DICOM images it was made on; give their folder with --image",
                                output.string()));
    if (!looks_like_dicom(images))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} is no DICOM series, to which {} could refer", images.string(), output.string()));
}

void check_holes(const std::optional<HoleEncoding>& holes, bool is_rtstruct) {
    if (holes && !is_rtstruct)
        throw Error(ErrorKind::invalid_input, "--holes says how an RTSTRUCT stores holes, and none is written");
}

void check_series(const SeriesWords& series, std::span<const fs::path> outputs) {
    constexpr std::size_t kMostBytes = 64;
    if (series.number == 0 && series.description.empty()) return;
    if (std::none_of(outputs.begin(), outputs.end(), is_dicom_name))
        throw Error(ErrorKind::invalid_input, "--series-number and --series-description are for DICOM (.dcm)");
    check_utf8(series.description, "--series-description");
    if (series.description.size() > kMostBytes)
        throw Error(ErrorKind::invalid_input, fmt::format("--series-description has {} bytes; DICOM has room for {}",
                                                          series.description.size(), kMostBytes));
}

WriteRtstructOptions rtstruct_options(const std::optional<HoleEncoding>& holes, const SeriesWords& series,
                                      const Provenance& provenance) {
    WriteRtstructOptions options;
    options.series_number = series.number;
    if (!series.description.empty()) options.series_description = series.description;
    options.holes = holes.value_or(options.holes);
    options.provenance = provenance;
    return options;
}

std::string frame_of_reference_of(const fs::path& mask) {
    return is_dicom_seg(mask) ? read_dicom_segmentation(mask).frame_of_reference_uid : "";
}

std::string frame_of_reference_of(const ImageInput& images) {
    if (images.path.empty() || !looks_like_dicom(images.path)) return "";
    return is_dicom_seg(images.path) ? frame_of_reference_of(images.path) : series_of(images).frame_of_reference_uid;
}

std::vector<std::string> frame_of_reference_notes(const std::string& uid, const ImageInput& images) {
    if (uid.empty()) return {};
    const std::string other = frame_of_reference_of(images);
    if (other.empty() || other == uid) return {};
    return {
        fmt::format("what was drawn lies in the frame of reference {}, the images in {}; it may not fit them", uid, other)};
}

std::vector<std::string> write_contours(const fs::path& path, const ContourSet& set, const ImageInput& images,
                                        const WriteRtstructOptions& options) {
    const auto has_moment = [](const Contour& contour) { return contour.frame || contour.time_s; };
    const bool keeps_moments = has_extension(path, ".json") && !has_extension(path, ".mrk.json");
    std::vector<std::string> notes;
    if (!keeps_moments && std::ranges::any_of(set.contours, has_moment))
        notes.push_back(
            fmt::format("{} has no room for the frame or time of contours, which is left out; kontur's .json has",
                        path.filename().string()));
    if (!is_dicom_name(path)) {
        kontur::write_contours(path, set, options.provenance);
        return notes;
    }
    Roi roi;
    roi.name = set.name;
    roi.contours = set;
    if (!set.attributes.color) roi.contours.attributes.color = kStructureColor;
    for (std::string& note : write_rtstruct(path, {"kontur", {roi}}, series_of(images), options))
        notes.push_back(std::move(note));
    return notes;
}

std::vector<std::string> write_contours_of_all(const fs::path& path, const std::vector<ContourSet>& sets,
                                               const ImageInput& images, const WriteRtstructOptions& options) {
    StructureSet all{"kontur", {}};
    for (const ContourSet& set : sets) {
        Roi& roi = all.rois.emplace_back();
        roi.name = set.name;
        roi.contours = set;
    }
    return write_rtstruct(path, all, series_of(images), options);
}

std::vector<std::string> write_mask(const OutputFile& file, const Segmentation& result,
                                    const StructureAttributes& attributes, const LabelName& label, const Work& work) {
    const auto& [path, images, series, provenance] = file;
    if (!is_dicom_name(path)) {
        LabelName with_tags = label;
        with_tags.tags = tags_of_terms(attributes);
        kontur::write_mask(path, result.mask, with_tags, provenance);
        return {};
    }
    DicomSegment segment = fitted_segment(attributes);
    segment.label = label.name;
    segment.color = to_rgb8(label.color);
    const DicomAlgorithm algorithm{"kontur variational interpolation", KONTUR_VERSION,
                                   parameters(result.report, provenance)};
    WriteDicomSegOptions write = seg_options(series, provenance);
    write.algorithm = algorithm;
    return write_dicom_seg(path, {{result.mask.grid, result.mask.values}, {segment}}, series_of(images), write, work);
}

std::vector<std::string> write_masks_over_time(const OutputFile& file, const std::vector<std::span<const Mask>>& masks,
                                               const std::vector<DicomSegment>& segments, const Work& work) {
    const auto& [path, images, series, provenance] = file;
    WriteDicomSegOptions write = seg_options(series, provenance);
    write.algorithm = {"kontur variational interpolation over time", KONTUR_VERSION, text_of(provenance)};
    const std::vector<DicomSeries> volumes = list_dicom_frames(images.path, images.options.dicom, work);
    return write_dicom_seg_over_time(path, {masks, segments, volumes}, write, work);
}

std::vector<std::string> write_image(const OutputFile& file, const Image& image, const ImageInput& source,
                                     const Work& work) {
    const auto& [path, images, series, provenance] = file;
    if (!is_dicom_name(path)) {
        if (has_extension(path, ".seg.nrrd")) check_labels(image, source);
        kontur::write_image(path, image, has_label_names(path) ? label_names(source) : std::vector<LabelName>{}, provenance);
        return {};
    }
    const std::vector<DicomSegment> segments = segments_of(image, source);
    check_no_image(image, segments.size());
    return in_faults_of(source.path, [&] { return write_labels(file, image, segments, work); });
}

std::vector<std::string> write_labels(const OutputFile& file, const Image& labels, const std::vector<DicomSegment>& segments,
                                      const Work& work) {
    return write_dicom_seg(file.path, {labels, segments}, series_of(file.images), seg_options(file.series, file.provenance),
                           work);
}

std::vector<std::string> write_structures(const OutputFile& file, const Structures& structures, const Work& work) {
    const auto& [path, images, series, provenance] = file;
    if (!is_dicom_name(path)) {
        std::vector<NrrdSegment> segments;
        for (std::size_t n = 0; n < structures.segments.size(); ++n) {
            const DicomSegment& one = structures.segments[n];
            segments.push_back({.name = one.label, .color = to_levels(one.color.value_or(structure_color(n)))});
            segments.back().tags = tags_of(structures, n);
        }
        write_seg_nrrd_masks(path, structures.masks, segments, provenance);
        return {};
    }
    return write_dicom_seg_masks(path, {structures.masks, structures.segments}, series_of(images),
                                 seg_options(series, provenance), work);
}

}  // namespace kontur::app
