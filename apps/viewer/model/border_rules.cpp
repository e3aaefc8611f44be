// SPDX-License-Identifier: Apache-2.0
#include "viewer/model/border_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "viewer/model/model_json.h"

namespace kontur::viewer {

const BorderRule* Borders::rule_about(Id a, Id b) const {
    const auto found = std::find_if(rules.begin(), rules.end(), [&](const BorderRule& rule) { return rule.is_about(a, b); });
    return found == rules.end() ? nullptr : &*found;
}

void Borders::set(const BorderRule& rule) {
    forget(rule.first, rule.second);
    rules.push_back(rule);
}

void Borders::forget(Id a, Id b) {
    std::erase_if(rules, [&](const BorderRule& rule) { return rule.is_about(a, b); });
}

std::vector<StructurePair> rules_among(const Borders& borders, const std::vector<Id>& structures) {
    const auto place = [&](Id id) { return std::find(structures.begin(), structures.end(), id) - structures.begin(); };
    const auto count = static_cast<std::ptrdiff_t>(structures.size());
    std::vector<StructurePair> pairs;
    for (const BorderRule& rule : borders.rules) {
        const std::ptrdiff_t first = place(rule.first), second = place(rule.second);
        if (first == count || second == count) continue;
        pairs.push_back({static_cast<std::size_t>(first), static_cast<std::size_t>(second), rule.relation, 0, true});
    }
    return pairs;
}

nlohmann::json to_json(const Borders& borders) {
    nlohmann::json rules = nlohmann::json::array();
    for (const BorderRule& rule : borders.rules)
        rules.push_back(
            {{"first", rule.first}, {"second", rule.second}, {"relation", std::string(kontur::name(rule.relation))}});
    return {{"shared", borders.shared}, {"rules", std::move(rules)}};
}

Borders borders_from_json(const nlohmann::json& value) {
    constexpr std::size_t kMostRules = 10'000;
    const Members m(value);
    Borders borders{m.flag("shared")};
    const nlohmann::json& rules = m.at("rules");
    if (!rules.is_array() || rules.size() > kMostRules)
        throw Error(ErrorKind::invalid_input, fmt::format("'rules' is no array of at most {} rules", kMostRules));
    for (const nlohmann::json& item : rules) {
        const Members rule(item);
        borders.set({rule.id("first"), rule.id("second"), relation_named(rule.text("relation", 16))});
    }
    return borders;
}

Relation relation_named(std::string_view word) {
    for (const Relation relation : {Relation::exclusive, Relation::inside, Relation::overlap})
        if (word == kontur::name(relation)) return relation;
    throw Error(ErrorKind::invalid_input, fmt::format("'relation' is {}; it must be exclusive, inside or overlap", word));
}

}  // namespace kontur::viewer
