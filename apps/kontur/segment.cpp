// SPDX-License-Identifier: Apache-2.0
#include "kontur/segment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <future>
#include <utility>

#include "commands.h"
#include "contour_files.h"
#include "dicom_output.h"
#include "drawn_on.h"
#include "input_digests.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/base/machine_memory.h"
#include "kontur/base/printable.h"
#include "kontur/base/stopwatch.h"
#include "kontur/evidence.h"
#include "kontur/extract/slice_contours.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/bytes/png.h"
#include "kontur/io/contours_in_time.h"
#include "kontur/io/dicom/dicom_phases.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/image_frames.h"
#include "kontur/io/meshes/mesh.h"
#include "kontur/segment_report.h"
#include "kontur/sureness/surface_evidence.h"
#include "kontur/sureness/surface_uncertainty.h"
#include "kontur/sureness/uncertainty_map.h"
#include "kontur/view/picture.h"
#include "outputs.h"
#include "own_grid.h"
#include "segment_frames.h"
#include "segment_rois.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

void check_extension(const fs::path& path, std::string_view extension) {
    if (!has_extension(path, extension))
        throw Error(ErrorKind::unsupported, fmt::format("{} does not end with {}", path.string(), extension));
}

/// Whatever else can be refused before any work is done.
void check_files(const SegmentCommand& command) {
    check_dicom_images(command.output, command.image.path);
    check_dicom_images(command.rtstruct, command.image.path);
    std::vector<fs::path> inputs = command.contours;
    inputs.push_back(command.image.path);
    check_outputs(std::array{command.output, command.rtstruct, command.mesh, command.picture, command.uncertainty,
                             command.volumes, command.report},
                  inputs);
}

struct Inputs {
    ContourSet contours;
    Grid grid;
    std::optional<Image> image;  ///< only where its voxels matter
    std::vector<std::string> notes;
};

Inputs read_inputs(const SegmentCommand& command, ReadContours contours, const Work& work) {
    Inputs inputs{std::move(contours.contours), {}, {}, std::move(contours.notes)};
    for (std::string& note : frame_of_reference_notes(contours.frame_of_reference_uid, command.image))
        inputs.notes.push_back(std::move(note));
    if (!command.name.empty()) inputs.contours.name = command.name;
    if (command.image.path.empty()) {
        inputs.grid = own_grid(command, bounding_box(inputs.contours));
    } else if (command.picture.empty()) {
        DrawnOn drawn_on = read_drawn_on(command.image, command.options.use_image, work, inputs.notes);
        inputs.grid = drawn_on.grid;
        inputs.image = std::move(drawn_on.image);
    } else {  // which shows it
        ReadImageOptions read = command.image.options;
        read.on_note = [&](std::string_view note) { inputs.notes.emplace_back(note); };
        inputs.image = read_image(command.image.path, read, work);
        inputs.grid = inputs.image->grid;
    }
    return inputs;
}

RgbImage picture(const SegmentCommand& command, const Inputs& inputs, const Segmentation& result, const Work& work) {
    PictureOptions options;
    options.title =
        inputs.contours.name.empty() ? printable_utf8(command.contours.front().stem().string()) : inputs.contours.name;
    options.facts = {{"Volume (mask)", in_ml(result.report.mask_volume_ml)},
                     {"Residual (max)", fmt::format("{:.2g} mm", result.report.residual.max_mm)},
                     {"Residual (rms)", fmt::format("{:.2g} mm", result.report.residual.rms_mm)}};
    return make_picture(*result.mesh, inputs.contours, inputs.image ? &*inputs.image : nullptr, options, work);
}

/// The surface on the image's slices. What there is to tell becomes a warning in the report.
void write_structure_set(const OutputFile& file, const std::optional<HoleEncoding>& holes, const Inputs& inputs,
                         Segmentation& result, const Work& work) {
    ContourSet set = slice_contours(result.mask, result.function, work);
    set.name = inputs.contours.name;
    set.attributes = fitted_attributes(inputs.contours.attributes);
    for (std::string& note :
         write_contours(file.path, set, file.images, rtstruct_options(holes, file.series, file.provenance)))
        result.report.warnings.push_back(std::move(note));
}

bool lacks_grid(const SegmentCommand& command) { return command.image.path.empty() && command.spacing_mm.empty(); }

bool is_mesh_name(const fs::path& path) { return output_kind(path) == FileKind::mesh; }

/// Before any work is done.
void check_planes_suffice(const SegmentCommand& command, const ContourSet& contours) {
    const std::size_t count = DrawnLines(contours).planes().size();
    if (!command.uncertainty.empty() && count < kLeastPlanes)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("--uncertainty: contours lie in {}; of fewer than {} nothing is known",
                                counted(count, "different plane"), kLeastPlanes));
}

void write_uncertainty(const fs::path& path, const Inputs& inputs, const Segmentation& result, const Provenance& provenance,
                       const Work& work) {
    const SurfaceEvidence evidence = gather_evidence(result, inputs.contours, work);
    if (is_mesh_name(path))
        write_mesh(path, *result.mesh, {"half_width_mm", half_widths_mm(evidence, result.mesh->points, work)}, provenance);
    else write_image(path, uncertainty_map(result.mask, evidence, work), {}, provenance);
}

std::string crossings_line(const std::vector<Crossing>& crossings) {
    const Disagreement all = disagreement(crossings);
    const std::string unmatched = all.unmatched > 0 ? fmt::format(", {} unmatched", all.unmatched) : "";
    return fmt::format("{} of contours{}; disagreement {:.3g} mm (max), {:.3g} mm (rms)\n", counted(all.matched, "crossing"),
                       unmatched, all.max_mm, all.rms_mm);
}

void print_summary(const SegmentCommand& command, const Segmentation& result, double seconds, Console& console) {
    const SegmentReport& r = result.report;
    std::string text = fmt::format("{}: {}, {}, {}\n", command.output.string(), counted(r.mask_voxels, "voxel"),
                                   in_ml(r.mask_volume_ml), counted(r.mask_components, "component"));
    if (!command.rtstruct.empty()) text += command.rtstruct.string() + "\n";
    if (!command.mesh.empty())
        text += fmt::format("{}: {}, {}\n", command.mesh.string(), counted(result.mesh->triangles.size(), "triangle"),
                            in_ml(signed_volume_mm3(*result.mesh) / 1000));
    if (!command.picture.empty()) text += command.picture.string() + "\n";
    for (const fs::path& path : {command.uncertainty, command.report})
        if (!path.empty()) text += path.string() + "\n";
    text += fmt::format("{}, {}, {}; residual {:.3g} mm (max), {:.3g} mm (rms)\n", counted(r.contours, "contour"),
                        counted(r.points, "point"), counted(r.centres, "centre"), r.residual.max_mm, r.residual.rms_mm);
    if (!r.crossings.empty()) text += crossings_line(r.crossings);
    if (r.image.verdict != ImageVerdict::none) text += sentence(r.image) + "\n";
    text += sentence(r.uncertainty) + "\n";
    console.print(text + fmt::format("{:.2f} s, {:.0f} MB\n", seconds, peak_memory_mb()));
}

}  // namespace

void check_words(const SegmentCommand& command) {
    check_output_kind(command.output, FileKind::image);
    check_holes(command.holes, !command.rtstruct.empty());
    check_series(command.series, std::array{command.output, command.rtstruct});
    if (!command.rtstruct.empty()) check_extension(command.rtstruct, ".dcm");
    if (command.image.path.empty())
        for (const fs::path& path : {command.output, command.rtstruct}) check_dicom_images(path, {});
    if (!command.mesh.empty()) check_output_kind(command.mesh, FileKind::mesh);
    if (!command.picture.empty() && !is_animation(command)) check_extension(command.picture, ".png");
    if (!command.uncertainty.empty()) {
        if (is_mesh_name(command.uncertainty)) check_extension(command.uncertainty, ".ply");
        else check_image_name(command.uncertainty);
    }
    if (!command.report.empty()) check_extension(command.report, ".json");
    if (!command.volumes.empty()) check_extension(command.volumes, ".csv");

    if (lacks_grid(command)) throw Error(ErrorKind::invalid_input, "the mask has no grid; give --image or --spacing-mm");
    if (const std::size_t count = command.spacing_mm.size(); count != 0 && count != 1 && count != 3)
        throw Error(ErrorKind::invalid_input, fmt::format("--spacing-mm has {} numbers; 1 or 3 are needed", count));
    check_label_value(command.label.label);
    check_utf8(command.name, "the name");
    if (command.date) utc_date();  // which may be set to what is no date
    if (has_several(command)) check_roi_words(command);
    else if (command.together)
        throw Error(ErrorKind::invalid_input, "--together is for several ROIs; name them by --roi, or --all-rois");
}

/// Structure sets say by the slices that they refer to in which frame of the images they were drawn; where all of them lie
/// in one frame, that is the one to read.
void place_in_time(SegmentCommand& command, ReadContours& read) {
    ImageInput& image = command.image;
    const bool has_choice = image.options.frame || image.options.dicom.volume;
    if (image.path.empty() || has_choice || std::ranges::none_of(command.contours, is_rtstruct)) return;
    if (!looks_like_dicom(image.path) || is_dicom_seg(image.path)) return;
    const ImageFrames frames = read_image_frames(image.path, image.options);
    if (frames.count < 2) return;
    image.options.dicom.content = frames.headers;
    read = read_contours_in_time(command.contours, command.read, list_dicom_frames(image.path, image.options.dicom));
    const auto& contours = read.contours.contours;
    const std::optional<double> frame = contours.empty() ? std::nullopt : contours.front().frame;
    if (!frame || std::ranges::any_of(contours, [&](const Contour& one) { return one.frame != frame; })) return;
    image = source_of_frame(image, frames, static_cast<std::int64_t>(*frame));
    read.notes.push_back(fmt::format("all contours refer to frame {} of {}, which is read", *frame, image.path.string()));
}

void run(const SegmentCommand& words, Console& console) {
    SegmentCommand command = words;
    if (command.rois.size() == 1) command.read.roi = command.rois.front();
    refuse_images(command.contours);
    // Files that hold no contours are the greater surprise.
    if (lacks_grid(command) && !has_several(command)) read_contours_to_fit(command.contours, command.read);
    check_words(command);
    check_files(command);
    if (has_several(command)) return segment_rois(command, console);
    ReadContours contours = read_contours_to_fit(command.contours, command.read);
    place_in_time(command, contours);
    if (is_moving(command, contours.contours)) return segment_moving(command, std::move(contours), console);
    if (command.cycle) throw Error(ErrorKind::invalid_input, "--cycle is for contours that were drawn at several moments");
    if (is_animation(command))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} would move, and contours are of one moment; a .png does not", command.picture.string()));
    const Work work = console.work(command.threads);
    std::vector<std::pair<std::string, double>> seconds;
    Stopwatch reading(seconds);
    const Inputs inputs = read_inputs(command, std::move(contours), work);
    // Beside the work: a large image takes as long to digest as a small case to segment.
    std::future<Provenance> digests =
        std::async(std::launch::async, [&command, stop = work.stop] { return input_digests(command, Work{.stop = stop}); });
    reading.lap("read");

    SegmentOptions options = command.options;
    check_planes_suffice(command, inputs.contours);
    const bool draws_band = !command.uncertainty.empty() && is_mesh_name(command.uncertainty);
    options.mesh = !command.mesh.empty() || !command.picture.empty() || draws_band;
    if (!command.image.path.empty()) options.drawn_on = inputs.grid;
    Segmentation result = segment(inputs.contours, inputs.grid, inputs.image ? &*inputs.image : nullptr, options, work);
    SegmentReport& report = result.report;
    name_margin(command, report.warnings);
    put_notes_first(inputs.notes, report.warnings);
    report.seconds.insert(report.seconds.begin(), seconds.begin(), seconds.end());
    Stopwatch writing(report.seconds);

    LabelName label = command.label;
    if (!inputs.contours.name.empty()) label.name = inputs.contours.name;
    if (const auto& color = inputs.contours.attributes.color) label.color = to_levels(*color);
    Provenance facts = provenance(inputs.contours, inputs.grid, report);
    for (auto& digest : digests.get()) facts.push_back(std::move(digest));
    if (command.date) facts.emplace_back("date", utc_date());

    Outputs outputs;
    const auto write = [&](const fs::path& target, const auto& writer) {
        if (!target.empty()) outputs.write(target, writer);
        work.check();
    };
    const auto dicom = [&](const fs::path& path) { return OutputFile{path, command.image, command.series, facts}; };
    write(command.output, [&](const fs::path& path) {
        for (std::string& note : write_mask(dicom(path), result, inputs.contours.attributes, label, work))
            report.warnings.push_back(std::move(note));
    });
    write(command.rtstruct,
          [&](const fs::path& path) { write_structure_set(dicom(path), command.holes, inputs, result, work); });
    write(command.mesh, [&](const fs::path& path) { write_mesh(path, *result.mesh, facts); });
    write(command.picture, [&](const fs::path& path) { write_png(path, picture(command, inputs, result, work), facts); });
    write(command.uncertainty, [&](const fs::path& path) { write_uncertainty(path, inputs, result, facts, work); });
    writing.lap("write");
    write(command.report, [&](const fs::path& path) { write_file_atomically(path, to_json(report, facts)); });
    outputs.commit();

    for (const std::string& warning : report.warnings) console.warn(warning);
    print_summary(command, result, total_seconds(report), console);
}

}  // namespace kontur::app
