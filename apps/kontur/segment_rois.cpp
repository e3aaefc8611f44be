// SPDX-License-Identifier: Apache-2.0
#include "segment_rois.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "contour_files.h"
#include "derived_rois.h"
#include "dicom_output.h"
#include "facts.h"
#include "input_digests.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/extract/slice_contours.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/labels/boxed_mask.h"
#include "kontur/labels/section_contours.h"
#include "kontur/segment_report.h"
#include "kontur/segment_together.h"
#include "kontur/view/picture.h"
#include "outputs.h"
#include "roi_drawings.h"
#include "roi_outputs.h"
#include "segment_moving_rois.h"
#include "structures.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& sentence) { throw Error(ErrorKind::invalid_input, sentence); }

/// The borders of a mask on its slices, where no function says where they run.
ContourSet slice_outlines(const BoxedMask& object, const Grid& grid) {
    constexpr std::int64_t kMargin = 4;  // as far as outlines are smoothed
    return slice_outlines(widened(object, object.box.padded({kMargin, kMargin, kMargin}, grid.size), grid).mask);
}

IndexBox whole_box(const Grid& grid) { return {{0, 0, 0}, {grid.size.i - 1, grid.size.j - 1, grid.size.k - 1}}; }

SegmentOptions options_for(const SegmentCommand& command, const RoiDrawings& drawings) {
    SegmentOptions options = command.options;
    if (!command.image.path.empty()) options.drawn_on = drawings.grid;
    return options;
}

RoiResults fit_each(const SegmentCommand& command, const RoiDrawings& drawings, const Work& work) {
    RoiResults result(command, drawings);
    const Image* const image = drawings.image ? &*drawings.image : nullptr;
    const SegmentOptions options = options_for(command, drawings);
    for (std::size_t n = 0; n < drawings.rois.size(); ++n) {
        try {
            Segmentation segmentation = segment(drawings.rois[n].contours, drawings.grid, image, options, work);
            ContourSet outlines;
            if (!command.rtstruct.empty()) outlines = slice_contours(segmentation.mask, segmentation.function, work);
            FittedRoi one = fitted_roi(drawings, n, std::move(segmentation.report));
            if (!command.rules.empty()) result.for_rules.push_back({one.roi.name, segmentation.mask, segmentation.function});
            result.add(command, std::move(one), std::move(outlines), std::move(segmentation.mask), whole_box(drawings.grid));
        } catch (const Error& error) {
            throw error.with_context(fmt::format("ROI '{}'", drawings.rois[n].name));
        }
    }
    return result;
}

std::string sentence(const StructurePair& pair, const std::vector<Roi>& rois) {
    return fmt::format("'{}' and '{}': {}{}, {} claimed by both", rois[pair.first].name, rois[pair.second].name,
                       pair.relation == Relation::inside ? "the first inside the second" : name(pair.relation),
                       pair.is_given ? " by rule" : "", counted(pair.shared_voxels, "voxel"));
}

RoiResults fit_together(const SegmentCommand& command, const RoiDrawings& drawings, const Work& work) {
    RoiResults result(command, drawings);
    std::vector<ContourSet> contours;
    for (const Roi& roi : drawings.rois) contours.push_back(roi.contours);
    const TogetherOptions options{.segment = options_for(command, drawings), .rules = roi_rules(command, drawings)};
    Together all = segment_together(contours, drawings.grid, drawings.image ? &*drawings.image : nullptr, options, work);
    for (const StructurePair& pair : all.pairs) {
        if (pair.relation == Relation::inside)
            result.labels.set_inside(static_cast<std::uint16_t>(pair.first + 1),
                                     static_cast<std::uint16_t>(pair.second + 1));
        result.notes.push_back(sentence(pair, drawings.rois));
    }
    if (all.closed_voxels > 0)
        result.notes.push_back(counted(all.closed_voxels, "voxel") + " between structures that touch " +
                               (all.closed_voxels == 1 ? "was" : "were") + " given to the nearest");
    if (all.borrowed_points > 0)
        result.notes.push_back(fmt::format("{} of borders that one structure alone has drawn count{} for its neighbour, too",
                                           counted(all.borrowed_points, "point"), all.borrowed_points == 1 ? "s" : ""));
    if (!command.mesh.empty()) result.surface = shared_surface(all, work);
    for (std::size_t n = 0; n < all.structures.size(); ++n) {
        BoxedMask object{all.boxes[n], std::move(all.structures[n].mask)};
        ContourSet outlines = command.rtstruct.empty() ? ContourSet{} : slice_outlines(object, drawings.grid);
        FittedRoi one = fitted_roi(drawings, n, std::move(all.structures[n].report));
        if (!command.rules.empty())
            result.for_rules.push_back(
                {one.roi.name, widened(object, whole_box(drawings.grid), drawings.grid).mask, all.structures[n].function});
        if (has_extension(command.output, ".seg.nrrd"))  // all layers have one grid
            object = widened(object, whole_box(drawings.grid), drawings.grid);
        result.add(command, std::move(one), std::move(outlines), std::move(object.mask), object.box);
    }
    all.structures.clear();
    result.together = std::move(all);
    return result;
}

}  // namespace

bool has_several(const SegmentCommand& command) {
    return command.all_rois || command.rois.size() > 1 || !command.rules.empty();
}

void check_roi_words(const SegmentCommand& command) {
    const auto refuse_one = [](const char* option) {
        refuse(fmt::format("{} has room for one structure; several ROIs go into a mask's labels and an RTSTRUCT", option));
    };
    if (!command.mesh.empty() && !command.together) refuse_one("--mesh");
    if (!command.mesh.empty() && !has_extension(command.mesh, ".ply"))
        refuse(fmt::format("{}: the surfaces of several ROIs share their borders; only a .ply has room for that",
                           command.mesh.string()));
    if (!command.picture.empty()) refuse_one("--picture");
    if (!command.uncertainty.empty()) refuse_one("--uncertainty");
    if (!command.volumes.empty()) refuse_one("--volumes");
    if (!command.name.empty()) refuse_one("--name");
    if (command.label.label != LabelName{}.label)
        refuse("--label-value is for one structure; several ROIs become the labels 1, 2, ...");
    if (command.rois.empty() && !command.all_rois)
        refuse("--rules is for ROIs of an RTSTRUCT; name those that rules need by --roi, or --all-rois");
    if (command.read.curves) refuse("--curves is for 3D Slicer's markups (.mrk.json); several ROIs come from an RTSTRUCT");
    if (command.contours.size() != 1) refuse("several ROIs are chosen from one RTSTRUCT");
    if (command.rois.size() > std::numeric_limits<std::uint16_t>::max())
        throw Error(ErrorKind::too_large,
                    fmt::format("{} ROIs are named; a label map has room for 65535", command.rois.size()));
}

void segment_rois(const SegmentCommand& words, Console& console) {
    const Work work = console.work(words.threads);
    const RoiDrawings drawings = read_roi_drawings(words, work);
    if (drawings.are_moving) return segment_moving_rois(words, drawings, console);
    if (words.cycle) refuse("--cycle is for contours that were drawn at several moments");
    SegmentCommand command = words;
    command.image = drawings.input;
    if (!command.rules.empty()) check_roi_derivation(command, drawings);
    RoiResults result = command.together ? fit_together(command, drawings, work) : fit_each(command, drawings, work);
    const std::vector<FittedRoi>& all = result.all;

    Provenance provenance = common_provenance(all);
    if (!command.rules.empty()) add_derived_rois(command, drawings, result, work);
    for (const FittedRoi& one : all)
        if (!one.rule.empty()) provenance.emplace_back(fmt::format("rule_{}", one.segment.number), printable_utf8(one.rule));
    for (auto& digest : input_digests(command, work)) provenance.push_back(std::move(digest));
    if (command.date) provenance.emplace_back("date", utc_date());

    const auto add = [&](const std::vector<std::string>& more) {
        result.notes.insert(result.notes.end(), more.begin(), more.end());
    };
    Outputs outputs;
    outputs.write(command.output, [&](const fs::path& path) {
        add(has_room_for_overlap(path)
                ? write_structures({path, command.image, command.series, provenance}, result.structures, work)
                : write_label_map(path, result, provenance));
    });
    if (!command.rtstruct.empty())
        outputs.write(command.rtstruct,
                      [&](const fs::path& path) { add(write_roi_contours(path, command, all, provenance)); });
    if (!command.mesh.empty())
        outputs.write(command.mesh, [&](const fs::path& path) { write_roi_surfaces(path, result, provenance); });
    if (!command.report.empty())
        outputs.write(command.report, [&](const fs::path& path) {
            write_file_atomically(path, to_json_text(roi_report(result, provenance)));
        });
    outputs.commit();

    for (const FittedRoi& one : all)
        for (const std::string& warning : one.report.warnings)
            console.warn(fmt::format("{}: {}", one.segment.label, warning));
    for (const std::string& note : result.notes) console.warn(note);
    std::string text = fmt::format("{}: {}\n", command.output.string(), counted(all.size(), "structure"));
    for (const FittedRoi& one : all)
        if (!one.rule.empty())
            text += fmt::format("{} {}: {}, {}; by rule\n", one.segment.number, one.segment.label,
                                counted(one.report.mask_voxels, "voxel"), in_ml(one.report.mask_volume_ml));
        else
            text += fmt::format("{} {}: {}, {}; residual {:.3g} mm (max)\n", one.segment.number, one.segment.label,
                                counted(one.report.mask_voxels, "voxel"), in_ml(one.report.mask_volume_ml),
                                one.report.residual.max_mm);
    for (const fs::path& path : {command.rtstruct, command.mesh, command.report})
        if (!path.empty()) text += path.string() + "\n";
    console.print(text);
}

}  // namespace kontur::app
