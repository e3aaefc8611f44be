// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <utility>

#include "kontur/base/error.h"
#include "viewer/surfaces/corrected_mask.h"
#include "viewer/surfaces/surfaces.h"

// Surfaces of masks to be corrected. They share no borders.

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
    try {
        begin_mask_editor(follower, structure, task.mask);
    } catch (const std::exception& error) {
        Surface none;
        none.structure = structure;
        none.warnings = {fmt::format(
            "There is no surface until the next edit: no thread to compute it could be started ({}).", error.what())};
        return publish_locked(std::move(none));
    }
    follower.last_edit = follower.edits_before + follower.mask_editor->edit(corrections_of(task.set, task.how),
                                                                            correct_options(task.how), image_, task.step);
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
    if (!is_newest || update.asks_image) return;
    finish_locked(follower, task);
    // A project may hold many masks, and most of them are only looked at: each editor is a thread.
    if (says_nothing(corrections_of(task.set, task.how))) retired_.push_back(std::move(follower.mask_editor));
    if ((borders_.shared || sharing_thread_.joinable()) && !is_busy_locked()) ask_to_share_locked();
}

}  // namespace kontur::viewer
