// SPDX-License-Identifier: Apache-2.0
#include "segment_moving_rois.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "contour_files.h"
#include "dicom_output.h"
#include "input_digests.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/image_frames.h"
#include "kontur/segment_moving.h"
#include "moving_input.h"
#include "outputs.h"
#include "roi_outputs.h"
#include "segment_frames.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

/// What all ROIs became, in all frames.
struct MovingRois {
    std::vector<FittedRoi> all;
    std::vector<Facts> reports;
    std::vector<std::string> extremes;
    std::vector<RoiLabelMap> labels;       ///< of each frame, unless the output has room for overlap
    std::vector<std::vector<Mask>> masks;  ///< where it has, of each of its segments
    std::vector<DicomSegment> segments;
    std::vector<std::string> notes;
};

void check_several_moments(const SegmentCommand& command) {
    check_moving_words(command);
    for (const auto& [option, is_given] :
         {std::pair("--together", command.together), std::pair("--rules", !command.rules.empty())})
        if (is_given)
            throw Error(ErrorKind::invalid_input,
                        fmt::format("{} is of one moment, and ROIs were drawn at several; leave it out", option));
}

void add(MovingRois& result, FittedRoi one, MovingSegmentation&& moving, const SegmentCommand& command) {
    one.segment.number = static_cast<std::int64_t>(result.all.size() + 1);
    result.reports.push_back({{"label", one.segment.number}, {"name", one.segment.label}});
    result.reports.back().update(moving_report(moving, one.provenance));
    result.extremes.push_back(fmt::format("{} {}: {}", one.segment.number, one.segment.label, extremes_of(moving.volumes)));
    if (moving.moments.size() == 1)
        moving.warnings.push_back(
            fmt::format("drawn in frame {:g} alone, and the same in all", moving.moments.front().time));
    for (const std::string& warning : moving.warnings)
        result.notes.push_back(fmt::format("{}: {}", one.segment.label, warning));
    const Grid grid = moving.masks.front().grid;
    if (!is_dicom_name(command.output)) {
        const IndexBox box{{0, 0, 0}, {grid.size.i - 1, grid.size.j - 1, grid.size.k - 1}};
        result.labels.resize(moving.masks.size(), RoiLabelMap(grid, command.all_rois));
        for (std::size_t n = 0; n < moving.masks.size(); ++n)
            result.labels[n].add(moving.masks[n], box, static_cast<std::uint16_t>(one.segment.number));
    } else if (moving.volumes.volumes_ml[moving.volumes.largest] > 0) {
        result.segments.push_back(one.segment);
        result.masks.push_back(std::move(moving.masks));
    } else {
        result.notes.push_back(
            fmt::format("'{}' has no voxels of this grid and is no segment of the SEG", one.segment.label));
    }
    result.all.push_back(std::move(one));
}

std::vector<std::string> write_labels(const fs::path& path, MovingRois& result, const std::optional<double>& step_s,
                                      const Provenance& provenance) {
    std::vector<Image> frames;
    for (const RoiLabelMap& frame : result.labels) frames.push_back(frame.image());
    write_label_maps(path, frames, step_s, label_names(result.all), provenance);
    for (std::size_t n = 1; n < result.labels.size(); ++n) result.labels.front().add_shared(result.labels[n]);
    return result.labels.front().notes(names_of(result.all));
}

MovingRois fit(const SegmentCommand& command, const RoiDrawings& drawings, const MovingInput& input, const ContourSet& cycle,
               const Work& work) {
    MovingRois result;
    result.notes = drawings.notes;
    SegmentOptions options = command.options;
    options.drawn_on = input.grid;
    for (std::size_t n = 0; n < drawings.rois.size(); ++n) {
        const Roi& roi = drawings.rois[n];
        ContourSet contours = roi.contours;
        contours.cycle_frames = cycle.cycle_frames;
        try {
            MovingSegmentation moving =
                segment_moving(contours, input.to_segment(command.image, work), input.times, options, work);
            put_notes_first(roi.notes, moving.warnings);
            add(result, fitted_roi(drawings, n, moving.moments.front().segmentation.report), std::move(moving), command);
        } catch (const Error& error) {
            throw error.with_context(fmt::format("ROI '{}'", roi.name));
        }
    }
    return result;
}

}  // namespace

void segment_moving_rois(const SegmentCommand& command, const RoiDrawings& drawings, Console& console) {
    check_several_moments(command);
    const Work work = console.work(command.threads);
    ContourSet cycle = drawings.rois.front().contours;
    const std::string no_uid;  // its note is among those of the drawings
    const MovingInput input = read_moving_input({command.image, command.cycle, no_uid}, cycle, work);
    ImageInput known = command.image;
    known.options.dicom.content = input.frames.headers;
    MovingRois result = fit(command, drawings, input, cycle, work);
    result.notes.insert(result.notes.begin(), input.notes.begin(), input.notes.end());
    Provenance provenance = common_provenance(result.all);
    for (auto& digest : input_digests(command, work)) provenance.push_back(std::move(digest));
    if (command.date) provenance.emplace_back("date", utc_date());

    Outputs outputs;
    outputs.write(command.output, [&](const fs::path& path) {
        const std::vector<std::span<const Mask>> masks(result.masks.begin(), result.masks.end());
        std::ranges::move(is_dicom_name(path) ? write_masks_over_time({path, known, command.series, provenance}, masks,
                                                                      result.segments, work)
                                              : write_labels(path, result, input.frames.step_s, provenance),
                          std::back_inserter(result.notes));
    });
    Facts report{{"version", KONTUR_VERSION},
                 {"provenance", provenance_facts(provenance)},
                 {"structures", result.reports},
                 {"warnings", result.notes}};
    put_left_out(drawings.left_out, report);
    if (!command.report.empty())
        outputs.write(command.report, [&](const fs::path& path) { write_file_atomically(path, to_json_text(report)); });
    outputs.commit();
    for (const std::string& note : result.notes) console.warn(note);
    std::string text = fmt::format("{}: {} in {}\n", command.output.string(), counted(result.all.size(), "structure"),
                                   counted(input.times.size(), "frame"));
    for (const std::string& one : result.extremes) text += one + "\n";
    if (!command.report.empty()) text += command.report.string() + "\n";
    console.print(text);
}

}  // namespace kontur::app
