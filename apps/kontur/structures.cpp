// SPDX-License-Identifier: Apache-2.0
#include "structures.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/image.h"
#include "kontur/io/images/nifti_extensions.h"
#include "kontur/io/images/nrrd.h"
#include "kontur/io/images/segment_tags.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

DicomSegment to_dicom(const NrrdSegment& segment, std::int64_t number) {
    const SegmentTerms terms = terms_in_tags(segment.tags);
    return {.number = number,
            .label = segment.name,
            .color = to_rgb8(segment.color),
            .category = terms.category,
            .code = terms.code};
}

std::vector<NrrdSegment> nrrd_segments(const fs::path& path) {
    return has_extension(path, ".nrrd") ? read_nrrd_segments(path) : std::vector<NrrdSegment>{};
}

bool has_layers(const std::vector<NrrdSegment>& segments) {
    return std::any_of(segments.begin(), segments.end(), [](const NrrdSegment& s) { return s.layer != 0; });
}

/// Segments of several layers, each of which is a label map.
Structures read_layers(const ImageInput& input, const std::vector<NrrdSegment>& segments, const Work& work) {
    std::map<std::int64_t, Image> layers;
    Structures found;
    const std::vector<std::int64_t> numbers = segment_numbers(segments);
    for (std::size_t n = 0; n < segments.size(); ++n) {
        const NrrdSegment& segment = segments[n];
        if (!layers.contains(segment.layer)) {
            ReadImageOptions options = input.options;
            options.frame = segment.layer + 1;
            layers.emplace(segment.layer, read_label_image(input.path, options, work));
        }
        found.segments.push_back(to_dicom(segment, numbers[n]));
        found.tags.push_back(segment.tags);
        found.masks.push_back(select_label(layers.at(segment.layer), static_cast<double>(segment.label_value)));
    }
    return found;
}

/// A segment without voxels cannot be written, and says nothing.
Structures without_empty(Structures found, const ImageInput& input) {
    Structures kept;
    for (std::size_t s = 0; s < found.masks.size(); ++s) {
        const std::vector<std::uint8_t>& values = found.masks[s].values;
        if (std::find(values.begin(), values.end(), 1) == values.end()) {
            input.options.on_note(fmt::format("the segment '{}' has no voxels and is left out", found.segments[s].label));
            continue;
        }
        kept.segments.push_back(std::move(found.segments[s]));
        kept.masks.push_back(std::move(found.masks[s]));
        if (s < found.tags.size()) kept.tags.push_back(std::move(found.tags[s]));
    }
    return kept;
}

/// "liver" for folder/liver.nii.gz.
std::string stem(const fs::path& path) {
    const std::string name = path.filename().string();
    return printable_utf8(name.substr(0, name.find('.', 1)));
}

/// As masks of several labels have them in .seg.nrrd.
constexpr std::array<std::array<std::uint8_t, 3>, 8> kColors{{kStructureColor,
                                                              {77, 153, 230},
                                                              {102, 191, 102},
                                                              {217, 102, 102},
                                                              {166, 128, 204},
                                                              {128, 204, 204},
                                                              {230, 140, 191},
                                                              {153, 153, 115}}};

}  // namespace

std::array<std::uint8_t, 3> structure_color(std::size_t n) { return kColors[n % kColors.size()]; }

Image read_labels(const ImageInput& input, std::optional<std::int64_t> label, const Work& work) {
    if (label && is_dicom_seg(input.path)) {
        DicomSeg found = read_dicom_seg(input.path, label, input.options.max_voxels, work);
        for (const std::string& note : found.notes) input.options.on_note(note);
        return std::move(found.labels);
    }
    ReadImageOptions options = input.options;
    std::optional<std::int64_t> value;
    if (label && !options.frame) {
        const std::vector<NrrdSegment> segments = nrrd_segments(input.path);
        check_segment_choice(segments, label, input.path);
        if (const NrrdSegment* const segment = segment_of_number(segments, *label)) {
            options.frame = segment->layer + 1;
            value = segment->label_value;
        }
    }
    Image image = read_label_image(input.path, options, work);
    if (!label) return image;
    if (!count_labels(image).contains(value.value_or(*label)))
        throw Error(ErrorKind::invalid_input, fmt::format("{} has no label {}", input.path.string(), *label));
    const std::int64_t stored = value.value_or(*label);
    const auto keep = [&]<class Sample>(std::vector<Sample>& samples) {
        for (Sample& sample : samples)
            sample = static_cast<std::int64_t>(sample) == stored ? static_cast<Sample>(*label) : Sample{0};
    };
    std::visit(keep, image.samples);
    return image;
}

std::vector<DicomSegment> named_segments(const ImageInput& source) {
    if (is_dicom_seg(source.path)) return read_dicom_segmentation(source.path).segments;
    std::vector<DicomSegment> segments;
    for (const LabelName& name : label_names(source)) {
        segments.push_back(to_dicom({name.name, name.color, name.label, 0, name.tags}, name.label));
    }
    return segments;
}

std::vector<LabelName> label_names(const ImageInput& source) {
    std::vector<LabelName> names;
    const auto add = [&](const DicomSegment& segment, std::string tags) {
        const auto color = segment.color.value_or(kStructureColor);
        names.push_back({segment.number, segment.label, to_levels(color), std::move(tags)});
    };
    if (is_dicom_seg(source.path)) {
        for (const DicomSegment& segment : read_dicom_segmentation(source.path).segments)
            add(segment, tags_of_terms(attributes_of(segment)));
        return names;
    }
    if (has_extension(source.path, ".nii") || has_extension(source.path, ".nii.gz")) {
        return read_nifti_labels(source.path);
    }
    const std::vector<NrrdSegment> segments = nrrd_segments(source.path);
    const std::vector<std::int64_t> numbers = segment_numbers(segments);
    for (std::size_t n = 0; n < segments.size(); ++n)
        if (!source.options.frame || segments[n].layer + 1 == *source.options.frame)
            add(to_dicom(segments[n], source.options.frame ? segments[n].label_value : numbers[n]), segments[n].tags);
    return names;
}

void check_labels(const Image& image, const ImageInput& source) {
    try {
        count_labels(image);
    } catch (const Error& error) {
        throw error.with_context(source.path.string());
    }
}

std::vector<DicomSegment> segments_of(const Image& image, const ImageInput& source) {
    check_labels(image, source);
    const std::vector<DicomSegment> named = named_segments(source);
    std::vector<DicomSegment> segments;
    for (const auto& [label, voxels] : count_labels(image)) {
        const auto known = std::find_if(named.begin(), named.end(), [&, l = label](const auto& s) { return s.number == l; });
        if (known != named.end()) segments.push_back(*known);
        else
            segments.push_back(
                {.number = label, .label = fmt::format("label {}", label), .color = structure_color(segments.size())});
    }
    return segments;
}

Image label_map(const Mask& mask, std::int64_t label) {
    std::vector<std::uint16_t> labels(mask.values.size());
    std::transform(mask.values.begin(), mask.values.end(), labels.begin(),
                   [label](std::uint8_t v) { return static_cast<std::uint16_t>(v != 0 ? label : 0); });
    if (label <= 255) return {mask.grid, std::vector<std::uint8_t>(labels.begin(), labels.end())};
    return {mask.grid, std::move(labels)};
}

std::string tags_of(const Structures& structures, std::size_t n) {
    return n < structures.tags.size() ? structures.tags[n] : tags_of_terms(attributes_of(structures.segments[n]));
}

bool has_label_names(const fs::path& output) {
    return has_extension(output, ".seg.nrrd") || has_extension(output, ".nii") || has_extension(output, ".nii.gz");
}

bool has_room_for_overlap(const fs::path& output) { return is_dicom_name(output) || has_extension(output, ".seg.nrrd"); }

bool may_overlap(const ImageInput& input) {
    if (!is_dicom_seg(input.path)) return !input.options.frame && has_layers(nrrd_segments(input.path));
    const auto segments = read_dicom_segmentation(input.path).segments;
    return std::any_of(segments.begin(), segments.end(), [](const DicomSegment& s) { return s.shared_voxels > 0; });
}

Structures read_structures(const ImageInput& input, const Work& work) {
    if (is_dicom_seg(input.path)) {
        DicomSegments found = read_dicom_segments(input.path, input.options.max_voxels, work);
        for (const std::string& note : found.about.notes) input.options.on_note(note);
        return without_empty({std::move(found.about.segments), std::move(found.masks)}, input);
    }
    if (may_overlap(input)) return without_empty(read_layers(input, nrrd_segments(input.path), work), input);
    const Image image = read_label_image(input.path, input.options, work);
    const std::vector<DicomSegment> named = named_segments(input);
    Structures found{segments_of(image, input), {}};
    for (DicomSegment& segment : found.segments) {
        found.masks.push_back(select_label(image, static_cast<double>(segment.number)));
        if (named.empty())
            segment.label =
                found.segments.size() == 1 ? stem(input.path) : fmt::format("{} label {}", stem(input.path), segment.number);
    }
    return found;
}

}  // namespace kontur::app
