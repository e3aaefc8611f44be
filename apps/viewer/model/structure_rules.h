// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "viewer/model/model.h"

// Structures that rules make of others. Rules name structures as the user does.

namespace kontur::viewer {

/// What takes part in making a structure.
struct RuleMembers {
    std::vector<Id> derived;            ///< it, and what its rule needs and other rules make
    std::vector<std::string> rules;     ///< that make these, in the same order
    std::map<std::string, Id> drawn{};  ///< what is needed besides, by name

    /// What takes part in making others, too, each once.
    void add(const RuleMembers& others);
};

/// Throws Error(invalid_input) for a name that no structure has or several have, and Error(unsupported) for structures that
/// were drawn in other frames than the opened one.
RuleMembers members_of(const State& state, Id structure);

/// Those whose rules name this one, or what rules make of it, in the order of ids.
std::vector<Id> users_of(const State& state, Id structure);

/// Throws Error(invalid_input) that says by which rule the structure is used, if it is.
void check_is_unused(const State& state, const Structure& structure);

/// Throws Error(invalid_input) where a rule makes or names a structure so: of two with one name it could not tell which.
void check_name_is_free(const State& state, const std::string& name);

}  // namespace kontur::viewer
