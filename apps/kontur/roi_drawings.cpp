// SPDX-License-Identifier: Apache-2.0
#include "roi_drawings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "dicom_output.h"
#include "drawn_on.h"
#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_phases.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/dicom/rtstruct_in_time.h"
#include "kontur/io/image_frames.h"
#include "own_grid.h"

namespace kontur::app {
namespace {

[[noreturn]] void refuse(const std::string& sentence) { throw Error(ErrorKind::invalid_input, sentence); }

/// All ROIs by their numbers, as names may occur twice.
std::vector<std::string> names_of(const SegmentCommand& command, const StructureSet& set) {
    if (!command.all_rois) return command.rois;
    std::vector<std::string> names;
    for (const Roi& roi : set.rois)
        if (!roi.contours.contours.empty() || !roi.damage.empty()) names.push_back(std::to_string(roi.number));
    if (names.empty())
        refuse(fmt::format("{}: none of the {} ROIs has a contour", command.contours.front().string(), set.rois.size()));
    return names;
}

/// The position of a ROI by its name or number, among those that are segmented.
std::optional<std::size_t> position_of(const std::string& name, const std::vector<Roi>& rois) {
    try {
        const std::int64_t number = select_roi({"", rois}, name).number;
        const auto found = std::find_if(rois.begin(), rois.end(), [&](const Roi& roi) { return roi.number == number; });
        return static_cast<std::size_t>(found - rois.begin());
    } catch (const Error&) {
        return std::nullopt;
    }
}

/// Names may contain colons: the one that has the name of a ROI on either side parts them.
StructurePair rule_of(const char* option, const std::string& words, Relation relation, const std::vector<Roi>& rois) {
    for (std::size_t colon = words.find(':'); colon != std::string::npos; colon = words.find(':', colon + 1)) {
        const auto first = position_of(words.substr(0, colon), rois), second = position_of(words.substr(colon + 1), rois);
        if (first && second && *first != *second) return {*first, *second, relation};
    }
    std::string names;
    for (const Roi& roi : rois) names += fmt::format("{}'{}'", names.empty() ? "" : ", ", roi.name);
    refuse(fmt::format("{} is '{}'; two different ROIs of {} are needed, with a colon between them", option, words, names));
}

/// Of all ROIs those that `check` throws Error for are left out, and a note says why; of named ones it is thrown.
template <class Check>
void leave_out(RoiDrawings& drawings, bool takes_all, const Check& check) {
    std::vector<Roi> kept;
    for (Roi& roi : drawings.rois) {
        try {
            check(roi.contours);
            kept.push_back(std::move(roi));
        } catch (const Error& error) {
            if (!takes_all || (kept.empty() && &roi == &drawings.rois.back()))
                throw error.with_context(fmt::format("ROI '{}'", roi.name));
            drawings.notes.push_back(fmt::format("the ROI '{}' is left out: {}", roi.name, error.what()));
            drawings.left_out.push_back({std::move(roi), error.what()});
        }
    }
    drawings.rois = std::move(kept);
}

/// Of all ROIs those in which nothing is drawn. Many plans have such; of those that lost all by reading it is said why.
void leave_out_empty(RoiDrawings& drawings, const StructureSet& set) {
    for (const Roi& roi : set.rois) {
        if (!roi.contours.contours.empty() || !roi.damage.empty()) continue;
        for (const std::string& note : roi.notes)
            drawings.notes.push_back(fmt::format("the ROI '{}' is left out: {}", roi.name, note));
        drawings.left_out.push_back({roi, contour_problems(roi.contours).front()});
    }
}

/// Of all that was drawn, once it is known to make sense.
Box3 box_of(const std::vector<Roi>& rois) {
    Box3 box;
    for (const Roi& roi : rois) {
        const Box3 its = bounding_box(roi.contours);
        box.extend(its.min);
        box.extend(its.max);
    }
    return box;
}

/// "1, 5 and none".
std::string listed(const std::set<std::optional<double>>& frames) {
    std::string text;
    for (const auto& frame : frames)
        if (frame) text += fmt::format("{}{}", text.empty() ? "" : ", ", *frame);
    return frames.contains(std::nullopt) ? text + " and none" : text;
}

/// Of the images where they are several and none was chosen; else empty.
std::vector<DicomSeries> frames_of(const SegmentCommand& command, const Work& work) {
    const auto& [path, options] = command.image;
    const bool has_choice = options.frame || options.dicom.volume;
    if (path.empty() || has_choice || !looks_like_dicom(path) || is_dicom_seg(path)) return {};
    std::vector<DicomSeries> frames = list_dicom_frames(path, options.dicom, work);
    return frames.size() > 1 ? frames : std::vector<DicomSeries>{};
}

/// Of images in time the frame is read in which all was drawn; contours need no frame then. Of several all are to be read.
void place_in_time(RoiDrawings& drawings, const std::vector<DicomSeries>& frames, const Work& work) {
    std::set<std::optional<double>> drawn;
    for (const Roi& roi : drawings.rois)
        for (const Contour& contour : roi.contours.contours) drawn.insert(contour.frame);
    if (frames.empty() || drawn == std::set<std::optional<double>>{std::nullopt}) return;
    ImageInput& image = drawings.input;
    if (drawn.size() > 1 && drawn.contains(std::nullopt))
        refuse(fmt::format("the ROIs refer to several frames of {}: {}; name one at a time with --roi", image.path.string(),
                           listed(drawn)));
    drawings.are_moving = drawn.size() > 1;
    if (drawings.are_moving) return;
    const double frame = **drawn.begin();
    drawings.notes.push_back(fmt::format("all contours refer to frame {} of {}, which is read", frame, image.path.string()));
    for (Roi& roi : drawings.rois)
        for (Contour& contour : roi.contours.contours) contour.frame.reset();
    image = source_of_frame(image, read_image_frames(image.path, image.options, work), static_cast<std::int64_t>(frame));
}

/// Its grid, and its voxels where they matter: those of several frames are read one by one.
void read_image_of(RoiDrawings& drawings, const SegmentCommand& command, const Work& work) {
    const ImageInput& all = drawings.input;
    const ImageInput image =
        drawings.are_moving ? source_of_frame(all, read_image_frames(all.path, all.options, work), 1) : all;
    for (std::string& note : frame_of_reference_notes(drawings.rois.front().frame_of_reference_uid, image))
        drawings.notes.push_back(std::move(note));
    const UseImage use = drawings.are_moving ? UseImage::off : command.options.use_image;
    DrawnOn drawn_on = read_drawn_on(image, use, work, drawings.notes);
    drawings.grid = drawn_on.grid;
    drawings.image = std::move(drawn_on.image);
}

}  // namespace

RoiDrawings read_roi_drawings(const SegmentCommand& command, const Work& work) {
    const std::filesystem::path& file = command.contours.front();
    const std::vector<DicomSeries> frames = frames_of(command, work);
    const StructureSet set = read_rtstruct_in_time(file, frames);
    RoiDrawings drawings{.notes = set.notes, .input = command.image};
    if (command.all_rois) leave_out_empty(drawings, set);
    for (const std::string& name : names_of(command, set)) {
        try {
            const Roi roi = select_roi(set, name);
            if (roi.contours.contours.empty())
                refuse(fmt::format("the ROI '{}' has no contour{}; at least 1 is needed", name,
                                   roi.notes.empty() ? "" : fmt::format(" to fit ({})", fmt::join(roi.notes, "; "))));
            for (const Roi& other : drawings.rois)
                if (other.number == roi.number) refuse(fmt::format("the ROI '{}' is named twice", name));
            drawings.rois.push_back(roi);
        } catch (const Error& error) {
            throw error.with_context(file.string());
        }
    }
    place_in_time(drawings, frames, work);
    leave_out(drawings, command.all_rois, [&](const ContourSet& contours) {
        if (!drawings.are_moving) return check_contours(contours);
        if (const auto problems = contour_problems(contours); !problems.empty()) refuse(problems.front());
    });
    if (command.image.path.empty()) {
        drawings.grid = own_grid(command, box_of(drawings.rois));
        return drawings;
    }
    read_image_of(drawings, command, work);
    leave_out(drawings, command.all_rois,
              [&](const ContourSet& contours) { check_contours_inside(contours, drawings.grid); });
    return drawings;
}

std::vector<StructurePair> roi_rules(const SegmentCommand& command, const RoiDrawings& drawings) {
    std::vector<StructurePair> rules;
    std::vector<Roi> rois = drawings.rois;
    for (const LeftOutRoi& one : drawings.left_out) rois.push_back(one.roi);
    const auto add = [&](const char* option, const std::vector<std::string>& all, Relation relation) {
        for (const std::string& words : all) {
            const StructurePair rule = rule_of(option, words, relation, rois);
            for (const StructurePair& other : rules)
                if (std::minmax(other.first, other.second) == std::minmax(rule.first, rule.second))
                    refuse(fmt::format("2 rules are about '{}' and '{}'; 1 is possible", rois[rule.first].name,
                                       rois[rule.second].name));
            rules.push_back(rule);
        }
    };
    add("--inside", command.inside, Relation::inside);
    add("--may-overlap", command.may_overlap, Relation::overlap);
    add("--exclusive", command.exclusive, Relation::exclusive);
    std::erase_if(rules,
                  [&](const StructurePair& rule) { return std::max(rule.first, rule.second) >= drawings.rois.size(); });
    return rules;
}

}  // namespace kontur::app
