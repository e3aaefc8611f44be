// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "viewer/session/session_state.h"

// What reviewers say of structures: locked ones are not changed, and a change takes an approval back. Whoever calls these
// holds the state's mutex, unless they lock it.

namespace kontur::viewer {

/// Throws Error(invalid_input) for a locked structure.
void check_is_unlocked(const Structure& structure);

/// The same for a step that changes a locked structure: its lines, points, mask, rule, fit or name, not how it looks. What
/// follows other structures still follows them.
void check_is_unlocked(const State& state, const Commit& step);

/// A step, and whose approvals it takes back.
struct ReviewedStep {
    Commit step;
    std::vector<std::string> taken_back{};  ///< one sentence each
};

/// The step, after which nothing is approved that it changes, or that follows what it changes by a rule or a shared border.
/// `touched`: structures whose surfaces are made anew.
ReviewedStep without_approvals(const SessionState& s, const Commit& step, const std::set<Id>& touched);

/// Takes back, in a step of its own, the approvals of structures that touch one for the first time that was edited since
/// borders were last found: as that step was made, nobody knew. Throws as Project::commit. Locks the state.
void take_approvals_back(SessionState& s, const std::vector<BorderPair>& pairs);

}  // namespace kontur::viewer
