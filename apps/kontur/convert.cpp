// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>

#include "commands.h"
#include "dicom_output.h"
#include "input_digests.h"
#include "kontur/base/error.h"
#include "kontur/io/mesh.h"
#include "outputs.h"

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

Provenance provenance_of(const ConvertCommand& command, const Progress& progress) {
    return made_by("convert", {{"source", command.input.path}},
                   command.contours.roi ? fmt::format("roi={}", *command.contours.roi) : "", progress);
}

void convert(const ConvertCommand& command, FileKind kind, const fs::path& output, Console& console) {
    const Provenance made = provenance_of(command, console.progress());
    switch (kind) {
        case FileKind::image: {
            const ImageInput& input = command.input;
            const Image image = read_image(input.path, console.noting(input.options), console.progress());
            return write_image(output, image, input.path, {command.image, input.options}, made, console.progress());
        }
        case FileKind::contours: {
            const ReadContours loaded = read_contours(command.input.path, command.contours);
            console.note(loaded.notes);
            const ImageInput images{command.image, command.input.options};
            WriteRtstructOptions write = command.write_rtstruct;
            write.provenance = made;
            return console.note(write_contours(output, loaded.contours, images, write));
        }
        case FileKind::mesh:
            return write_mesh(output, read_mesh(command.input.path), made);
    }
}

}  // namespace

void run(const ConvertCommand& command, Console& console) {
    const FileKind kind = check_kinds(command);
    check_output(command.output, std::array{command.input.path});
    check_dicom_images(command.output, command.image);
    Outputs outputs;
    outputs.write(command.output, [&](const fs::path& path) { convert(command, kind, path, console); });
    outputs.commit();
    console.print(command.output.string() + "\n");
}

}  // namespace kontur::app
