// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/reviews.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "kontur/base/error.h"
#include "viewer/model/structure_rules.h"
#include "viewer/session/history.h"
#include "viewer/surfaces/mask_neighbors.h"

namespace kontur::viewer {
namespace {

bool is_locked(const Structure& structure) { return structure.attributes.review.locked; }
bool is_approved(const Structure& structure) { return structure.attributes.review.approved.has_value(); }

/// Whether one structure has another name after the step; rules that name it are written anew then, and say the same.
bool renames(const Commit& step) {
    return std::ranges::any_of(step.structures, [](const Change<Structure>& change) {
        return change.before && change.after && change.before->name != change.after->name;
    });
}

/// Whether both differ by more than their looks and what reviewers say.
bool is_edited(const Structure& before, const Structure& after, bool with_rule) {
    Structure same = after;
    same.color = before.color;
    same.visible = before.visible;
    same.attributes.review = before.attributes.review;
    if (!with_rule) same.rule = before.rule;
    if (same.mask && before.mask) same.mask->kept = before.mask->kept;  // goes along with the lock
    return same != before;
}

bool is_edited(const DrawnContour& before, const DrawnContour& after, const Structure& owner) {
    DrawnContour same = after;
    if (counts(before, owner) == counts(after, owner)) same.visible = before.visible;
    return same != before;
}

/// Masks to be corrected that may follow this one.
std::set<Id> masks_beside(const State& state, Id structure) {
    std::set<Id> found;
    const auto own = state.structures.find(structure);
    const auto mask = own == state.structures.end() ? nullptr : mask_of(state, own->second);
    if (!mask) return found;
    for (const auto& [id, other] : state.structures)
        if (const auto its = mask_of(state, other);
            its && id != structure && other.mask->kept.empty() && boxes_touch(*mask, *its))
            found.insert(id);
    return found;
}

/// It is made anew for its lock alone, and stays as it is.
bool is_locked_as_it_is(const Change<Structure>& change) {
    const auto& [id, before, after] = change;
    return before && after && before->mask && after->mask && !after->mask->kept.empty() && !is_edited(*before, *after, true);
}

bool draws_in(const Commit& step, Id structure) {
    return std::ranges::any_of(step.contours, [&](const Change<DrawnContour>& change) {
        return (change.before && change.before->structure == structure) ||
               (change.after && change.after->structure == structure);
    });
}

/// Structures that have another body after the step, or another name.
std::set<Id> changed_by(const SessionState& s, const Commit& step, const std::set<Id>& touched) {
    const State& state = s.project.state();
    std::set<Id> changed;
    if (renames(step)) {
        for (const auto& change : step.structures)
            if (change.before && change.after && change.before->name != change.after->name) changed.insert(change.id);
        return changed;
    }
    changed = touched;
    for (const auto& change : step.structures)
        if (is_locked_as_it_is(change) && !draws_in(step, change.id)) changed.erase(change.id);
    if (step.borders)
        for (const auto& [id, structure] : state.structures) changed.insert(id);
    if (state.borders.shared)
        for (const BorderPair& pair : s.surfaces.border_pairs()) {
            if (touched.contains(pair.first)) changed.insert(pair.second);
            if (touched.contains(pair.second)) changed.insert(pair.first);
        }
    if (state.borders.shared)
        for (const Id id : touched)
            for (const Id neighbor : masks_beside(state, id)) changed.insert(neighbor);
    for (const Id id : std::set<Id>(changed))
        for (const Id user : users_of(state, id)) changed.insert(user);
    return changed;
}

/// What the step makes of the structure so far; null where it removes it.
Structure* after_of(Commit& step, const Structure& now) {
    const auto own = std::ranges::find(step.structures, now.id, &Change<Structure>::id);
    if (own == step.structures.end()) {
        step.structures.push_back({now.id, now, now});
        return &*step.structures.back().after;
    }
    return own->after ? &*own->after : nullptr;
}

}  // namespace

void check_is_unlocked(const Structure& structure) {
    if (is_locked(structure))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} is locked, and stays as it is; unlock it in the list to change it", structure.name));
}

void check_is_unlocked(const State& state, const Commit& step) {
    const bool with_rules = !renames(step);
    for (const auto& change : step.structures)
        if (change.before && is_locked(*change.before) &&
            (!change.after || is_edited(*change.before, *change.after, with_rules)))
            check_is_unlocked(*change.before);
    for (const auto& change : step.contours)
        for (const auto& side : {change.before, change.after}) {
            if (!side) continue;
            const auto owner = state.structures.find(side->structure);
            if (owner == state.structures.end() || !is_locked(owner->second)) continue;
            if (!change.before || !change.after || is_edited(*change.before, *change.after, owner->second))
                check_is_unlocked(owner->second);
        }
}

ReviewedStep without_approvals(const SessionState& s, const Commit& step, const std::set<Id>& touched) {
    ReviewedStep reviewed{step};
    const auto& structures = s.project.state().structures;
    if (std::ranges::none_of(structures, [](const auto& one) { return is_approved(one.second); })) return reviewed;
    for (const Id id : changed_by(s, step, touched)) {
        const auto now = structures.find(id);
        if (now == structures.end() || !is_approved(now->second)) continue;
        Structure* const after = after_of(reviewed.step, now->second);
        if (!after || !is_approved(*after)) continue;
        after->attributes.review.approved.reset();
        reviewed.taken_back.push_back(fmt::format("{} has changed, so the approval by {} is taken back; undo restores both",
                                                  after->name, now->second.attributes.review.approved->by));
    }
    return reviewed;
}

void take_approvals_back(SessionState& s, const std::vector<BorderPair>& pairs) {
    const std::scoped_lock lock(s.mutex);
    const std::set<Id> edited = std::exchange(s.edited_since_borders, {});
    const std::vector<BorderPair> known = std::exchange(s.border_pairs, pairs);
    const State& state = s.project.state();
    Commit step;
    std::vector<std::string> sentences;
    const auto take_back = [&](Id id, Id neighbor) {
        const auto own = state.structures.find(id), other = state.structures.find(neighbor);
        if (own == state.structures.end() || other == state.structures.end() || !is_approved(own->second)) return;
        Structure* const after = after_of(step, own->second);
        if (!is_approved(*after)) return;
        after->attributes.review.approved.reset();
        step.label = "Take the approval of " + after->name + " back";
        sentences.push_back(
            fmt::format("{} shares a border with {} now, which was edited, so the approval by {} is taken back", after->name,
                        other->second.name, own->second.attributes.review.approved->by));
    };
    for (const BorderPair& pair : pairs) {
        const auto is_pair = [&](const BorderPair& one) { return one.first == pair.first && one.second == pair.second; };
        if (std::ranges::any_of(known, is_pair)) continue;  // the edit itself took the approval back
        if (edited.contains(pair.first)) take_back(pair.second, pair.first);
        if (edited.contains(pair.second)) take_back(pair.first, pair.second);
    }
    if (step.structures.empty()) return;
    s.project.commit(step);
    tell_changes(s, step);
    for (const std::string& sentence : sentences) s.pages.notice("warning", sentence);
}

}  // namespace kontur::viewer
