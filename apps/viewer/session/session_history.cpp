// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <nlohmann/json.hpp>

#include "viewer/model/model_json.h"
#include "viewer/session/session.h"
#include "viewer/session/told.h"

// Steps of the history, the draft of the moving hand, and the surfaces that follow both.

namespace kontur::viewer {
namespace {

using nlohmann::json;

template <class Row>
json changes_json(const std::vector<Change<Row>>& changes) {
    json set = json::array(), removed = json::array();
    Told told;
    for (const Change<Row>& change : changes) {
        if (change.after) set.push_back(told(*change.after));
        else removed.push_back(change.id);
    }
    return {{"set", std::move(set)}, {"removed", std::move(removed)}};
}

/// Whether both ask the same of the surface.
bool same_surface(const Structure& a, const Structure& b) {
    return a.empty_planes == b.empty_planes && a.smoothing == b.smoothing && a.surface_points == b.surface_points &&
           a.interior == b.interior && a.exterior == b.exterior;
}

bool same_surface(const DrawnContour& a, const DrawnContour& b) {
    return a.points == b.points && a.plane == b.plane && a.hole == b.hole && a.structure == b.structure &&
           a.closed == b.closed && a.inside == b.inside && a.end == b.end && a.weight == b.weight;
}

}  // namespace

json Session::drop_draft(const Members&) {
    clear_draft();
    return json::object();
}

json Session::undo(const Members&) {
    clear_draft();
    return moved(project_.undo());
}

json Session::redo(const Members&) {
    clear_draft();
    return moved(project_.redo());
}

json Session::moved(const std::optional<Commit>& step) {
    if (!step) return {{"label", nullptr}};
    announce(*step);
    return {{"label", step->label}};
}

void Session::commit(const Commit& commit) {
    std::set<Id> touched = touched_surfaces(commit);
    touched.merge(drafted());
    draft_.reset();
    carried_.clear();
    try {
        if (!commit.is_empty()) project_.commit(commit);
    } catch (...) {
        for (const Id id : touched) follow(id);
        throw;
    }
    surfaces_.outdate(touched);
    if (!commit.is_empty()) tell_changes(commit);
    follow_touched(commit, touched);
}

void Session::commit_ahead(const Commit& step) {
    const DrawnContour& contour = *step.contours.front().after;
    const bool stays = !step.contours.front().before || step.contours.front().before->structure == contour.structure;
    const bool is_other_draft = draft_ && (draft_->id != contour.id || draft_->structure != contour.structure);
    if (!stays || is_other_draft || step.contours.size() > 1 || !carried_.empty()) return commit(step);
    // What the hand released is most often what it showed last, and then its surface is here already, or on its way.
    const bool is_followed = draft_ ? same_surface(*draft_, contour) : touched_surfaces(step).empty();
    draft_ = contour;
    if (!is_followed) follow(contour.structure);
    try {
        project_.commit(step);
    } catch (...) {
        clear_draft();
        throw;
    }
    draft_.reset();
    tell_changes(step);
}

void Session::tell_changes(const Commit& commit) {
    tell({{"event", "changed"},
          {"structures", changes_json(commit.structures)},
          {"contours", changes_json(commit.contours)},
          {"history", history()},
          {"borders", to_json(project_.state().borders)},
          {"use_image", use_image()}});
    surfaces_.use_image(image_to_ask());
    surfaces_.share_borders(project_.state().borders);
}

void Session::announce(const Commit& commit) {
    const std::set<Id> touched = touched_surfaces(commit);
    surfaces_.outdate(touched);
    tell_changes(commit);
    follow_touched(commit, touched);
}

void Session::follow_touched(const Commit& step, const std::set<Id>& touched) {
    for (const Id id : touched) {
        if (step.use_image) surfaces_.follow_later(surface_task(id));
        else follow(id);
    }
}

std::set<Id> Session::touched_surfaces(const Commit& commit) const {
    std::set<Id> touched;
    if (commit.use_image)
        for (const auto& [id, structure] : project_.state().structures) touched.insert(id);
    for (const auto& change : commit.structures)
        if (!change.before || !change.after || !same_surface(*change.before, *change.after)) touched.insert(change.id);
    for (const auto& change : commit.contours) {
        if (change.before && change.after && same_surface(*change.before, *change.after)) continue;
        for (const auto& side : {change.before, change.after})
            if (side) touched.insert(side->structure);
    }
    return touched;
}

SurfaceTask Session::surface_task(Id structure) const {
    SurfaceTask task;
    task.structure = structure;
    const State& state = project_.state();
    if (const auto own = state.structures.find(structure); own != state.structures.end()) {
        task.set = without_contours(own->second);
        task.smoothing = own->second.smoothing;
    }
    const auto add = [&](const DrawnContour& contour) {
        if (contour.structure != structure) return;
        task.set.contours.push_back(as_contour(contour));
        task.ids.push_back(contour.id);
    };
    // The draft in its contour's place: what is shown of it is then what will be, to the last bit.
    const auto shown = [&](Id id, const DrawnContour& stored) -> const DrawnContour& {
        if (draft_ && draft_->id == id) return *draft_;
        const auto found =
            std::find_if(carried_.begin(), carried_.end(), [&](const DrawnContour& other) { return other.id == id; });
        return found == carried_.end() ? stored : *found;
    };
    for (const auto& [id, contour] : state.contours) add(shown(id, *contour));
    if (draft_ && !state.contours.contains(draft_->id)) add(*draft_);
    return task;
}

void Session::clear_draft() {
    if (!draft_) return;
    const std::set<Id> touched = drafted();
    draft_.reset();
    carried_.clear();
    for (const Id id : touched) follow(id);
}

std::set<Id> Session::drafted() const {
    std::set<Id> structures;
    if (draft_) structures.insert(draft_->structure);
    for (const DrawnContour& other : carried_) structures.insert(other.structure);
    return structures;
}

}  // namespace kontur::viewer
