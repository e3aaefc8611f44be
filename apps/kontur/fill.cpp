// SPDX-License-Identifier: Apache-2.0
#include "fill.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "dicom_output.h"
#include "drawn_on.h"
#include "facts.h"
#include "fill_structures.h"
#include "input_digests.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/base/machine_memory.h"
#include "kontur/io/bytes/atomic_file.h"
#include "labels_on_grid.h"
#include "outputs.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

Provenance provenance_of(const FillCommand& command, const Work& work) {
    const FillOptions& o = command.options;
    std::string options = fmt::format("ends={} jointly={} shape_weight={} smoothing_voxels={} use_image={}", name(o.ends),
                                      o.jointly, o.shape_weight, o.smoothing_voxels, name(o.use_image));
    if (command.on_image) options += " on_image=true";
    for (const std::int64_t label : o.labels) options += fmt::format(" label={}", label);
    return made_by("fill", {{"labels", command.labels.path}, {"image", command.image}}, options, work);
}

/// Whatever can be refused before any work is done.
void check(const FillCommand& command) {
    std::vector<fs::path> inputs{command.labels.path};
    if (!command.image.empty()) inputs.push_back(command.image);
    check_outputs(std::array{command.output, command.report}, inputs);
    check_output_kind(command.output, FileKind::image);
    check_dicom_images(command.output, command.image);
    check_series(command.series, std::array{command.output});
    if (!command.report.empty() && !has_extension(command.report, ".json"))
        throw Error(ErrorKind::unsupported, fmt::format("{} does not end with .json", command.report.string()));
    if (!command.image.empty() && !is_dicom_name(command.output) && command.options.use_image == UseImage::off &&
        !command.on_image)
        throw Error(ErrorKind::invalid_input,
                    "--image is for --use-image auto and for DICOM (.dcm), which refers to images");
}

Facts image_facts(const ImageReport& image) {
    Facts facts;
    visit_facts(image, [&](const char* key, const auto& value) { facts[key] = value; });
    return facts;
}

Facts report_of(const FilledFile& filled, const std::vector<std::string>& warnings, const Provenance& provenance) {
    const FillReport& report = filled.report;
    Facts labels = Facts::array(), seconds = Facts::object();
    for (std::size_t n = 0; n < report.labels.size(); ++n) {
        const FilledLabel& one = report.labels[n];
        labels.push_back({{"label", one.label}});
        if (!filled.names[n].empty()) labels.back()["name"] = filled.names[n];
        labels.back().update({{"slices", one.slices},
                              {"painted_voxels", one.painted_voxels},
                              {"added_voxels", one.added_voxels},
                              {"image", image_facts(one.image)},
                              {"warnings", one.warnings}});
    }
    for (const auto& [stage, time] : report.seconds) seconds[stage] = time;
    return {
        {"version", KONTUR_VERSION}, {"provenance", provenance_facts(provenance)},  {"labels", labels},
        {"warnings", warnings},      {"contested_voxels", report.contested_voxels}, {"closed_voxels", report.closed_voxels},
        {"seconds", seconds},        {"peak_memory_mb", peak_memory_mb()}};
}

std::string slices_of(const FilledLabel& one) {
    std::string text;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (one.slices[axis] > 0)
            text +=
                fmt::format("{}{} across {}", text.empty() ? "" : " and ", counted(one.slices[axis], "slice"), "ijk"[axis]);
    return text;
}

/// What was painted on, where it is to be asked and can be read; else it is said why not.
std::optional<Image> asked_image(const FillCommand& command, const ImageInput& images, const Work& work, Console& console,
                                 std::vector<std::string>& warnings) {
    if (command.image.empty() || command.options.use_image == UseImage::off) return {};
    std::string unused;
    std::optional<Image> image = readable_image(images, work, unused);
    if (!unused.empty()) {
        console.warn(unused);
        warnings.push_back(std::move(unused));
    }
    return image;
}

/// What `fill` makes; errors name the input.
template <class Fill>
auto named(const ImageInput& input, const Fill& fill) {
    try {
        return fill();
    } catch (const Error& error) {
        throw error.with_context(input.path.string());
    }
}

Image painted_on_grid(const ImageInput& input, const ImageInput& images, const Image& labels, const Work& work) {
    check_labels(labels, input);
    ReadImageOptions read = images.options;
    read.frame.reset();  // chosen of the labels
    return named(input, [&] { return slices_on_grid(labels, read_grid(images.path, read, work)); });
}

/// Those that the file gives the labels, which each stand for one structure there.
std::vector<std::string> names_of(const ImageInput& input, const FillReport& report) {
    const std::vector<DicomSegment> segments = named_segments(input);
    std::vector<std::string> names;
    for (const FilledLabel& one : report.labels) {
        const auto known =
            std::find_if(segments.begin(), segments.end(), [&](const auto& s) { return s.number == one.label; });
        names.push_back(known == segments.end() ? "" : known->label);
    }
    return names;
}

}  // namespace

std::string title(const FilledFile& filled, std::size_t n) {
    const std::string& name = filled.names[n];
    return fmt::format("label {}{}", filled.report.labels[n].label, name.empty() ? "" : " (" + name + ")");
}

FilledFile fill_files(const FillCommand& command, Console& console, const Work& work) {
    check(command);
    const ImageInput input{command.labels.path, console.noting(command.labels.options)};
    const ImageInput images{command.image, console.noting(command.labels.options)};
    if (is_dicom_name(command.output))
        for (const std::string& note : frame_of_reference_notes(frame_of_reference_of(input.path), images))
            console.warn(note);
    const bool overlaps = may_overlap(input);
    if (overlaps) check_room_for_overlap(command);
    if (overlaps && command.on_image)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("segments of {} overlap, and --on-image fills one label map", input.path.string()));
    std::vector<std::string> warnings;
    FilledFile file;
    Image filled;
    FilledStructures each;
    const std::optional<Image> image = asked_image(command, images, work, console, warnings);
    if (overlaps) {
        each = named(input, [&] { return fill_structures(input, image ? &*image : nullptr, command.options, work); });
        file.report = each.report;
        for (const DicomSegment& segment : each.structures.segments) file.names.push_back(segment.label);
    } else {
        Image labels = read_labels(input, {}, work);
        if (command.on_image) labels = painted_on_grid(input, images, labels, work);
        Filling filling =
            named(input, [&] { return fill_labels(std::move(labels), image ? &*image : nullptr, command.options, work); });
        filled = std::move(filling.labels);
        file.names = names_of(input, filling.report);
        file.report = std::move(filling.report);
    }
    const Provenance provenance = provenance_of(command, work);
    Outputs outputs;
    outputs.write(command.output, [&](const fs::path& path) {
        const OutputFile output{path, images, command.series, provenance};
        console.note(overlaps ? write_filled(output, each, work) : write_image(output, filled, input, work));
    });
    if (!command.report.empty())
        outputs.write(command.report, [&](const fs::path& path) {
            write_file_atomically(path, to_json_text(report_of(file, warnings, provenance)));
        });
    outputs.commit();
    return file;
}

void run(const FillCommand& command, Console& console) {
    const FilledFile filled = fill_files(command, console, console.work(command.threads));
    const std::vector<FilledLabel>& labels = filled.report.labels;
    std::string text = fmt::format("{}: {}\n", command.output.string(), counted(labels.size(), "label"));
    for (std::size_t n = 0; n < labels.size(); ++n) {
        const FilledLabel& one = labels[n];
        for (const std::string& warning : one.warnings) console.warn(fmt::format("{}: {}", title(filled, n), warning));
        text += fmt::format("{}: painted on {}; {} painted, {} added\n", title(filled, n), slices_of(one),
                            counted(one.painted_voxels, "voxel"), one.added_voxels);
        if (one.image.verdict != ImageVerdict::none) text += fmt::format("{}: {}\n", title(filled, n), sentence(one.image));
    }
    console.print(text);
}

}  // namespace kontur::app
