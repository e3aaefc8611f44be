// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "kontur/base/error.h"
#include "viewer/model/file_names.h"
#include "viewer/model/model_json.h"
#include "viewer/model/single_points.h"
#include "viewer/session/calls.h"
#include "viewer/session/history.h"
#include "viewer/session/replies.h"

// Structures: made, named, imported, removed.

namespace kontur::viewer {
namespace {

using nlohmann::json;

constexpr std::size_t kLongestName = 100;                ///< of imports
constexpr std::size_t kMostPointsOfProject = 2'000'000;  ///< of imports: a page is told all of them at once

/// PageJson apart by people with any colour vision, on a dark ground (Okabe and Ito's palette, the dark ones left out).
constexpr std::array kColors{"#e69f00", "#56b4e9", "#009e73", "#f0e442", "#d55e00", "#cc79a7"};

/// A file's name for a structure: whole characters of UTF-8.
std::string name_from(const std::string& text) {
    std::string name = parsed(to_text(text)).get<std::string>();
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

std::string next_color(const State& state) {
    std::array<int, kColors.size()> uses{};
    for (const auto& [id, structure] : state.structures)
        for (std::size_t i = 0; i < kColors.size(); ++i) uses[i] += structure.color == kColors[i];
    return kColors[static_cast<std::size_t>(std::min_element(uses.begin(), uses.end()) - uses.begin())];
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
    structure.color = m.has("color") ? m.color("color") : next_color(s.project.state());
    structure.id = s.project.new_id();
    commit(s, {"Add " + structure.name, {{structure.id, {}, structure}}, {}});
    return {{"structure", to_json(structure)}};
}

json set_structure(SessionState& s, const Members& m) {
    const Structure before = structure_of(s.project.state(), m.id("id"));
    Structure after = before;
    if (m.has("name")) after.name = m.text("name", kMostNameBytes);
    if (m.has("color")) after.color = m.color("color");
    after.visible = m.flag_or("visible", after.visible);
    if (m.has("empty_planes")) after.empty_planes = m.planes("empty_planes");
    if (m.has("smoothing")) after.smoothing = m.smoothing("smoothing");
    std::string label = "Show or hide " + after.name;
    if (after.empty_planes != before.empty_planes) label = fmt::format("Nothing of {} in a plane", after.name);
    if (after.empty_planes.size() < before.empty_planes.size()) label = "Forget empty planes of " + after.name;
    if (after.smoothing != before.smoothing) label = "Smoothing of " + after.name;
    if (after.color != before.color) label = "Colour " + after.name;
    if (after.name != before.name) label = "Rename " + before.name;
    commit(s, {label, {{after.id, before, after}}, {}});
    return {{"structure", to_json(after)}};
}

json remove_structure(SessionState& s, const Members& m) {
    const Structure structure = structure_of(s.project.state(), m.id("id"));
    Commit removed{"Delete " + structure.name, {{structure.id, structure, {}}}, {}};
    for (const auto& [id, contour] : s.project.state().contours)
        if (contour->structure == structure.id) removed.contours.push_back({id, *contour, {}});
    commit(s, removed);
    return json::object();
}

Commit new_structures(SessionState& s, const std::string& label, const std::vector<ContourSet>& sets) {
    Commit added{label, {}, {}};
    State state = s.project.state();
    if (const auto unused = placeholder(state)) {
        added.structures.push_back({unused->id, unused, {}});
        state.structures.clear();
    }
    std::size_t points = 0;
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
        state.structures[structure.id] = structure;
        added.structures.push_back({structure.id, {}, structure});
        for (const Contour& contour : set.contours) {
            points += contour.points.size();
            DrawnContour drawn = as_drawn(contour);
            drawn.id = s.project.new_id();
            drawn.structure = structure.id;
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
    return {
        {"structure.add", {add_structure}}, {"structure.set", {set_structure}}, {"structure.remove", {remove_structure}}};
}

std::vector<Id> add_structures(SessionState& s, const std::string& label, const std::vector<ContourSet>& sets) {
    const std::scoped_lock lock(s.mutex);
    const Commit added = new_structures(s, label, sets);
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
    const Commit first = new_structures(s, {}, sets);
    s.project.begin_with(first);
    for (const Change<Structure>& change : first.structures) s.surfaces.follow_later(surface_task(s, change.id));
}

}  // namespace kontur::viewer
