// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/derive/rule_names.h"
#include "viewer/model/file_names.h"
#include "viewer/model/label_values.h"
#include "viewer/model/model_json.h"
#include "viewer/model/names.h"
#include "viewer/model/single_points.h"
#include "viewer/model/structure_rules.h"
#include "viewer/session/calls.h"
#include "viewer/session/history.h"
#include "viewer/session/replies.h"
#include "viewer/session/times_of_contours.h"

// Structures: made, named, imported, removed.

namespace kontur::viewer {
namespace {

using nlohmann::json;

constexpr std::size_t kLongestName = 100;                ///< of imports
constexpr std::size_t kMostPointsOfProject = 2'000'000;  ///< of imports: a page is told all of them at once

/// The first six are told apart by people with any colour vision, on a dark ground (Okabe and Ito's palette, the dark ones
/// left out). Each of the others lies as far as it can from those before it in OKLab (Ottosson 2020), none of them dark.
constexpr std::array kColors{"#e69f00", "#56b4e9", "#009e73", "#f0e442", "#d55e00", "#cc79a7", "#8040ff", "#ff20ff",
                             "#20ff20", "#20ffe0", "#ffc0ff", "#c020a0", "#80c020", "#ff2060", "#2080ff", "#a0c0a0",
                             "#ffe0c0", "#4080a0", "#c080ff", "#808020", "#8060c0", "#ffa0a0", "#a0e0ff", "#a06060"};

/// A file's name for a structure: whole characters of UTF-8.
std::string name_from(const std::string& text) {
    std::string name = plain_text(parsed(to_text(text)).get<std::string>());
    if (name.size() <= kLongestName) return name;
    std::size_t end = kLongestName;
    while (end > 0 && (name[end] & 0xc0) == 0x80) --end;
    return name.substr(0, end);
}

std::string free_name(const State& state) {
    for (std::size_t number = state.structures.size() + 1;; ++number) {
        std::string name = fmt::format("Structure {}", number);
        const bool taken = std::any_of(state.structures.begin(), state.structures.end(),
                                       [&](const auto& item) { return item.second.name == name; });
        if (!taken) return name;
    }
}

/// What a new project begins with, to be drawn into, as long as nobody has done anything with it: whoever imports has no
/// use for it.
std::optional<Structure> placeholder(const State& state) {
    if (state.structures.size() != 1 || !state.contours.empty()) return std::nullopt;
    const Structure& only = state.structures.begin()->second;
    const Structure untouched{only.id, free_name({}), next_color({})};
    return only == untouched ? std::optional(only) : std::nullopt;
}

json add_structure(SessionState& s, const Members& m) {
    Structure structure;
    structure.name = m.has("name") ? m.text("name", kMostNameBytes) : free_name(s.project.state());
    check_name(structure.name);
    check_name_is_free(s.project.state(), structure.name);
    structure.color = m.has("color") ? m.color("color") : next_color(s.project.state());
    structure.id = s.project.new_id();
    commit(s, {"Add " + structure.name, {{structure.id, {}, structure}}, {}});
    return {{"structure", to_json(structure)}};
}

void check_label_is_free(const State& state, const Structure& structure) {
    if (!structure.label_value) return;
    if (const Structure* const owner = owner_of_label(state, *structure.label_value, structure.id))
        throw Error(ErrorKind::invalid_input, fmt::format("{} has the label value {} already; give it another one first",
                                                          owner->name, *structure.label_value));
}

/// What the message says of the mask that the structure's contours correct, and what the history calls that; "" for nothing.
std::string change_mask(Structure& structure, const Members& m) {
    if (!m.has("confirmed_planes") && !m.has("reach") && !m.has("drop_loose")) return "";
    if (!structure.mask)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} is no mask to be corrected; 'confirmed_planes', 'reach' and 'drop_loose' are for those",
                                structure.name));
    const StructureMask before = *structure.mask;
    StructureMask& mask = *structure.mask;
    if (m.has("confirmed_planes")) mask.confirmed_planes = m.planes("confirmed_planes");
    if (m.has("reach")) mask.reach = m.reach("reach");
    mask.drop_loose = m.flag_or("drop_loose", mask.drop_loose);
    if (mask.drop_loose != before.drop_loose)
        return fmt::format("{} loose pieces of {}", mask.drop_loose ? "Take away" : "Keep", structure.name);
    if (mask.reach != before.reach) return "Reach of corrections of " + structure.name;
    if (mask.confirmed_planes == before.confirmed_planes) return "";
    return fmt::format("{} a plane of {}",
                       mask.confirmed_planes.size() < before.confirmed_planes.size() ? "Forget" : "Confirm", structure.name);
}

/// A plane of a mask is empty, or right, or drawn in: of what was said before and is said now of one plane the latter holds.
void settle_planes(const State& state, const Structure& before, Structure& after) {
    const auto says = [](const std::vector<Plane>& planes, const Plane& one) {
        return std::ranges::any_of(planes, [&](const Plane& plane) { return is_same_plane(plane, one); });
    };
    const auto settle = [&](const std::vector<Plane>& known, const std::vector<Plane>& now, std::vector<Plane>& other) {
        for (const Plane& plane : now) {
            if (says(known, plane)) continue;
            std::erase_if(other, [&](const Plane& one) { return is_same_plane(one, plane); });
            for (const auto& [id, contour] : state.contours)
                if (contour->structure == after.id && is_same_plane(contour->plane, plane))
                    throw Error(ErrorKind::invalid_input,
                                fmt::format("{} is drawn in this plane; delete that correction first", after.name));
        }
    };
    settle(before.empty_planes, after.empty_planes, after.mask->confirmed_planes);
    settle(before.mask->confirmed_planes, after.mask->confirmed_planes, after.empty_planes);
}

/// Rules call a renamed structure by its new name.
void rename_in_rules(const State& state, Commit& step) {
    const Structure before = *step.structures.front().before;
    const std::string name = step.structures.front().after->name;
    check_name_is_free(state, name);
    if (!before.rule && users_of(state, before.id).empty()) return;
    for (const auto& [id, other] : state.structures)
        if (id != before.id && other.name == name)
            throw Error(ErrorKind::invalid_input,
                        fmt::format("there is a structure named {}, and rules could not tell the two apart", name));
    if (std::optional<std::string>& rule = step.structures.front().after->rule) rule = with_name(*rule, before.name, name);
    for (const auto& [id, other] : state.structures) {
        if (id == before.id || !other.rule) continue;
        Structure renamed = other;
        renamed.rule = with_name(*other.rule, before.name, name);
        if (renamed != other) step.structures.push_back({id, other, renamed});
    }
}

json set_structure(SessionState& s, const Members& m) {
    const Structure before = structure_of(s.project.state(), m.id("id"));
    Structure after = before;
    if (m.has("name")) after.name = m.text("name", kMostNameBytes);
    if (m.has("name")) check_name(after.name);
    if (m.has("color")) after.color = m.color("color");
    after.visible = m.flag_or("visible", after.visible);
    if (m.has("empty_planes")) after.empty_planes = m.planes("empty_planes");
    if (m.has("smoothing")) after.smoothing = m.smoothing("smoothing");
    if (m.has("label_value")) after.label_value = m.label_value("label_value");
    check_label_is_free(s.project.state(), after);
    const std::string mask_label = change_mask(after, m);
    if (after.mask) settle_planes(s.project.state(), before, after);
    std::string label = "Show or hide " + after.name;
    if (after.empty_planes != before.empty_planes) label = fmt::format("Nothing of {} in a plane", after.name);
    if (after.empty_planes.size() < before.empty_planes.size()) label = "Forget empty planes of " + after.name;
    if (after.smoothing != before.smoothing) label = "Smoothing of " + after.name;
    if (after.label_value != before.label_value) label = "Label value of " + after.name;
    if (after.color != before.color) label = "Colour " + after.name;
    if (!mask_label.empty()) label = mask_label;
    if (after.name != before.name) label = "Rename " + before.name;
    Commit step{label, {{after.id, before, after}}, {}};
    if (after.name != before.name) rename_in_rules(s.project.state(), step);
    commit(s, step);
    return {{"structure", to_json(*step.structures.front().after)}};
}

/// This one is seen and no other; where that is so already, all are.
json show_only(SessionState& s, const Members& m) {
    const Structure chosen = structure_of(s.project.state(), m.id("id"));
    const auto& all = s.project.state().structures;
    const bool is_alone =
        std::ranges::all_of(all, [&](const auto& one) { return one.second.visible == (one.first == chosen.id); });
    Commit step{is_alone ? "Show all structures" : "Show only " + chosen.name, {}, {}};
    for (const auto& [id, before] : all) {
        Structure after = before;
        after.visible = is_alone || id == chosen.id;
        if (after != before) step.structures.push_back({id, before, after});
    }
    commit(s, step);
    return json::object();
}

json remove_structure(SessionState& s, const Members& m) {
    const Structure structure = structure_of(s.project.state(), m.id("id"));
    check_is_unused(s.project.state(), structure);
    Commit removed{"Delete " + structure.name, {{structure.id, structure, {}}}, {}};
    for (const auto& [id, contour] : s.project.state().contours)
        if (contour->structure == structure.id) removed.contours.push_back({id, *contour, {}});
    commit(s, removed);
    return json::object();
}

FramesOfImage frames_of(const SessionState& s) { return {s.image.times.count(), s.image.times.own(), s.image.frame_step_s}; }

/// What a file says of the cycle counts where nobody has said it before.
void add_cycle(Commit& added, const State& state, const std::vector<ContourSet>& sets) {
    for (const ContourSet& set : sets)
        if (set.cycle_frames && !state.cycle_frames && !added.cycle) added.cycle = CycleChange{{}, set.cycle_frames};
}

Commit new_structures(SessionState& s, const std::string& label, const std::vector<ContourSet>& sets,
                      const LabelValues& values, const ImportedMasks& masks = {}) {
    Commit added{label, {}, {}};
    State state = s.project.state();
    if (const auto unused = placeholder(state)) {
        added.structures.push_back({unused->id, unused, {}});
        state.structures.clear();
    }
    add_cycle(added, state, sets);
    std::size_t points = 0, place = 0;
    for (const auto& [id, contour] : state.contours) points += contour->points.size();
    for (const ContourSet& set : sets) {
        Structure structure{s.project.new_id(), name_from(set.name), next_color(state), true, set.empty_planes};
        check_single_points(set);
        structure.surface_points = set.surface;
        structure.interior = set.interior;
        structure.exterior = set.exterior;
        structure.attributes = set.attributes;
        if (const auto& color = std::exchange(structure.attributes.color, {})) structure.color = color_text(*color);
        if (structure.name.empty()) structure.name = free_name(state);
        if (const auto value = values.find(place++);
            value != values.end() && !owner_of_label(state, value->second, structure.id))
            structure.label_value = value->second;
        if (const auto mask = masks.find(place - 1); mask != masks.end()) {
            structure.mask = StructureMask{.hash = mask->second.mask->hash(), .source = plain_text(mask->second.source)};
            added.masks.push_back(mask->second.mask);
        }
        state.structures[structure.id] = structure;
        added.structures.push_back({structure.id, {}, structure});
        for (const Contour& contour : set.contours) {
            points += contour.points.size();
            DrawnContour drawn = as_drawn(contour);
            drawn.id = s.project.new_id();
            drawn.structure = structure.id;
            if (!structure.mask) drawn.time = time_of(contour, frames_of(s));
            added.contours.push_back({drawn.id, {}, std::move(drawn)});
        }
    }
    if (points > kMostPointsOfProject)
        throw Error(ErrorKind::too_large,
                    fmt::format("the project would hold {} points; the limit is {}", points, kMostPointsOfProject));
    return added;
}

}  // namespace

Calls structure_calls() {
    return {{"structure.add", {add_structure}},
            {"structure.set", {set_structure}},
            {"structure.show_only", {show_only}},
            {"structure.remove", {remove_structure}}};
}

std::string next_color(const State& state) {
    std::array<int, kColors.size()> uses{};
    for (const auto& [id, structure] : state.structures)
        for (std::size_t i = 0; i < kColors.size(); ++i) uses[i] += structure.color == kColors[i];
    return kColors[static_cast<std::size_t>(std::min_element(uses.begin(), uses.end()) - uses.begin())];
}

std::vector<Id> add_structures(SessionState& s, const std::string& label, const std::vector<ContourSet>& sets,
                               const LabelValues& values, const ImportedMasks& masks) {
    std::vector<ContourSet> in_frames = sets;
    for (ContourSet& set : in_frames)
        for (const std::string& note : put_into_frames(set, frames_of(s))) s.pages.notice("info", note);
    const std::scoped_lock lock(s.mutex);
    const Commit added = new_structures(s, label, in_frames, values, masks);
    clear_draft(s);
    s.project.commit(added);
    tell_changes(s, added);
    std::vector<Id> ids;
    for (const Change<Structure>& change : added.structures) {
        if (!change.after) continue;
        ids.push_back(change.id);
        s.surfaces.follow_later(surface_task(s, change.id));
    }
    return ids;
}

void begin_with(SessionState& s, const std::vector<ContourSet>& sets) {
    const std::scoped_lock lock(s.mutex);
    std::vector<ContourSet> in_frames = sets;
    for (ContourSet& set : in_frames)
        for (std::string& note : put_into_frames(set, frames_of(s))) s.notes.push_back(std::move(note));
    const Commit first = new_structures(s, {}, in_frames, {});
    s.project.begin_with(first);
    for (const Change<Structure>& change : first.structures) s.surfaces.follow_later(surface_task(s, change.id));
}

}  // namespace kontur::viewer
