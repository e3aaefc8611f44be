// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "commands.h"
#include "contour_files.h"
#include "dicom_output.h"
#include "input_digests.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/contours/contour_json.h"
#include "kontur/io/image_frames.h"
#include "kontur/shape/label_choice_error.h"
#include "outputs.h"
#include "structures.h"

namespace kontur::app {
namespace {

/// The planes of the grid's slices, with u and v along i and j as far as they are orthogonal.
std::vector<Plane> slice_planes(const Grid& grid) {
    const Vec3 u = normalized(grid.index_to_mm.column(0));
    const Vec3 normal = normalized(cross(u, grid.index_to_mm.column(1)));
    std::vector<Plane> planes;
    for (std::int64_t k = 0; k < grid.size.k; ++k) planes.push_back({grid.center_mm(0, 0, k), normal, u, cross(normal, u)});
    return planes;
}

/// Those of the file, or the slices of the image; where neither is named the mask's own.
std::vector<Plane> planes_to_cut(const TraceCommand& command, const Mask& mask, Console& console, const Work& work) {
    if (!command.planes.empty()) return read_planes_json(command.planes);
    if (command.image.path.empty()) return slice_planes(mask.grid);
    return slice_planes(read_grid(command.image.path, console.noting(command.image.options), work));
}

Provenance provenance_of(const TraceCommand& command, const Work& work) {
    const TraceOptions& o = command.options;
    std::string options =
        fmt::format("step_mm={} tolerance_mm={} min_area_mm2={}", o.step_mm, o.tolerance_mm, o.min_area_mm2);
    if (command.label) options += fmt::format(" label={}", *command.label);
    if (command.all_labels) options += " all_labels=true";
    return made_by("trace", {{"mask", command.mask}, {"planes", command.planes}, {"image", command.image.path}}, options,
                   work);
}

/// The one of a DICOM SEG or a .seg.nrrd that is traced; of several the chosen one.
std::optional<DicomSegment> traced_segment(const TraceCommand& command) {
    const std::vector<DicomSegment> named = named_segments({command.mask, command.read});
    if (!command.label) return named.size() == 1 ? std::optional(named.front()) : std::nullopt;
    const auto found =
        std::find_if(named.begin(), named.end(), [&](const DicomSegment& s) { return s.number == *command.label; });
    return found == named.end() ? std::nullopt : std::optional(*found);
}

/// Whatever can be refused before any work is done.
void check(const TraceCommand& command) {
    check_utf8(command.name, "the name");
    check_output(command.output, std::array{command.mask, command.planes, command.image.path});
    check_output_kind(command.output, FileKind::contours);
    check_dicom_images(command.output, command.image.path);
    check_holes(command.holes, is_dicom_name(command.output));
    check_series(command.series, std::array{command.output});
    if (command.all_labels && !is_dicom_name(command.output))
        throw Error(
            ErrorKind::invalid_input,
            fmt::format("{} has room for one structure; --all-labels is for an RTSTRUCT (.dcm)", command.output.string()));
}

/// That of --frame, which chooses the mask's; of a mask without frames it says of which phase that is.
std::optional<std::int64_t> frame_of_contours(TraceCommand& command) {
    const std::optional<std::int64_t> frame = command.read.frame;
    if (!frame || has_extension(command.mask, ".seg.nrrd")) return std::nullopt;  // of which it chooses a layer
    if (*frame > 0 && read_image_frames(command.mask, command.read).count == 1) command.read.frame.reset();
    return frame;
}

/// Of several labels one has to be chosen, where the output has no room for all.
Mask one_mask(const TraceCommand& command, Console& console, const Work& work) {
    try {
        return read_mask(command.mask, command.label, console.noting(command.read), work);
    } catch (const LabelChoiceError& error) {
        if (!is_dicom_name(command.output)) throw;
        throw Error(error.kind(), std::string(error.what()) + ", or take them all with --all-labels");
    }
}

void trace_all(const TraceCommand& command, const ImageInput& images, Console& console, const Work& work) {
    const Structures found = read_structures({command.mask, console.noting(command.read)}, work);
    if (found.masks.empty())
        throw Error(ErrorKind::invalid_input, command.mask.string() + " has no labels, so there is nothing to cut");
    const std::vector<Plane> planes = planes_to_cut(command, found.masks.front(), console, work);
    std::vector<ContourSet> sets;
    std::size_t contours = 0;
    for (std::size_t n = 0; n < found.masks.size(); ++n) {
        ContourSet& set = sets.emplace_back(trace(found.masks[n], planes, command.options, work));
        set.name = found.segments[n].label;
        set.attributes = attributes_of(found.segments[n]);
        contours += set.contours.size();
        if (set.contours.empty()) console.warn(fmt::format("no plane meets '{}', whose ROI is empty", set.name));
    }
    const WriteRtstructOptions write = rtstruct_options(command.holes, command.series, provenance_of(command, work));
    Outputs outputs;
    outputs.write(command.output, [&](const std::filesystem::path& path) {
        console.note(write_contours_of_all(path, sets, images, write));
    });
    outputs.commit();
    console.print(fmt::format("{}: {} with {} in {}\n", command.output.string(), counted(sets.size(), "structure"),
                              counted(contours, "contour"), counted(planes.size(), "plane")));
}

}  // namespace

void run(const TraceCommand& words, Console& console) {
    TraceCommand command = words;
    check(command);
    const std::optional<std::int64_t> frame = frame_of_contours(command);
    const Work work = console.work(command.threads);
    const ImageInput images{command.image.path, console.noting(command.image.options)};
    for (const std::string& note : frame_of_reference_notes(frame_of_reference_of(command.mask), images)) console.warn(note);
    if (command.all_labels) return trace_all(command, images, console, work);
    const Mask mask = one_mask(command, console, work);
    const std::vector<Plane> planes = planes_to_cut(command, mask, console, work);
    ContourSet set = trace(mask, planes, command.options, work);
    if (set.contours.empty())
        console.warn(planes.size() == 1 ? "the plane does not meet the mask"
                                        : fmt::format("none of the {} planes meets the mask", planes.size()));
    set.attributes = fitted_attributes({});
    if (const auto segment = traced_segment(command)) {
        set.name = segment->label;
        set.attributes = attributes_of(*segment);
    }
    if (!command.name.empty()) set.name = command.name;
    if (frame) set_frame(set, static_cast<double>(*frame));

    const WriteRtstructOptions write = rtstruct_options(command.holes, command.series, provenance_of(command, work));
    Outputs outputs;
    outputs.write(command.output,
                  [&](const std::filesystem::path& path) { console.note(write_contours(path, set, images, write)); });
    outputs.commit();
    console.print(fmt::format("{}: {} with {} in {}\n", command.output.string(), counted(set.contours.size(), "contour"),
                              counted(point_count(set), "point"), counted(planes.size(), "plane")));
}

}  // namespace kontur::app
