// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <ctime>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "viewer/model/model_json.h"
#include "viewer/model/names.h"
#include "viewer/model/status_line.h"
#include "viewer/session/calls.h"
#include "viewer/session/history.h"

// Structures locked, approved, commented.

namespace kontur::viewer {
namespace {

using nlohmann::json;

std::string local_time_now() {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    char text[sizeof "2026-11-30T21:02:43"];
    return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &local)};
}

/// What is said now of who approves; "" takes an approval back.
void set_approval(const State& state, Structure& structure, const std::string& by) {
    check_name(by);
    structure.attributes.review.approved.reset();
    if (by.empty()) return;
    if (!has_content(state, structure.id))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} has 0 contours; at least 1 is needed to approve it", structure.name));
    structure.attributes.review.approved = Approval{by, local_time_now()};
}

std::string label_of(const Review& before, const Review& after, const std::string& name) {
    if (before.approved != after.approved)
        return after.approved ? "Approve " + name : "Take the approval of " + name + " back";
    if (before.locked != after.locked) return (after.locked ? "Lock " : "Unlock ") + name;
    return "Comment on " + name;
}

std::uint64_t steps_of(const SessionState& s) {
    const std::scoped_lock lock(s.mutex);
    return s.steps;
}

/// What a mask to be corrected is just now, after its neighbours; null where it cannot be said, or nothing is left of it.
std::shared_ptr<const StoredMask> mask_as_it_is(SessionState& s, const State& now, const Structure& structure) {
    const StatusLine line(s.pages.status_teller(), "Locking " + structure.name);
    try {
        return std::make_shared<const StoredMask>(
            s.fits.one(now, structure.id, line.work({}), {.mesh = false})->corrected->mask);
    } catch (const Error&) {
        return nullptr;
    }
}

/// A locked mask keeps what it is.
std::shared_ptr<const StoredMask> mask_to_keep(SessionState& s, const State& now, const Members& m) {
    const Structure structure = s.present_structure(now, m.id("id"));
    const bool locks = m.flag_or("locked", false) && !structure.attributes.review.locked;
    return locks && structure.mask ? mask_as_it_is(s, now, structure) : nullptr;
}

json set_review(SessionState& s, const Members& m) {
    const std::uint64_t step_before = steps_of(s);
    const std::shared_ptr<const StoredMask> kept = mask_to_keep(s, s.state(), m);
    const std::scoped_lock lock(s.mutex);
    if (kept && s.steps != step_before)
        throw Error(ErrorKind::invalid_input, "something has been changed meanwhile; lock it once more");
    const Structure before = structure_of(s.project.state(), m.id("id"));
    Structure after = before;
    Review& review = after.attributes.review;
    review.locked = m.flag_or("locked", review.locked);
    if (after.mask && review.locked != before.attributes.review.locked) after.mask->kept = kept ? kept->hash() : "";
    if (m.has("comment")) review.comment = m.text("comment", kMostCommentBytes);
    if (m.has("approved_by")) set_approval(s.project.state(), after, m.text("approved_by", kMostNameBytes));
    Commit step{label_of(before.attributes.review, review, after.name), {{after.id, before, after}}, {}};
    if (kept) step.masks.push_back(kept);
    if (after != before) commit(s, step);
    return {{"structure", to_json(after)}};
}

}  // namespace

Calls review_calls() { return {{"structure.review", {set_review, false}}}; }

}  // namespace kontur::viewer
