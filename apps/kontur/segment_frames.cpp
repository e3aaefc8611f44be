// SPDX-License-Identifier: Apache-2.0
#include "segment_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "contour_files.h"
#include "dicom_output.h"
#include "facts.h"
#include "frames_picture.h"
#include "input_digests.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/base/stopwatch.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/image_frames.h"
#include "kontur/io/meshes/mesh.h"
#include "kontur/segment_moving.h"
#include "kontur/segment_report.h"
#include "moving_input.h"
#include "outputs.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& problem) { throw Error(ErrorKind::invalid_input, problem); }

/// "liver_frame_07.stl" of 12 for "liver.stl".
fs::path frame_path(const fs::path& path, std::size_t frame, std::size_t count) {
    const std::size_t digits = std::to_string(count).size();
    return path.parent_path() /
           fmt::format("{}_frame_{:0{}}{}", path.stem().string(), frame + 1, digits, path.extension().string());
}

/// None without --mesh.
std::vector<fs::path> mesh_paths(const SegmentCommand& command, const ImageFrames& frames) {
    std::vector<fs::path> paths;
    if (command.mesh.empty()) return paths;
    const auto count = static_cast<std::size_t>(frames.count);
    for (std::size_t n = 0; n < count; ++n) paths.push_back(frame_path(command.mesh, n, count));
    return paths;
}

std::string summary_of(const SegmentCommand& command, const MovingSegmentation& result) {
    const VolumeCurve& curve = result.volumes;
    std::string text = fmt::format("{}: {}, {} drawn\n", command.output.string(), counted(result.masks.size(), "frame"),
                                   counted(result.moments.size(), "moment"));
    if (!result.meshes.empty() && !command.mesh.empty())
        text += fmt::format("{}: {}\n", frame_path(command.mesh, 0, result.meshes.size()).string(),
                            counted(result.meshes.size(), "surface"));
    for (const fs::path& path : {command.picture, command.volumes, command.report})
        if (!path.empty()) text += path.string() + "\n";
    text += extremes_of(curve) + "\n";
    const auto interval = curve.ejection_interval();
    return text + fmt::format("stroke volume {:.4g} ml, ejection fraction {:.1f} %{}\n", curve.stroke_ml(),
                              100 * curve.ejection_fraction(),
                              interval ? fmt::format(" ({:.1f} to {:.1f})", 100 * interval->low, 100 * interval->high) : "");
}

}  // namespace

Facts moving_report(const MovingSegmentation& result, const Provenance& provenance) {
    Facts report;
    const VolumeCurve& curve = result.volumes;
    report["frames"] = result.masks.size();
    report["moments"] = Facts::array();
    for (const DrawnMoment& moment : result.moments) {
        const SegmentReport& one = moment.segmentation.report;
        report["moments"].push_back({{"time", moment.time},
                                     {"contours", moment.contours},
                                     {"carried", moment.carried},
                                     {"volume_ml", one.mask_volume_ml},
                                     {"residual_max_mm", one.residual.max_mm},
                                     {"residual_rms_mm", one.residual.rms_mm}});
    }
    report["mask"]["volume_ml"] = curve.volumes_ml[curve.largest];  // what batch shows of a case
    report["volumes_ml"] = curve.volumes_ml;
    report["largest_frame"] = curve.largest + 1;
    report["smallest_frame"] = curve.smallest + 1;
    report["stroke_ml"] = curve.stroke_ml();
    report["ejection_fraction"] = curve.ejection_fraction();
    for (const VolumeInterval& one : curve.intervals) {
        report["volumes_low_ml"].push_back(one.low_ml);
        report["volumes_high_ml"].push_back(one.high_ml);
    }
    if (const auto interval = curve.ejection_interval()) {
        report["ejection_fraction_low"] = interval->low;
        report["ejection_fraction_high"] = interval->high;
    }
    report["warnings"] = result.warnings;
    for (const auto& [stage, seconds] : result.seconds) report["seconds"][stage] = seconds;
    report["provenance"] = provenance_facts(provenance);
    return report;
}

std::string extremes_of(const VolumeCurve& curve) {
    return fmt::format("largest in frame {} ({:.4g} ml), smallest in frame {} ({:.4g} ml)", curve.largest + 1,
                       curve.volumes_ml[curve.largest], curve.smallest + 1, curve.volumes_ml[curve.smallest]);
}

bool is_animation(const SegmentCommand& command) { return has_extension(command.picture, ".apng"); }

bool is_moving(const SegmentCommand& command, const ContourSet& contours) {
    return kontur::is_moving(contours) || !command.volumes.empty();
}

void check_moving_words(const SegmentCommand& command) {
    check_moving_image(command.image);
    for (const auto& [option, path] :
         {std::pair("--rtstruct", &command.rtstruct), std::pair("--uncertainty", &command.uncertainty)})
        if (!path->empty())
            refuse(fmt::format("{} is of one moment, and contours were drawn at several; leave it out", option));
    if (!is_dicom_name(command.output)) check_frames_name(command.output);
}

void segment_moving(const SegmentCommand& command, ReadContours read, Console& console) {
    check_moving_words(command);
    const Work work = console.work(command.threads);
    std::vector<std::pair<std::string, double>> seconds;
    Stopwatch reading(seconds);
    ContourSet& contours = read.contours;
    std::vector<std::string> notes = std::move(read.notes);
    if (!command.name.empty()) contours.name = command.name;
    const MovingInput input = read_moving_input({command.image, command.cycle, read.frame_of_reference_uid}, contours, work);
    notes.insert(notes.end(), input.notes.begin(), input.notes.end());
    const ImageFrames& frames = input.frames;
    const Grid& grid = input.grid;
    ImageInput known = command.image;
    known.options.dicom.content = frames.headers;
    std::vector<fs::path> inputs = command.contours;
    inputs.push_back(command.image.path);
    const std::vector<fs::path> meshes = mesh_paths(command, frames);
    check_outputs(meshes, inputs);
    SegmentOptions options = command.options;
    options.drawn_on = grid;
    options.mesh = !command.mesh.empty() || !command.picture.empty();
    reading.lap("read");
    MovingSegmentation result =
        kontur::segment_moving(contours, input.to_segment(command.image, work), input.times, options, work);
    result.seconds.insert(result.seconds.begin(), seconds.begin(), seconds.end());
    put_notes_first(notes, result.warnings);

    LabelName label = command.label;
    if (!contours.name.empty()) label.name = contours.name;
    if (const auto& color = contours.attributes.color) label.color = to_levels(*color);
    Provenance facts = provenance(contours, grid, result.moments.front().segmentation.report);
    for (auto& digest : input_digests(command, work)) facts.push_back(std::move(digest));
    if (command.date) facts.emplace_back("date", utc_date());
    Outputs outputs;
    const auto write = [&](const fs::path& target, const auto& writer) {
        if (!target.empty()) outputs.write(target, writer);
        work.check();
    };
    write(command.output, [&](const fs::path& path) {
        if (!is_dicom_name(path)) return write_masks(path, result.masks, frames.step_s, label.label, facts);
        DicomSegment segment = fitted_segment(contours.attributes);
        segment.label = label.name;
        segment.color = to_rgb8(label.color);
        const OutputFile file{path, known, command.series, facts};
        for (std::string& note : write_masks_over_time(file, {result.masks}, {segment}, work))
            result.warnings.push_back(std::move(note));
    });
    for (std::size_t n = 0; n < meshes.size(); ++n)
        write(meshes[n], [&](const fs::path& path) { write_mesh(path, result.meshes[n], facts); });
    write(command.picture, [&](const fs::path& path) {
        write_picture_of_frames(path, {command, contours, frames, result}, facts, work);
    });
    write(command.volumes, [&](const fs::path& path) {
        write_file_atomically(path, volumes_csv(result.times, result.volumes, result.moments, frames.step_s));
    });
    write(command.report,
          [&](const fs::path& path) { write_file_atomically(path, to_json_text(moving_report(result, facts))); });
    outputs.commit();
    for (const std::string& warning : result.warnings) console.warn(warning);
    console.print(summary_of(command, result));
}

}  // namespace kontur::app
