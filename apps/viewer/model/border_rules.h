// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string_view>
#include <vector>

#include "kontur/labels/structure_pair.h"

namespace kontur::viewer {

/// Of a structure or contour; never used twice in one project.
using Id = std::int64_t;

/// How two structures lie to each other, as the user says.
struct BorderRule {
    Id first = 0, second = 0;  ///< of `inside` the first lies in the second
    Relation relation = Relation::exclusive;

    bool is_about(Id a, Id b) const { return (first == a && second == b) || (first == b && second == a); }
    friend bool operator==(const BorderRule&, const BorderRule&) = default;
};

/// Whether the structures of a project share borders, and the rules that differ from what their surfaces say. Rules about
/// structures that are gone stay, for undo, and count for nothing.
struct Borders {
    bool shared = false;
    std::vector<BorderRule> rules{};

    const BorderRule* rule_about(Id a, Id b) const;
    /// The rule takes the place of the one about the same pair.
    void set(const BorderRule& rule);
    void forget(Id a, Id b);
    friend bool operator==(const Borders&, const Borders&) = default;
};

/// The rules about two of these, which they then count from 0.
std::vector<StructurePair> rules_among(const Borders& borders, const std::vector<Id>& structures);

nlohmann::json to_json(const Borders& borders);
/// Throws Error(invalid_input) for what is no such object, and for more than 10,000 rules.
Borders borders_from_json(const nlohmann::json& value);

/// "exclusive", "inside" or "overlap"; throws Error(invalid_input) for another word.
Relation relation_named(std::string_view word);

}  // namespace kontur::viewer
