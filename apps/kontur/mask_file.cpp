// SPDX-License-Identifier: Apache-2.0
#include "mask_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "contour_files.h"
#include "dicom_output.h"
#include "in_faults_of.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/correct/put_label.h"
#include "kontur/extract/mesh_mask.h"
#include "kontur/extract/rasterize.h"
#include "kontur/io/contours/contour_json.h"
#include "kontur/io/image.h"
#include "kontur/io/meshes/mesh.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

/// Of the file alone, for a mask that has no voxels of its own.
MaskFile one_structure(Mask mask, const std::string& name, const StructureAttributes& attributes) {
    MaskFile file{std::move(mask)};
    DicomSegment segment = fitted_segment(attributes);
    segment.label = name;
    segment.algorithm_name = "";
    file.structures.segments.push_back(std::move(segment));
    file.structures.masks.emplace_back();
    return file;
}

void check_not_empty(const Mask& mask, const fs::path& path, const fs::path& image) {
    if (std::find(mask.values.begin(), mask.values.end(), 1) == mask.values.end())
        throw Error(ErrorKind::invalid_input, fmt::format("no voxel of {} lies within {}", image.string(), path.string()));
}

void check_filled_slices(const Mask& mask) {
    const FilledSlices slices = filled_slices(mask);
    if (slices.filled < slices.extent)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("its contours fill {} of the {} slices from the first to the last; kontur segment makes a "
                                "mask of them, which can be corrected then",
                                slices.filled, slices.extent));
}

MaskFile of_contours(const CorrectCommand& command, const Grid& grid, Console& console) {
    const fs::path& path = command.mask.path;
    ReadContours read = read_contours(path, {.roi = command.mask_roi});
    console.note(read.notes);
    return in_faults_of(path, [&] {
        Mask mask = rasterize(read.contours, grid);
        check_filled_slices(mask);
        check_not_empty(mask, path, command.image);
        return one_structure(std::move(mask), read.contours.name, read.contours.attributes);
    });
}

MaskFile of_mesh(const CorrectCommand& command, const Grid& grid, Console& console, const Work& work) {
    const fs::path& path = command.mask.path;
    MeshMask inside = in_faults_of(path, [&] { return voxelize_mesh(read_mesh(path), grid, work); });
    check_not_empty(inside.mask, path, command.image);
    if (inside.is_cut)
        console.warn(fmt::format("{} reaches beyond {} and is cut off there", path.string(), command.image.string()));
    return one_structure(std::move(inside.mask), path.stem().string(), {});
}

/// One of several segments that may overlap.
MaskFile of_segment(const CorrectCommand& command, const ImageInput& input, const Work& work) {
    if (!command.label)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("segments of {} overlap; choose the one to correct with --label", input.path.string()));
    MaskFile file;
    file.structures = read_structures(input, work);
    const auto& segments = file.structures.segments;
    const auto at =
        std::find_if(segments.begin(), segments.end(), [&](const auto& s) { return s.number == *command.label; });
    if (at == segments.end())
        throw Error(ErrorKind::invalid_input, fmt::format("{} has no label {}", input.path.string(), *command.label));
    file.label = *command.label;
    file.chosen = static_cast<std::size_t>(at - segments.begin());
    file.mask = std::move(file.structures.masks[file.chosen]);
    return file;
}

MaskFile of_labels(const CorrectCommand& command, const ImageInput& input, const Work& work) {
    MaskFile file;
    file.labels = read_labels(input, {}, work);
    check_labels(file.labels, input);
    file.mask = select_mask(file.labels, command.label, input.path.string());
    const auto inside = std::find_if(file.mask.values.begin(), file.mask.values.end(), [](auto v) { return v != 0; });
    if (inside != file.mask.values.end())
        file.label =
            static_cast<std::int64_t>(sample(file.labels, static_cast<std::size_t>(inside - file.mask.values.begin())));
    return file;
}

/// One for each label that loses or gets some.
std::vector<std::string> sentences_of(const std::vector<PassedVoxels>& passed, std::int64_t corrected) {
    std::vector<std::string> sentences;
    for (const auto& [from, to, count] : passed)
        sentences.push_back(to == corrected
                                ? fmt::format("label {} loses {} to label {}", from, counted(count, "voxel"), to)
                                : fmt::format("label {} gets {} of label {}", to, counted(count, "voxel"), from));
    return sentences;
}

/// Who made it before, and what corrected it.
void name_algorithm(DicomSegment& segment) {
    constexpr std::size_t kMostBytes = 64;
    const std::string here = "kontur correct";
    segment.algorithm_type = "SEMIAUTOMATIC";
    const std::string both = segment.algorithm_name + " + " + here;
    segment.algorithm_name = segment.algorithm_name.empty() || both.size() > kMostBytes ? here : both;
}

}  // namespace

ImageInput image_of(const CorrectCommand& command, Console& console) {
    ReadImageOptions read = command.mask.options;
    read.frame.reset();
    return {command.image, console.noting(read)};
}

MaskFile read_mask_file(const CorrectCommand& command, Console& console, const Work& work) {
    const ImageInput input{command.mask.path, console.noting(command.mask.options)};
    const FileKind kind = input_kind(input.path);
    if (kind != FileKind::image) {
        const ImageInput image = image_of(command, console);
        const Grid grid = read_grid(image.path, image.options, work);
        return kind == FileKind::mesh ? of_mesh(command, grid, console, work) : of_contours(command, grid, console);
    }
    return may_overlap(input) ? of_segment(command, input, work) : of_labels(command, input, work);
}

ReadCorrections read_corrections(const std::vector<fs::path>& paths, const ReadContoursOptions& options) {
    ReadCorrections found;
    Corrections& corrections = found.corrections;
    ContourSet& all = corrections.drawing;
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    for (const fs::path& path : paths) {
        ReadContours read = read_contours(path, options);
        append(found.notes, read.notes);
        check_each_contour(path, read.contours);
        if (has_extension(path, ".json") && !has_extension(path, ".mrk.json"))
            append(corrections.confirmed, read_confirmed_planes_json(path));
        if (&path == &paths.front()) {
            all = std::move(read.contours);
            continue;
        }
        append(all.contours, read.contours.contours);
        append(all.interior, read.contours.interior);
        append(all.exterior, read.contours.exterior);
        append(all.empty_planes, read.contours.empty_planes);
    }
    return found;
}

std::vector<std::string> put(MaskFile& file, const CorrectedMask& corrected, bool shared_borders, const Work& work) {
    if (!file.structures.segments.empty()) {
        file.structures.masks[file.chosen] = corrected.mask;
        return {};
    }
    PutLabel map = put_label(std::move(file.labels), {file.label, file.mask, corrected.mask}, shared_borders, work);
    file.labels = std::move(map.labels);
    return sentences_of(map.passed, file.label);
}

std::vector<std::string> write_mask_file(const fs::path& path, const MaskFile& file, const CorrectCommand& command,
                                         const Provenance& provenance, Console& console) {
    const ImageInput images = image_of(command, console), source{command.mask.path, console.noting(command.mask.options)};
    const OutputFile output{path, images, command.series, provenance};
    const Work work = console.work(command.threads);
    if (file.structures.segments.empty()) {
        if (!is_dicom_name(path)) return write_image(output, file.labels, source, work);
        std::vector<DicomSegment> segments = segments_of(file.labels, source);
        for (DicomSegment& segment : segments)
            if (segment.number == file.label) name_algorithm(segment);
        return in_faults_of(source.path, [&] { return write_labels(output, file.labels, segments, work); });
    }
    Structures structures = file.structures;
    DicomSegment& segment = structures.segments[file.chosen];
    name_algorithm(segment);
    if (has_room_for_overlap(path))
        return in_faults_of(source.path, [&] { return write_structures(output, structures, work); });
    const LabelName name{file.label, segment.label, to_levels(segment.color.value_or(kStructureColor)),
                         tags_of(structures, file.chosen)};
    kontur::write_image(path, label_map(structures.masks[file.chosen], file.label), {name}, provenance);
    return {};
}

}  // namespace kontur::app
