// SPDX-License-Identifier: Apache-2.0
#include "roi_drawings.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "dicom_output.h"
#include "drawn_on.h"
#include "kontur/base/error.h"
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

/// Of all that was drawn, once it is known to make sense.
Box3 box_of(const std::vector<Roi>& rois) {
    Box3 box;
    for (const Roi& roi : rois) {
        try {
            check_contours(roi.contours);
        } catch (const Error& error) {
            throw error.with_context(fmt::format("ROI '{}'", roi.name));
        }
        const Box3 its = bounding_box(roi.contours);
        box.extend(its.min);
        box.extend(its.max);
    }
    return box;
}

}  // namespace

RoiDrawings read_roi_drawings(const SegmentCommand& command, const Work& work) {
    const std::filesystem::path& file = command.contours.front();
    const StructureSet set = read_rtstruct(file);
    RoiDrawings drawings{{}, {}, {}, set.notes};
    for (const std::string& name : names_of(command, set)) {
        try {
            const Roi roi = select_roi(set, name);
            if (roi.contours.contours.empty())
                refuse(fmt::format("the ROI '{}' has no contour; at least 1 is needed", name));
            for (const Roi& other : drawings.rois)
                if (other.number == roi.number) refuse(fmt::format("the ROI '{}' is named twice", name));
            drawings.rois.push_back(roi);
        } catch (const Error& error) {
            throw error.with_context(file.string());
        }
    }
    for (std::string& note : frame_of_reference_notes(drawings.rois.front().frame_of_reference_uid, command.image))
        drawings.notes.push_back(std::move(note));
    if (command.image.path.empty()) {
        drawings.grid = own_grid(command, box_of(drawings.rois));
        return drawings;
    }
    DrawnOn drawn_on = read_drawn_on(command.image, command.options.use_image, work, drawings.notes);
    drawings.grid = drawn_on.grid;
    drawings.image = std::move(drawn_on.image);
    return drawings;
}

std::vector<StructurePair> roi_rules(const SegmentCommand& command, const std::vector<Roi>& rois) {
    std::vector<StructurePair> rules;
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
    return rules;
}

}  // namespace kontur::app
