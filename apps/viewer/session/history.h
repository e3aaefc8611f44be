// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <set>

#include "viewer/session/session_state.h"

// Steps of the history, the draft of the moving hand, and the surfaces that follow both. Whoever calls these holds the
// state's mutex.

namespace kontur::viewer {

/// Stores the step, in place of the draft, and tells pages; the surfaces it touches are computed anew. Throws as
/// Project::commit.
void commit(SessionState& s, const Commit& step);
/// The same for a step that makes or changes one contour: its surface is computed while the disk is written.
void commit_ahead(SessionState& s, const Commit& step);
/// Tells pages of a step that the project holds.
void tell_changes(SessionState& s, const Commit& step);

/// For a new structure: one that few others have.
std::string next_color(const State& state);

/// Throws Error(invalid_input) for a structure that a rule makes: it cannot be drawn in.
void check_is_drawn(const State& state, Id structure);

/// The contours that the structure's surface is made of, the draft in its contour's place.
SurfaceTask surface_task(SessionState& s, Id structure);
/// The structure's surface is computed anew.
void follow(SessionState& s, Id structure);

void clear_draft(SessionState& s);
/// The structures that the draft is of.
std::set<Id> drafted(const SessionState& s);

/// Labels of what undo and redo would do.
nlohmann::json history_json(SessionState& s);

}  // namespace kontur::viewer
