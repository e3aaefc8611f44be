// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "contour_files.h"
#include "dicom_output.h"
#include "in_faults_of.h"
#include "input_digests.h"
#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/extract/mesh_mask.h"
#include "kontur/io/contours_in_time.h"
#include "kontur/io/dicom/dicom_phases.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/image.h"
#include "kontur/io/image_frames.h"
#include "kontur/io/meshes/mesh.h"
#include "labels_on_grid.h"
#include "outputs.h"
#include "structures.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

const char* words(FileKind kind) {
    switch (kind) {
        case FileKind::image:
            return "an image";
        case FileKind::contours:
            return "contours";
        case FileKind::mesh:
            break;
    }
    return "a mesh";
}

/// The command that does what was asked of convert.
const char* advice(FileKind from, FileKind to) {
    if (from == FileKind::contours) return "kontur segment makes masks and meshes from contours";
    if (from == FileKind::mesh) return "kontur makes masks of meshes, which kontur trace cuts into contours";
    if (to == FileKind::contours) return "kontur trace cuts a mask into contours";
    return "kontur trace cuts a mask into contours, of which kontur segment makes a mesh";
}

/// A surface whose inside becomes a mask.
bool makes_mask(FileKind from, const fs::path& output) {
    return from == FileKind::mesh && output_kind(output).value_or(FileKind::image) == FileKind::image;
}

/// What is converted; it stays what it is, but for a mesh that becomes a mask.
FileKind check_kinds(const ConvertCommand& command) {
    const std::optional<FileKind> to = output_kind(command.output);
    const FileKind from = input_kind(command.input.path);
    if (from == to || !to || makes_mask(from, command.output)) return from;
    throw Error(ErrorKind::unsupported,
                fmt::format("{} holds {} and cannot be converted to {} in {}; {}", command.input.path.string(), words(from),
                            words(*to), command.output.string(), advice(from, *to)));
}

Provenance provenance_of(const ConvertCommand& command, const Work& work) {
    std::vector<std::pair<std::string, fs::path>> inputs{{"source", command.input.path}};
    for (const fs::path& path : command.more) inputs.emplace_back(fmt::format("source_{}", inputs.size() + 1), path);
    if (!is_dicom_name(command.output)) inputs.emplace_back("image", command.image);
    std::string options = command.contours.roi ? fmt::format("roi={}", *command.contours.roi) : "";
    if (command.contours.curves == Curves::polygon) options += options.empty() ? "curves=polygon" : " curves=polygon";
    if (command.label) options = fmt::format("label={}", *command.label);
    return made_by("convert", inputs, options, work);
}

/// All structures of all inputs.
Structures structures_of(const ConvertCommand& command, Console& console) {
    Structures all;
    std::vector<fs::path> paths{command.input.path};
    paths.insert(paths.end(), command.more.begin(), command.more.end());
    for (const fs::path& path : paths) {
        Structures some = read_structures({path, console.noting(command.input.options)}, console.work());
        for (std::size_t n = 0; n < some.segments.size(); ++n) all.tags.push_back(tags_of(some, n));
        std::move(some.segments.begin(), some.segments.end(), std::back_inserter(all.segments));
        std::move(some.masks.begin(), some.masks.end(), std::back_inserter(all.masks));
    }
    return all;
}

/// In ml, of what is not 0.
double volume_ml(const Image& labels) {
    double voxels = 0;
    for (const auto& [label, count] : count_labels(labels)) voxels += static_cast<double>(count);
    return voxels * labels.grid.voxel_volume_mm3() / 1000;
}

/// Says what the nearest voxels make of the volume, where that is another one.
Image on_grid_of(const Image& labels, const ImageInput& source, const ImageInput& image, Console& console) {
    check_labels(labels, source);
    ReadImageOptions read = image.options;
    read.frame.reset();  // chosen of the labels
    Image fitted = labels_on_grid(labels, read_grid(image.path, read, console.work()));
    const double before = volume_ml(labels), after = volume_ml(fitted);
    if (std::abs(before - after) > 1e-6 * before)
        console.warn(fmt::format("on the grid of {} the labels have {:.4g} ml in place of {:.4g} ml", image.path.string(),
                                 after, before));
    return fitted;
}

void convert_image(const ConvertCommand& command, const fs::path& output, const Provenance& provenance, Console& console) {
    const ImageInput input{command.input.path, console.noting(command.input.options)};
    const ImageInput images{command.image, console.noting(command.input.options)};
    if (is_dicom_name(output))
        for (const std::string& note : frame_of_reference_notes(frame_of_reference_of(command.input.path), images))
            console.warn(note);
    const bool by_itself = !command.more.empty() || (!command.label && may_overlap(input));
    if (by_itself && !command.image.empty() && !is_dicom_name(output))
        throw Error(ErrorKind::unsupported,
                    fmt::format("segments of {} overlap, and --image moves one label map at a time to its grid; choose one "
                                "with --label",
                                command.input.path.string()));
    if (by_itself && has_room_for_overlap(output)) {
        const Structures all = structures_of(command, console);
        const auto write = [&] {
            return write_structures({output, images, command.series, provenance}, all, console.work());
        };
        return console.note(command.more.empty() ? in_faults_of(input.path, write) : write());
    }
    if (by_itself && !is_dicom_seg(input.path))  // of which the reader says which
        throw Error(ErrorKind::invalid_input,
                    fmt::format("segments of {} overlap, and {} has room for one in a voxel; write a SEG (.dcm) or "
                                ".seg.nrrd, or choose one with --label",
                                command.input.path.string(), command.output.string()));
    const bool onto_grid = !command.image.empty() && !is_dicom_name(output);
    const bool as_it_is = !command.label && !has_room_for_overlap(output) && !onto_grid;
    const Image image =
        as_it_is ? read_image(input.path, input.options, console.work()) : read_labels(input, command.label, console.work());
    console.note(write_image({output, images, command.series, provenance},
                             onto_grid ? on_grid_of(image, input, images, console) : image, input, console.work()));
}

void convert_to_mask(const ConvertCommand& command, const fs::path& output, const Provenance& provenance, Console& console) {
    const ImageInput images{command.image, console.noting(command.input.options)};
    const fs::path& path = command.input.path;
    MeshMask inside = in_faults_of(path, [&] {
        return voxelize_mesh(read_mesh(path), read_grid(images.path, images.options, console.work()), console.work());
    });
    if (std::ranges::count(inside.mask.values, 1) == 0)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("no voxel of {} lies within {}", command.image.string(), path.string()));
    if (inside.is_cut)
        console.warn(fmt::format("{} reaches beyond {} and is cut off there", path.string(), command.image.string()));
    if (!has_room_for_overlap(output)) return write_mask(output, inside.mask, {}, provenance);
    Structures one;
    one.segments.push_back({.label = printable_utf8(path.stem().string()), .color = kStructureColor});
    one.masks.push_back(std::move(inside.mask));
    console.note(write_structures({output, images, command.series, provenance}, one, console.work()));
}

/// Kontur's own .json, which has room for the frame of contours.
bool keeps_frames(const fs::path& output) { return has_extension(output, ".json") && !has_extension(output, ".mrk.json"); }

/// Contours that refer to slices of one frame of the images get that one.
bool has_frames(const ConvertCommand& command) {
    return !command.image.empty() && keeps_frames(command.output) && is_rtstruct(command.input.path);
}

/// The images; of several frames the first.
ImageInput shown_in(const ConvertCommand& command, Console& console) {
    const ImageInput images{command.image, console.noting(command.input.options)};
    if (!has_frames(command)) return images;
    return source_of_frame(images, read_image_frames(images.path, images.options, console.work()), 1);
}

ReadContours read_drawn(const ConvertCommand& command, const ImageInput& images) {
    const fs::path& path = command.input.path;
    if (!has_frames(command)) return read_contours(path, command.contours);
    DicomSeriesOptions options = command.input.options.dicom;
    options.content = images.options.dicom.content;
    const std::vector<DicomSeries> frames = list_dicom_frames(images.path, options);
    return read_contours_in_time({path}, command.contours, frames.size() > 1 ? frames : std::vector<DicomSeries>{});
}

/// Throws Error(invalid_input) for an empty structure set, and for contours that formats without planes would bend: of an
/// RTSTRUCT, which is one, the reader says it.
void check_drawn(const ConvertCommand& command, const ContourSet& set) {
    const fs::path& input = command.input.path;
    if (is_dicom_name(command.output) && set.contours.empty())
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{}: there is no contour; a structure set needs at least 1", input.string()));
    if (!keeps_frames(command.output) && !is_rtstruct(input)) check_each_contour(input, set);
}

void convert(const ConvertCommand& command, FileKind kind, const fs::path& output, Console& console) {
    const Provenance provenance = provenance_of(command, console.work());
    switch (kind) {
        case FileKind::image:
            return convert_image(command, output, provenance, console);
        case FileKind::contours: {
            const ImageInput images = shown_in(command, console);
            ReadContours loaded = read_drawn(command, images);
            if (command.input.options.frame) set_frame(loaded.contours, static_cast<double>(*command.input.options.frame));
            console.note(loaded.notes);
            check_drawn(command, loaded.contours);
            for (const std::string& note : frame_of_reference_notes(loaded.frame_of_reference_uid, images))
                console.warn(note);
            return console.note(write_contours(output, loaded.contours, images,
                                               rtstruct_options(command.holes, command.series, provenance)));
        }
        case FileKind::mesh:
            if (makes_mask(kind, command.output)) return convert_to_mask(command, output, provenance, console);
            return write_mesh(output, read_mesh(command.input.path), provenance);
    }
}

/// Options that would change nothing.
void check_options(const ConvertCommand& command, FileKind kind) {
    const auto refuse = [](const char* why) { throw Error(ErrorKind::invalid_input, why); };
    const ReadImageOptions& read = command.input.options;
    const bool is_dicom = is_dicom_name(command.output);
    check_holes(command.holes, is_dicom && kind == FileKind::contours);
    check_series(command.series, std::array{command.output});
    const bool places = kind == FileKind::contours && has_frames(command);
    if (!command.image.empty() && !is_dicom && !places && kind != FileKind::image && !makes_mask(kind, command.output))
        refuse(
            "--image is for DICOM (.dcm), which refers to images, for label maps, which get its grid, and for a structure "
            "set, whose contours get its frames in kontur's .json");
    if (places && !looks_like_dicom(command.image))
        throw Error(ErrorKind::invalid_input, fmt::format("{} is no DICOM series, to whose frames {} could refer",
                                                          command.image.string(), command.input.path.string()));
    if (command.image.empty() && makes_mask(kind, command.output))
        refuse("a mask of a mesh needs a grid; name an image that has it with --image");
    if (command.contours.roi && kind != FileKind::contours) refuse("--roi chooses from a structure set");
    if (command.contours.curves && kind != FileKind::contours) refuse("--curves is for 3D Slicer's markups (.mrk.json)");
    if (read.frame && kind != FileKind::image && !(kind == FileKind::contours && keeps_frames(command.output)))
        refuse("--frame is for images, and for contours in kontur's .json, which alone has room for it");
    if (read.frame && *read.frame < 1 && kind == FileKind::contours) refuse("--frame counts from 1");
    if ((read.prefer || read.allow_missing_geometry) && kind != FileKind::image)
        refuse("--prefer and --allow-missing-geometry are for images");
    if ((read.dicom.series_uid || read.dicom.volume || read.dicom.resample_slices) && kind != FileKind::image && !is_dicom &&
        !places)
        refuse("--series, --volume and --resample-slices are for DICOM images");
    if (command.label && kind != FileKind::image) refuse("--label chooses from a label map or a segmentation");
    if (command.more.empty()) return;
    if (kind != FileKind::image || !has_room_for_overlap(command.output))
        refuse("--add is for segments of a DICOM SEG (.dcm) or of a .seg.nrrd, which may overlap");
    if (command.label) refuse("--label cannot choose where --add names several files");
    for (const fs::path& path : command.more)
        if (input_kind(path) != FileKind::image) refuse("--add takes masks and label maps");
}

}  // namespace

void run(const ConvertCommand& command, Console& console) {
    const FileKind kind = check_kinds(command);
    check_options(command, kind);
    std::vector<fs::path> inputs = command.more;
    inputs.insert(inputs.end(), {command.input.path, command.image});
    check_output(command.output, inputs);
    check_dicom_images(command.output, command.image);
    Outputs outputs;
    outputs.write(command.output, [&](const fs::path& path) { convert(command, kind, path, console); });
    outputs.commit();
    console.print(command.output.string() + "\n");
}

}  // namespace kontur::app
