// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "dicom_output.h"
#include "input_digests.h"
#include "kontur/base/error.h"
#include "kontur/io/image.h"
#include "kontur/io/meshes/mesh.h"
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
    if (from == FileKind::mesh) return "kontur only changes the format of meshes";
    if (to == FileKind::contours) return "kontur trace cuts a mask into contours";
    return "kontur trace cuts a mask into contours, of which kontur segment makes a mesh";
}

/// What is converted; it stays what it is.
FileKind check_kinds(const ConvertCommand& command) {
    const std::optional<FileKind> to = output_kind(command.output);
    const FileKind from = input_kind(command.input.path);
    if (from == to || (!to && from != FileKind::mesh)) return from;
    if (!to) check_output_kind(command.output, from);
    throw Error(ErrorKind::unsupported,
                fmt::format("{} holds {} and cannot be converted to {} in {}; {}", command.input.path.string(), words(from),
                            words(*to), command.output.string(), advice(from, *to)));
}

Provenance provenance_of(const ConvertCommand& command, const Work& work) {
    std::vector<std::pair<std::string, fs::path>> inputs{{"source", command.input.path}};
    for (const fs::path& path : command.more) inputs.emplace_back(fmt::format("source_{}", inputs.size() + 1), path);
    std::string options = command.contours.roi ? fmt::format("roi={}", *command.contours.roi) : "";
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

void convert_image(const ConvertCommand& command, const fs::path& output, const Provenance& made, Console& console) {
    const ImageInput input{command.input.path, console.noting(command.input.options)};
    const ImageInput images{command.image, console.noting(command.input.options)};
    if (is_dicom_name(output))
        for (const std::string& note : frame_of_reference_notes(frame_of_reference_of(command.input.path), images))
            console.warn(note);
    const bool by_itself = !command.more.empty() || (!command.label && may_overlap(input));
    if (by_itself && has_room_for_overlap(output))
        return console.note(write_structures(output, structures_of(command, console), images, made, console.work()));
    if (by_itself && !is_dicom_seg(input.path))  // of which the reader says which
        throw Error(ErrorKind::invalid_input,
                    fmt::format("segments of {} overlap, and {} has room for one in a voxel; write a SEG (.dcm) or "
                                ".seg.nrrd, or choose one with --label",
                                command.input.path.string(), command.output.string()));
    const bool as_it_is = !command.label && !has_room_for_overlap(output);
    const Image image =
        as_it_is ? read_image(input.path, input.options, console.work()) : read_labels(input, command.label, console.work());
    console.note(write_image(output, image, input, images, made, console.work()));
}

void convert(const ConvertCommand& command, FileKind kind, const fs::path& output, Console& console) {
    const Provenance made = provenance_of(command, console.work());
    switch (kind) {
        case FileKind::image:
            return convert_image(command, output, made, console);
        case FileKind::contours: {
            const ReadContours loaded = read_contours(command.input.path, command.contours);
            console.note(loaded.notes);
            const ImageInput images{command.image, console.noting(command.input.options)};
            for (const std::string& note : frame_of_reference_notes(loaded.frame_of_reference_uid, images))
                console.warn(note);
            return console.note(write_contours(output, loaded.contours, images, rtstruct_options(command.holes, made)));
        }
        case FileKind::mesh:
            return write_mesh(output, read_mesh(command.input.path), made);
    }
}

/// Options that would change nothing.
void check_options(const ConvertCommand& command, FileKind kind) {
    const auto refuse = [](const char* why) { throw Error(ErrorKind::invalid_input, why); };
    const ReadImageOptions& read = command.input.options;
    const bool is_dicom = is_dicom_name(command.output);
    check_holes(command.holes, is_dicom && kind == FileKind::contours);
    if (!command.image.empty() && !is_dicom) refuse("--image is for DICOM (.dcm), which refers to images");
    if (command.contours.roi && kind != FileKind::contours) refuse("--roi chooses from a structure set");
    if ((read.frame || read.prefer || read.allow_missing_geometry) && kind != FileKind::image)
        refuse("--frame, --prefer and --allow-missing-geometry are for images");
    if ((read.dicom.series_uid || read.dicom.volume) && kind != FileKind::image && !is_dicom)
        refuse("--series and --volume choose from DICOM images");
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
