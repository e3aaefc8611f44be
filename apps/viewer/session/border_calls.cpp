// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "viewer/edits/carried_borders.h"
#include "viewer/model/model_json.h"
#include "viewer/session/calls.h"
#include "viewer/session/events.h"
#include "viewer/session/history.h"

// Borders that structures share.

namespace kontur::viewer {
namespace {

using nlohmann::json;

constexpr double kNearVoxels = 2;  ///< lines of two structures that are as near as this are one border

/// Whether two structures have no voxel in common, by a rule, or as their surfaces lie.
bool exclude(const SessionState& s, Id a, Id b) {
    if (const BorderRule* rule = s.project.state().borders.rule_about(a, b)) return rule->relation == Relation::exclusive;
    for (const BorderPair& pair : s.surfaces.border_pairs())
        if (std::minmax(pair.first, pair.second) == std::minmax(a, b)) return pair.relation == Relation::exclusive;
    return true;
}

void commit_borders(SessionState& s, const std::string& label, Borders after) {
    const Borders& before = s.project.state().borders;
    if (after == before) return;
    Commit step{label, {}, {}, {}};
    step.borders = BordersChange{before, std::move(after)};
    commit(s, step);
}

json set_borders(SessionState& s, const Members& m) {
    Borders after = s.project.state().borders;
    after.shared = m.flag("shared");
    commit_borders(s, after.shared ? "Share borders" : "Share no borders", std::move(after));
    return json::object();
}

json set_border_rule(SessionState& s, const Members& m) {
    const Structure& first = structure_of(s.project.state(), m.id("first"));
    const Structure& second = structure_of(s.project.state(), m.id("second"));
    if (first.id == second.id)
        throw Error(ErrorKind::invalid_input, fmt::format("a rule is about the structure {} and itself", first.id));
    Borders after = s.project.state().borders;
    if (m.text("relation", 16) == "auto") after.forget(first.id, second.id);
    else after.set({first.id, second.id, relation_named(m.text("relation", 16))});
    commit_borders(s, fmt::format("The rule for {} and {}", first.name, second.name), std::move(after));
    return json::object();
}

}  // namespace

Calls border_calls() { return {{"borders.set", {set_borders}}, {"borders.rule", {set_border_rule}}}; }

std::vector<DrawnContour> carried_with(SessionState& s, const DrawnContour& contour) {
    const State& state = s.project.state();
    const auto before = state.contours.find(contour.id);
    if (!state.borders.shared || before == state.contours.end() || structure_of(state, contour.structure).mask) return {};
    const DrawnContour& old = *before->second;
    if (old.structure != contour.structure || old.points == contour.points || old.points.size() < 3) return {};
    if (!old.closed || !contour.closed) return {};  // an open line says nothing of a border beyond its ends
    const Vec3 spacing = s.image.voxels->grid.spacing_mm();
    const double near_mm = kNearVoxels * std::min({spacing.x, spacing.y, spacing.z});
    std::vector<DrawnContour> carried;
    for (const auto& [id, other] : state.contours) {
        const Structure& owner = structure_of(state, other->structure);
        const bool is_seen = other->visible && owner.visible && !owner.mask;  // masks to be corrected share no borders
        if (other->structure == contour.structure || !is_seen || owner.attributes.review.locked || other->points.size() < 3)
            continue;
        if (!lies_in(*other, old.plane, slice_step_mm(s.image.voxels->grid, old.plane.normal))) continue;
        if (other->time != contour.time || !exclude(s, contour.structure, other->structure)) continue;
        if (auto line = carried_along(*other, old, contour, near_mm, *s.edges_of(*other)))
            carried.push_back(std::move(*line));
    }
    return carried;
}

json to_json(const std::vector<BorderPair>& pairs) {
    json found = json::array();
    for (const BorderPair& pair : pairs)
        found.push_back({{"first", pair.first},
                         {"second", pair.second},
                         {"relation", std::string(kontur::name(pair.relation))},
                         {"share", std::round(1000 * pair.share) / 1000},
                         {"given", pair.is_given}});
    return found;
}

}  // namespace kontur::viewer
