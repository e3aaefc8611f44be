// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <utility>

#include "kontur/base/error.h"
#include "viewer/surfaces/corrected_mask.h"
#include "viewer/surfaces/surfaces.h"

// Surfaces of masks to be corrected.

namespace kontur::viewer {
namespace {

Surface surface_of(const SurfaceTask& task, const MaskUpdate& update) {
    Surface surface;
    surface.structure = task.structure;
    if (update.kind == MaskUpdate::Kind::problem) surface.warnings.push_back(update.problem);
    if (!update.result) return surface;
    surface.corrected = update.result;
    const CorrectReport& report = update.result->report;
    surface.warnings.insert(surface.warnings.end(), report.warnings.begin(), report.warnings.end());
    surface.volume_ml = report.volume_ml;
    surface.drawn = std::make_shared<const ContourSet>(task.set);
    if (update.result->mesh->triangles.empty()) {
        surface.warnings.push_back("The corrections leave nothing of the mask.");
        return surface;
    }
    surface.mesh = update.result->mesh;
    surface.stage = update.asks_image ? SurfaceStage::asking : SurfaceStage::finished;
    return surface;
}

}  // namespace

void Surfaces::begin_mask_editor(Follower& follower, Id structure, const std::shared_ptr<const StoredMask>& mask) {
    if (follower.mask_editor && follower.mask_editor->mask() == mask) return;
    if (follower.mask_editor) retired_.push_back(std::move(follower.mask_editor));
    const std::uint64_t before = follower.edits_before = follower.last_edit;
    follower.mask_editor = std::make_shared<MaskEditor>(
        mask, [this, structure, before](const MaskUpdate& update) { hear_mask(structure, before + update.edit, update); });
}

void Surfaces::start_mask(Follower& follower, SurfaceTask task) {
    const Id structure = task.structure;
    if (borders_.shared && !follower.others) follower.others.emplace();
    try {
        begin_mask_editor(follower, structure, task.mask);
    } catch (const std::exception& error) {
        Surface none;
        none.structure = structure;
        none.warnings = {fmt::format(
            "There is no surface until the next edit: no thread to compute it could be started ({}).", error.what())};
        return publish_locked(std::move(none));
    }
    follower.last_edit =
        follower.edits_before + follower.mask_editor->edit(corrections_of(task.set, task.how), correct_options(task.how),
                                                           image_, task.step, {follower.others, task.kept});
    follower.is_working = true;
    follower.tasks[follower.last_edit] = std::move(task);
}

void Surfaces::check_correction(Id structure, const std::shared_ptr<const StoredMask>& mask, ContourSet plane) {
    std::shared_ptr<MaskEditor> editor;
    {
        const std::scoped_lock lock(mutex_);
        Follower& follower = followers_[structure];
        begin_mask_editor(follower, structure, mask);
        editor = follower.mask_editor;
    }
    const std::string named = fmt::format("contour {} ", plane.contours.size());
    try {
        editor->check({std::move(plane), {}});
    } catch (const Error& error) {
        const std::string sentence = error.what();
        if (error.kind() != ErrorKind::invalid_input || !sentence.starts_with(named)) throw;
        throw Error(error.kind(), "The line " + sentence.substr(named.size()));
    }
}

void Surfaces::hear_mask(Id structure, std::uint64_t edit, const MaskUpdate& update) {
    SurfaceTask task;
    {
        const std::scoped_lock lock(mutex_);
        Follower& follower = followers_[structure];
        if (edit <= follower.edits_before) return;
        auto& tasks = follower.tasks;
        if (update.kind == MaskUpdate::Kind::progress) {
            const int tenths = static_cast<int>(10 * update.done);
            if (std::exchange(follower.tenths, tenths) == tenths) return;
        } else {
            tasks.erase(tasks.begin(), tasks.lower_bound(edit));
        }
        task = tasks.at(edit);
    }
    if (update.kind == MaskUpdate::Kind::progress)
        return listener_.status(fmt::format("{}: correcting", task.set.name), update.done);
    Surface surface = surface_of(task, update);
    if (surface.mesh) {
        surface.revision = next_revision();
        listener_.outlines(structure, surface.revision, cutters(surface));
    }
    const std::scoped_lock lock(mutex_);
    Follower& follower = followers_[structure];
    const bool is_newest = follower.tasks.size() == 1 && !follower.is_outdated;
    if (!is_newest && has_full_resolution(surface.stage)) surface.stage = SurfaceStage::preview;
    publish_locked(std::move(surface));
    const bool is_finished = is_newest && !update.asks_image;
    if (is_finished) finish_locked(follower, task);
    pass_on_locked(follower, update);
    if (!is_finished || follower.is_working) return;
    // A project may hold many masks, and most of them are only looked at: each editor is a thread.
    const bool follows_others = follower.others && !follower.others->empty();
    if (says_nothing(corrections_of(task.set, task.how)) && !follows_others)
        retired_.push_back(std::move(follower.mask_editor));
    if ((borders_.shared || sharing_thread_.joinable()) && !is_busy_locked()) ask_to_share_locked();
}

/// Only what is final, and only what is new: two masks that follow each other would go on for ever.
void Surfaces::pass_on_locked(Follower& follower, const MaskUpdate& update) {
    if (update.kind != MaskUpdate::Kind::corrected || update.asks_image || !borders_.shared) return;
    const auto& exchange = update.result->exchange;
    if (!exchange || (follower.exchange && *follower.exchange == *exchange)) return;
    follower.exchange = exchange;
    let_masks_follow_locked();
}

const StoredMask* Surfaces::mask_of_locked(Id structure) const {
    const auto found = followers_.find(structure);
    if (found == followers_.end() || found->second.tasks.empty()) return nullptr;
    return found->second.tasks.rbegin()->second.mask.get();
}

/// By a rule, or as the masks lie.
bool Surfaces::may_share_locked(Id a, Id b) {
    const StoredMask *first = mask_of_locked(a), *second = mask_of_locked(b);
    if (const BorderRule* rule = borders_.rule_about(a, b)) return may_share(rule, *first, *second);
    const auto [known, is_new] = masks_that_may_share_.try_emplace(std::minmax(first->hash(), second->hash()), false);
    if (is_new) known->second = may_share(*first, *second);
    return known->second;
}

/// Those whose corrections change anything of the mask, or that keep what it could take.
MaskExchanges Surfaces::others_of_locked(Id structure) {
    const StoredMask& own = *mask_of_locked(structure);
    MaskExchanges others;
    if (followers_.at(structure).tasks.rbegin()->second.kept) return others;
    for (const auto& [id, other] : followers_) {
        const StoredMask* its = id != structure && other.exchange ? mask_of_locked(id) : nullptr;
        if (!its || its->grid() != own.grid()) continue;
        if (!other.exchange->kept && followed_voxels(own, {other.exchange}).empty()) continue;
        if (may_share_locked(structure, id)) others.push_back(other.exchange);
    }
    return others;
}

/// Each mask whose neighbours have other corrections now is made anew. It follows these alone, so that this comes to an end.
void Surfaces::let_masks_follow_locked() {
    for (auto& [id, follower] : followers_) {
        if (!mask_of_locked(id)) continue;
        std::optional<MaskExchanges> others;
        if (borders_.shared) others = others_of_locked(id);
        if (others == follower.others) continue;
        const bool is_other = others.value_or(MaskExchanges{}) != follower.others.value_or(MaskExchanges{});
        const bool has_own = follower.exchange || !says_nothing(corrections_of(follower.tasks.rbegin()->second.set,
                                                                               follower.tasks.rbegin()->second.how));
        follower.others = std::move(others);
        if (!borders_.shared) follower.exchange.reset();
        if (!is_other && !has_own) continue;
        const bool waits = follower.is_outdated;
        start(SurfaceTask(follower.tasks.rbegin()->second));
        follower.is_outdated = waits;  // there will be another task, too
    }
}

/// It is none any more.
void Surfaces::forget_mask_locked(Follower& follower) {
    if (follower.tasks.empty() || !follower.tasks.rbegin()->second.mask) return;
    follower.tasks.clear();
    follower.others.reset();
    if (std::exchange(follower.exchange, nullptr)) let_masks_follow_locked();
}

}  // namespace kontur::viewer
