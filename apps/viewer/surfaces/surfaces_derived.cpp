// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "viewer/surfaces/surfaces.h"

// Structures that rules make of others.

namespace kontur::viewer {

void Surfaces::start_rule(Follower& follower, RuleTask task) {
    if (follower.editor) retired_.push_back(std::move(follower.editor));
    if (follower.mask_editor) retired_.push_back(std::move(follower.mask_editor));
    follower.edits_before = follower.last_edit;
    follower.tasks.clear();
    follower.is_working = false;
    alone_.erase(task.members.derived.front());
    derivations_.follow(std::move(task));
}

/// From the thread that works rules out.
void Surfaces::publish_derived(Surface surface) {
    const Id structure = surface.structure;
    if (surface.mesh && surface.revision == 0) {
        surface.revision = next_revision();
        listener_.outlines(structure, surface.revision, cutters(surface));
    }
    const std::scoped_lock lock(mutex_);
    if (!derivations_.makes(structure)) return;  // it was frozen or removed meanwhile
    publish_locked(std::move(surface));
}

void Surfaces::show_derivation(std::optional<double> done) { listener_.status(done ? "Following rules" : "", done); }

}  // namespace kontur::viewer
