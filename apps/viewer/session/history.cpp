// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/history.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "viewer/model/model_json.h"
#include "viewer/model/structure_rules.h"
#include "viewer/session/calls.h"
#include "viewer/session/events.h"
#include "viewer/session/moving_task.h"
#include "viewer/session/page_json.h"
#include "viewer/session/reviews.h"

// Steps of the history, the draft of the moving hand, and the surfaces that follow both.

namespace kontur::viewer {
namespace {

using nlohmann::json;

template <class Row>
json changes_json(const std::vector<Change<Row>>& changes) {
    json set = json::array(), removed = json::array();
    PageJson page_json;
    for (const Change<Row>& change : changes) {
        if (change.after) set.push_back(page_json(*change.after));
        else removed.push_back(change.id);
    }
    return {{"set", std::move(set)}, {"removed", std::move(removed)}};
}

/// Whether both ask the same of the surface.
bool same_surface(const Structure& a, const Structure& b) {
    return a.empty_planes == b.empty_planes && a.smoothing == b.smoothing && a.surface_points == b.surface_points &&
           a.interior == b.interior && a.exterior == b.exterior && a.mask == b.mask && a.rule == b.rule;
}

bool same_surface(const DrawnContour& a, const DrawnContour& b) {
    return a.points == b.points && a.plane == b.plane && a.hole == b.hole && a.structure == b.structure &&
           a.closed == b.closed && a.inside == b.inside && a.end == b.end && a.weight == b.weight && a.time == b.time;
}

/// What rules make of structures that came, went, or are made or named otherwise now.
void add_users(const State& state, const Commit& step, std::set<Id>& touched) {
    for (const auto& change : step.structures) {
        if (change.before && change.after && change.before->name == change.after->name &&
            change.before->rule == change.after->rule)
            continue;
        for (const Id user : users_of(state, change.id)) touched.insert(user);
    }
}

/// Rules make a structure wholly, or it is drawn.
void check_is_drawn(const State& state, const Commit& step) {
    for (const auto& change : step.contours)
        for (const auto& side : {change.before, change.after})
            if (side) check_is_drawn(state, side->structure);
    for (const auto& change : step.structures) {
        if (!change.before || !change.after || !change.before->rule || !change.after->rule) continue;
        Structure same = *change.after;
        same.rule = change.before->rule;
        if (!same_surface(*change.before, same)) check_is_drawn(state, change.id);
    }
}

std::set<Id> touched_surfaces(const SessionState& s, const Commit& step) {
    std::set<Id> touched;
    if (step.use_image)
        for (const auto& [id, structure] : s.project.state().structures) touched.insert(id);
    if (step.cycle)
        for (const auto& [id, structure] : s.project.state().structures)
            if (is_moving(s.project.state(), id)) touched.insert(id);
    for (const auto& change : step.structures)
        if (!change.before || !change.after || !same_surface(*change.before, *change.after)) touched.insert(change.id);
    for (const auto& change : step.contours) {
        if (change.before && change.after && same_surface(*change.before, *change.after)) continue;
        for (const auto& side : {change.before, change.after})
            if (side) touched.insert(side->structure);
    }
    for (const auto& change : step.contours) {  // of a mask, a hidden correction is none
        if (!change.before || !change.after || change.before->visible == change.after->visible) continue;
        const auto& structures = s.project.state().structures;
        const auto own = structures.find(change.after->structure);
        if (own != structures.end() && own->second.mask) touched.insert(own->first);
    }
    add_users(s.project.state(), step, touched);
    return touched;
}

/// Of a step that touches all, one after the other.
void follow_touched(SessionState& s, const Commit& step, const std::set<Id>& touched) {
    for (const Id id : touched) {
        if (step.use_image) s.surfaces.follow_later(surface_task(s, id));
        else follow(s, id);
    }
}

void announce(SessionState& s, const Commit& step) {
    const std::set<Id> touched = touched_surfaces(s, step);
    s.surfaces.outdate(touched);
    s.edited_since_borders.insert(touched.begin(), touched.end());
    tell_changes(s, step);
    follow_touched(s, step, touched);
}

RuleTask rule_task(const SessionState& s, Id structure) {
    RuleTask task{{{structure}, {}}, s.image.voxels};
    try {
        task.members = members_of(s.project.state(), structure);
    } catch (const Error& error) {
        task.problem = error.what();
    }
    return task;
}

json step_reply(SessionState& s, const std::optional<Commit>& step) {
    if (!step) return {{"label", nullptr}};
    announce(s, *step);
    return {{"label", step->label}};
}

json drop_draft(SessionState& s, const Members&) {
    clear_draft(s);
    return json::object();
}

json undo(SessionState& s, const Members&) {
    clear_draft(s);
    return step_reply(s, s.project.undo());
}

json redo(SessionState& s, const Members&) {
    clear_draft(s);
    return step_reply(s, s.project.redo());
}

}  // namespace

Calls history_calls() { return {{"draft.drop", {drop_draft}}, {"undo", {undo}}, {"redo", {redo}}}; }

void follow(SessionState& s, Id structure) { s.surfaces.follow(surface_task(s, structure)); }

void commit(SessionState& s, const Commit& given) {
    check_is_drawn(s.project.state(), given);
    check_is_unlocked(s.project.state(), given);
    std::set<Id> touched = touched_surfaces(s, given);
    const auto [step, taken_back] = without_approvals(s, given, touched);
    touched.merge(drafted(s));
    s.draft.reset();
    try {
        if (!step.is_empty()) s.project.commit(step);
    } catch (...) {
        for (const Id id : touched) follow(s, id);
        throw;
    }
    s.surfaces.outdate(touched);
    s.edited_since_borders.insert(touched.begin(), touched.end());
    if (!step.is_empty()) tell_changes(s, step);
    for (const std::string& sentence : taken_back) s.pages.notice("warning", sentence);
    follow_touched(s, step, touched);
}

void commit_ahead(SessionState& s, const Commit& step) {
    check_is_drawn(s.project.state(), step);
    check_is_unlocked(s.project.state(), step);
    const DrawnContour& contour = *step.contours.front().after;
    const bool stays = !step.contours.front().before || step.contours.front().before->structure == contour.structure;
    const bool is_other_draft =
        s.draft && (s.draft->contour.id != contour.id || s.draft->contour.structure != contour.structure);
    const bool is_reviewed = !without_approvals(s, step, {contour.structure}).taken_back.empty();
    if (!stays || is_other_draft || is_reviewed || step.contours.size() > 1 || (s.draft && !s.draft->carried.empty()))
        return commit(s, step);
    // What the hand released is most often what it showed last, and then its surface is here already, or on its way.
    const bool is_followed = s.draft ? same_surface(s.draft->contour, contour) : touched_surfaces(s, step).empty();
    s.draft = Draft{contour, {}, s.caller};
    s.edited_since_borders.insert(contour.structure);
    if (!is_followed) follow(s, contour.structure);
    try {
        s.project.commit(step);
    } catch (...) {
        clear_draft(s);
        throw;
    }
    s.draft.reset();
    tell_changes(s, step);
}

void tell_changes(SessionState& s, const Commit& step) {
    ++s.steps;
    s.pages.tell({{"event", "changed"},
                  {"structures", changes_json(step.structures)},
                  {"contours", changes_json(step.contours)},
                  {"history", history_json(s)},
                  {"borders", to_json(s.project.state().borders)},
                  {"use_image", use_image_json(s)},
                  {"cycle_frames", cycle_json(s)}});
    s.surfaces.use_image(image_for_fits(s));
    s.surfaces.share_borders(s.project.state().borders);
}

void check_is_drawn(const State& state, Id structure) {
    const Structure& chosen = structure_of(state, structure);
    if (chosen.rule)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} is made by the rule {}; change the rule, or freeze {} to draw in it", chosen.name,
                                *chosen.rule, chosen.name));
}

SurfaceTask surface_task(SessionState& s, Id structure) {
    SurfaceTask task;
    task.structure = structure;
    task.step = s.steps + (s.draft ? 1 : 0);
    const State& state = s.project.state();
    const auto own = state.structures.find(structure);
    if (own != state.structures.end()) {
        task.set = without_contours(own->second);
        if (own->second.rule) {
            task.rule = rule_task(s, structure);
            return task;
        }
        task.smoothing = own->second.smoothing;
        task.mask = mask_of(state, own->second);
        if (task.mask) task.how = *own->second.mask;
        task.kept = kept_mask_of(state, own->second);
    }
    std::vector<int> times;
    const auto add = [&](const DrawnContour& contour) {
        if (contour.structure != structure || (own != state.structures.end() && !counts(contour, own->second))) return;
        task.set.contours.push_back(as_contour(contour));
        task.ids.push_back(contour.id);
        times.push_back(time_of(state, contour));
    };
    // The draft in its contour's place: what is shown of it is then what will be, to the last bit.
    const auto current = [&](Id id, const DrawnContour& stored) -> const DrawnContour& {
        if (!s.draft) return stored;
        if (s.draft->contour.id == id) return s.draft->contour;
        const std::vector<DrawnContour>& carried = s.draft->carried;
        const auto found =
            std::find_if(carried.begin(), carried.end(), [&](const DrawnContour& other) { return other.id == id; });
        return found == carried.end() ? stored : *found;
    };
    for (const auto& [id, contour] : state.contours) add(current(id, *contour));
    if (s.draft && !state.contours.contains(s.draft->contour.id)) add(s.draft->contour);
    if (task.mask || times.empty()) return task;
    if (std::ranges::count(times, times.front()) < std::ssize(times)) turn_into_motion(task, times, s);
    else if (times.front() != state.opened_time) task.image = image_for_fits_at(s, times.front());
    return task;
}

void clear_draft(SessionState& s) {
    if (!s.draft) return;
    const std::set<Id> touched = drafted(s);
    s.draft.reset();
    for (const Id id : touched) follow(s, id);
}

std::set<Id> drafted(const SessionState& s) {
    if (!s.draft) return {};
    std::set<Id> structures{s.draft->contour.structure};
    for (const DrawnContour& other : s.draft->carried) structures.insert(other.structure);
    return structures;
}

json history_json(SessionState& s) {
    const auto label = [](const std::optional<std::string>& text) { return text ? json(*text) : json(nullptr); };
    return {{"undo", label(s.project.undo_label())}, {"redo", label(s.project.redo_label())}};
}

}  // namespace kontur::viewer
