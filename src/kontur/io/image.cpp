// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "kontur/base/checks.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/bytes/input_file.h"
#include "kontur/io/bytes/text_header.h"
#include "kontur/io/dicom/dicom_phases.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/image_frames.h"
#include "kontur/io/images/frame_choice_error.h"
#include "kontur/io/images/frame_folder.h"
#include "kontur/io/images/gipl.h"
#include "kontur/io/images/image_view.h"
#include "kontur/io/images/metaimage.h"
#include "kontur/io/images/mgh.h"
#include "kontur/io/images/nifti.h"
#include "kontur/io/images/nifti_header.h"
#include "kontur/io/images/nrrd.h"
#include "kontur/shape/whole_labels.h"

namespace kontur {
namespace fs = std::filesystem;
namespace {

enum class Format { unknown, nifti, nrrd, seg_nrrd, metaimage, mgh, gipl, dicom, dicom_seg };

struct NameRule {
    std::string_view suffix;
    Format format;
    bool writable;
};

/// Longer suffixes first.
constexpr NameRule kNameRules[] = {
    {".nii.gz", Format::nifti, true},   {".nii", Format::nifti, true},     {".seg.nrrd", Format::seg_nrrd, true},
    {".nrrd", Format::nrrd, true},      {".nhdr", Format::nrrd, false},    {".mha", Format::metaimage, true},
    {".mhd", Format::metaimage, false}, {".mgz", Format::mgh, true},       {".mgh", Format::mgh, true},
    {".mgh.gz", Format::mgh, true},     {".hdr", Format::nifti, false},    {".hdr.gz", Format::nifti, false},
    {".img", Format::nifti, false},     {".img.gz", Format::nifti, false}, {".gipl", Format::gipl, false},
    {".gipl.gz", Format::gipl, false},  {".dcm", Format::dicom, false},
};

NameRule rule_for(const fs::path& path) {
    const std::string name = lower_case(path.filename().string());
    for (const NameRule& rule : kNameRules)
        if (name.ends_with(rule.suffix)) return rule;
    return {"", Format::unknown, false};
}

/// False, too, for what cannot be reached, which opening it then tells.
bool is_folder(const fs::path& path) {
    std::error_code ignored;
    return fs::is_directory(path, ignored);
}

Format format_by_content(const fs::path& path) {
    if (is_folder(path) || looks_like_dicom(path)) return Format::dicom;
    InputFile file(path);
    if (file.at_gzip()) file.inflate();
    std::array<unsigned char, 10> start{};
    file.read_some(start.data(), start.size());
    const std::string_view text(reinterpret_cast<const char*>(start.data()), start.size());
    if (text.starts_with("NRRD000")) return Format::nrrd;
    if (text.starts_with("ObjectType") || text.starts_with("NDims")) return Format::metaimage;
    return nifti_kind(std::span(start).first<4>()).version ? Format::nifti : Format::unknown;
}

Format readable_format(const fs::path& path) {
    Format format = rule_for(path).format;
    if (format == Format::unknown || is_folder(path)) format = format_by_content(path);
    if (format == Format::unknown)
        throw Error(ErrorKind::unsupported, path.string() +
                                                " has no known image format; known are NIfTI (.nii, .nii.gz, .hdr and "
                                                ".img), NRRD (.nrrd, .nhdr, .seg.nrrd), MetaImage (.mha, .mhd), FreeSurfer "
                                                "(.mgz, .mgh), GIPL (.gipl) and DICOM");
    return format == Format::dicom && is_dicom_seg(path) ? Format::dicom_seg : format;
}

void report(const std::vector<std::string>& notes, const ReadImageOptions& options,
            const std::vector<std::string>& warnings = {}) {
    const auto& warn = options.on_warning ? options.on_warning : options.on_note;
    if (options.on_note)
        for (const std::string& note : notes) options.on_note(note);
    if (warn)
        for (const std::string& warning : warnings) warn(warning);
}

std::map<std::int64_t, std::int64_t> labels_of(const Image& image, const fs::path& path) {
    try {
        return count_labels(image);
    } catch (const Error& error) {
        throw error.with_context(path.string());
    }
}

Image read_segments(const fs::path& path, std::optional<std::int64_t> segment, const ReadImageOptions& options,
                    const Work& work) {
    DicomSeg found = read_dicom_seg(path, segment, options.max_voxels, work);
    report(found.notes, options);
    return std::move(found.labels);
}

bool is_nrrd(const fs::path& path) {
    const Format format = rule_for(path).format;
    return format == Format::nrrd || format == Format::seg_nrrd;
}

/// The voxels of one value, with another one.
Image numbered(const Image& image, std::int64_t value, std::int64_t number) {
    const Mask mask = select_label(image, static_cast<double>(value));
    std::vector<std::int32_t> values(mask.values.size());
    std::transform(mask.values.begin(), mask.values.end(), values.begin(),
                   [number](std::uint8_t inside) { return inside ? static_cast<std::int32_t>(number) : 0; });
    return {image.grid, std::move(values)};
}

/// Overlapping segments of one file can be read one by one only: a label of 3D Slicer's layers says which layer.
Image read_labels(const fs::path& path, std::optional<std::int64_t> label, const ReadImageOptions& options,
                  const Work& work) {
    if (is_dicom_seg(path)) return read_segments(path, label, options, work);
    ReadImageOptions read = options;
    if (read.frame || !is_nrrd(path)) return read_label_image(path, read, work);
    const std::vector<NrrdSegment> segments = read_nrrd_segments(path);
    check_segment_choice(segments, label, path);
    const NrrdSegment* const segment = label ? segment_of_number(segments, *label) : nullptr;
    if (segment) read.frame = segment->layer + 1;
    Image image = read_label_image(path, read, work);
    if (segment && segment->label_value != *label) image = numbered(image, segment->label_value, *label);
    return image;
}

template <typename Value>
Image with_samples_of(const Image& image) {
    const auto& floats = std::get<std::vector<float>>(image.samples);
    std::vector<Value> integers(floats.size());
    std::transform(floats.begin(), floats.end(), integers.begin(), [](float v) { return static_cast<Value>(v); });
    return {image.grid, std::move(integers)};
}

/// A label map of floats in the narrowest integers that hold it.
Image with_integers(const Image& image, const fs::path& path) {
    const std::map<std::int64_t, std::int64_t> labels = labels_of(image, path);
    const std::int64_t low = labels.empty() ? 0 : std::min<std::int64_t>(labels.begin()->first, 0);
    const std::int64_t high = labels.empty() ? 0 : labels.rbegin()->first;
    const auto fits = [&]<typename Value>(Value) {
        return low >= std::numeric_limits<Value>::min() && high <= std::numeric_limits<Value>::max();
    };
    if (fits(std::uint8_t{})) return with_samples_of<std::uint8_t>(image);
    if (fits(std::int16_t{})) return with_samples_of<std::int16_t>(image);
    if (fits(std::uint16_t{})) return with_samples_of<std::uint16_t>(image);
    if (fits(std::int32_t{})) return with_samples_of<std::int32_t>(image);
    throw Error(ErrorKind::unsupported, path.string() + " would have the labels " + std::to_string(low) + " to " +
                                            std::to_string(high) +
                                            "; a segmentation of 3D Slicer has room for integers of 32 bits");
}

template <typename Value>
std::vector<Value> with_value_inside(const Mask& mask, std::int64_t value) {
    std::vector<Value> values(mask.values.size());
    std::transform(mask.values.begin(), mask.values.end(), values.begin(),
                   [inside = static_cast<Value>(value)](std::uint8_t v) { return v ? inside : Value{0}; });
    return values;
}

/// Colours that neighbouring segments are told apart by.
constexpr std::array<std::array<double, 3>, 8> kPalette{{{0.9, 0.7, 0.3},
                                                         {0.3, 0.6, 0.9},
                                                         {0.4, 0.75, 0.4},
                                                         {0.85, 0.4, 0.4},
                                                         {0.65, 0.5, 0.8},
                                                         {0.5, 0.8, 0.8},
                                                         {0.9, 0.55, 0.75},
                                                         {0.6, 0.6, 0.45}}};

std::vector<NrrdSegment> one_segment_each(const std::map<std::int64_t, std::int64_t>& labels,
                                          const std::vector<LabelName>& names) {
    std::vector<NrrdSegment> segments;
    for (const auto& [label, count] : labels) {
        const auto known = std::find_if(names.begin(), names.end(), [&, l = label](const auto& n) { return n.label == l; });
        if (known != names.end()) segments.push_back({known->name, known->color, label, 0, known->tags});
        else segments.push_back({"label " + std::to_string(label), kPalette[segments.size() % kPalette.size()], label, 0});
    }
    return segments;
}

/// Those that the image has.
std::vector<LabelName> names_of_labels(const Image& image, std::vector<LabelName> names) {
    const std::map<std::int64_t, std::int64_t> counts = count_labels(image);
    std::erase_if(names, [&](const LabelName& name) { return !counts.contains(name.label); });
    return names;
}

/// `segments` is asked for only where the format has any.
template <typename Segments>
void write(const fs::path& path, const ImageView& image, const Segments& segments) {
    check_image_name(path);
    switch (rule_for(path).format) {
        case Format::nifti:
            return write_nifti(path, image);
        case Format::nrrd:
            return write_nrrd(path, image);
        case Format::seg_nrrd:
            return write_seg_nrrd(path, image, segments());
        case Format::mgh:
            return write_mgh(path, image);
        default:
            return write_metaimage(path, image);
    }
}

void check_limit(const ReadImageOptions& options) { check_at_least("the limit of voxels", options.max_voxels, 1); }

void check_color(const std::array<double, 3>& color, const std::string& name) {
    constexpr std::array kParts{"red", "green", "blue"};
    for (std::size_t n = 0; n < kParts.size(); ++n)
        check_from_0_to_1(std::string("the ") + kParts[n] + " of segment '" + name + "'", color[n]);
}

/// One file of a folder of frames, without its frame; nullopt: the path is no such folder. Checks the grids of all.
std::optional<std::pair<fs::path, ReadImageOptions>> frame_of_folder(const fs::path& path, const ReadImageOptions& options) {
    if (options.dicom.content || !is_folder(path) || looks_like_dicom(path)) return std::nullopt;
    const std::vector<fs::path> files = checked_frame_files(path, options);
    if (files.empty()) return std::nullopt;
    ReadImageOptions own = options;
    own.frame.reset();
    const auto count = static_cast<std::int64_t>(files.size());
    if (!options.frame && count > 1)
        throw FrameChoiceError(
            fmt::format("{} holds {} images, {} to {}, the frames of one; choose one with the option frame", path.string(),
                        count, files.front().filename().string(), files.back().filename().string()),
            count);
    const std::int64_t frame = options.frame.value_or(1);
    if (frame < 1 || frame > count)
        throw Error(ErrorKind::invalid_input, fmt::format("{} has no frame {}; its {} are 1 to {}", path.string(), frame,
                                                          counted(files.size(), "image"), count));
    return std::pair(files[static_cast<std::size_t>(frame) - 1], own);
}

/// Of the frame that the options name: a volume of the series, or a series that is a phase.
DicomSeriesOptions dicom_of_frame(const fs::path& path, const ReadImageOptions& options, const Work& work) {
    DicomSeriesOptions dicom = options.dicom;
    if (!options.frame || dicom.volume) return dicom;
    const std::vector<DicomSeries> frames = list_dicom_frames(path, dicom, work);
    const std::int64_t frame = *options.frame;
    const auto count = static_cast<std::int64_t>(frames.size());
    if (frame < 1 || frame > count)
        throw Error(ErrorKind::invalid_input, fmt::format("{} has no frame {}; there {} 1 to {}", path.string(), frame,
                                                          count > 1 ? "are" : "is", count));
    if (frames.front().series_uid != frames.back().series_uid)
        dicom.series_uid = frames[static_cast<std::size_t>(frame) - 1].series_uid;
    else dicom.volume = static_cast<int>(frame);
    return dicom;
}

}  // namespace

void check_image_name(const fs::path& path) {
    if (!rule_for(path).writable)
        throw Error(ErrorKind::unsupported,
                    path.string() + " cannot be written; known are .nii, .nii.gz, .nrrd, .seg.nrrd, .mha, .mgz and .mgh");
}

void check_label_value(std::int64_t value) {
    constexpr std::int64_t kMaxLabel = 65535;
    if (value < 1 || value > kMaxLabel)
        throw Error(ErrorKind::invalid_input, "label value " + std::to_string(value) + " cannot be written; 1 to " +
                                                  std::to_string(kMaxLabel) + " can");
}

Image read_image(const fs::path& path, const ReadImageOptions& options, const Work& work) {
    check_limit(options);
    work.check();
    if (const auto frame = frame_of_folder(path, options)) return read_image(frame->first, frame->second, work);
    switch (readable_format(path)) {
        case Format::nifti:
            return read_nifti(path, options, work);
        case Format::nrrd:
        case Format::seg_nrrd:
            return read_nrrd(path, options, work);
        case Format::metaimage:
            return read_metaimage(path, options, work);
        case Format::mgh:
            return read_mgh(path, options, work);
        case Format::gipl:
            return read_gipl(path, options, work);
        case Format::dicom_seg:
            return read_segments(path, {}, options, work);
        default:
            break;
    }
    DicomVolume volume = read_dicom_series(path, dicom_of_frame(path, options, work), work);
    report(volume.notes, options, volume.warnings);
    return std::move(volume.image);
}

Image read_label_image(const fs::path& path, const ReadImageOptions& options, const Work& work) {
    Image image = read_image(path, options, work);
    if (const std::size_t rounded = round_to_labels(image); rounded > 0)
        report({fmt::format("{}: the values of {} are no integers but lie within {:g} of one; they are rounded",
                            path.string(), counted(rounded, "voxel"), kLabelTolerance)},
               options);
    return image;
}

Grid read_grid(const fs::path& path, const ReadImageOptions& options, const Work& work) {
    check_limit(options);
    work.check();
    if (const auto frame = frame_of_folder(path, options)) return read_grid(frame->first, frame->second, work);
    switch (readable_format(path)) {
        case Format::nifti:
            return read_nifti_grid(path, options);
        case Format::nrrd:
        case Format::seg_nrrd:
            return read_nrrd_grid(path, options);
        case Format::metaimage:
            return read_metaimage_grid(path, options);
        case Format::mgh:
            return read_mgh_grid(path, options);
        case Format::gipl:
            return read_gipl_grid(path, options);
        case Format::dicom_seg:
            return read_dicom_segmentation(path, options.max_voxels).grid;
        default:
            break;
    }
    const DicomGrid volume = read_dicom_grid(path, dicom_of_frame(path, options, work), work);
    report(volume.notes, options, volume.warnings);
    return volume.grid;
}

Mask read_mask(const fs::path& path, std::optional<std::int64_t> label, const ReadImageOptions& options, const Work& work) {
    check_limit(options);
    const Image image = read_labels(path, label, options, work);
    return select_mask(image, label, path.string());
}

void write_mask(const fs::path& path, const Mask& mask, const LabelName& label, const Provenance& provenance) {
    check_mask(mask);
    const std::int64_t value = label.label;
    check_label_value(value);
    check_color(label.color, label.name);
    const auto segment = [&] { return std::vector{NrrdSegment{label.name, label.color, value, 0, label.tags}}; };
    const auto write_view = [&](ImageView view) {
        view.provenance = provenance;
        write(path, view, segment);
    };
    const bool has_zeros_and_ones = std::ranges::all_of(mask.values, [](std::uint8_t v) { return v <= 1; });
    if (value == 1 && has_zeros_and_ones) write_view(mask);
    else if (value <= 255) write_view(Image{mask.grid, with_value_inside<std::uint8_t>(mask, value)});
    else write_view(Image{mask.grid, with_value_inside<std::uint16_t>(mask, value)});
}

void write_image(const fs::path& path, const Image& image, const std::vector<LabelName>& names,
                 const Provenance& provenance) {
    check_image(image);
    for (const LabelName& name : names) check_color(name.color, name.name);
    const auto write_view = [&](ImageView view) {
        view.provenance = provenance;
        if (!names.empty() && rule_for(path).format == Format::nifti) view.labels = names_of_labels(image, names);
        write(path, view, [&] { return one_segment_each(labels_of(image, path), names); });
    };
    const bool has_floats = std::holds_alternative<std::vector<float>>(image.samples);
    if (has_floats && rule_for(path).format == Format::seg_nrrd) write_view(with_integers(image, path));
    else write_view(image);
}

}  // namespace kontur
