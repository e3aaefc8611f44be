// SPDX-License-Identifier: Apache-2.0
#include "viewer/model/structure_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "kontur/base/error.h"
#include "kontur/derive/derive.h"

namespace kontur::viewer {
namespace {

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::invalid_input, message); }

/// Each once.
std::vector<std::string> names_in(const std::string& rule) { return sources_of(std::array{rule}); }

bool uses(const Structure& structure, const std::string& name) {
    return structure.rule && std::ranges::count(names_in(*structure.rule), name) > 0;
}

const Structure& the_one(const State& state, const std::string& name, const std::string& rule) {
    const Structure* found = nullptr;
    for (const auto& [id, one] : state.structures) {
        if (one.name != name) continue;
        if (found) refuse(fmt::format("{}: 2 structures are named {}; rename one of them", rule, name));
        found = &one;
    }
    if (!found) refuse(fmt::format("{}: there is no structure named {}", rule, name));
    return *found;
}

void check_frame(const State& state, const Structure& structure, const std::string& rule) {
    const std::set<int> times = drawn_times(state, structure.id);
    if (structure.mask || times.empty() || times == std::set{state.opened_time}) return;
    throw Error(
        ErrorKind::unsupported,
        fmt::format("{}: {} was drawn in {}; rules take what was drawn in frame {}, which was opened", rule, structure.name,
                    times.size() > 1 ? "several frames" : fmt::format("frame {}", *times.begin() + 1),
                    state.opened_time + 1));
}

}  // namespace

void RuleMembers::add(const RuleMembers& others) {
    for (std::size_t n = 0; n < others.derived.size(); ++n)
        if (std::ranges::count(derived, others.derived[n]) == 0) {
            derived.push_back(others.derived[n]);
            rules.push_back(others.rules[n]);
        }
    drawn.insert(others.drawn.begin(), others.drawn.end());
}

RuleMembers members_of(const State& state, Id structure) {
    const Structure& first = structure_of(state, structure);
    RuleMembers members{{structure}, {*first.rule}};
    for (std::size_t n = 0; n < members.rules.size(); ++n) {
        const std::string rule = members.rules[n];
        for (const std::string& name : names_in(rule)) {
            const Structure& source = the_one(state, name, rule);
            if (!source.rule) {
                check_frame(state, source, rule);
                members.drawn[name] = source.id;
            } else if (std::ranges::count(members.derived, source.id) == 0) {
                members.derived.push_back(source.id);
                members.rules.push_back(*source.rule);
            }
        }
    }
    return members;
}

std::vector<Id> users_of(const State& state, Id structure) {
    std::set<Id> users;
    std::vector<Id> known{structure};
    for (std::size_t n = 0; n < known.size(); ++n) {
        const auto named = state.structures.find(known[n]);
        if (named == state.structures.end()) continue;
        for (const auto& [id, one] : state.structures)
            if (uses(one, named->second.name) && users.insert(id).second) known.push_back(id);
    }
    users.erase(structure);
    return {users.begin(), users.end()};
}

void check_is_unused(const State& state, const Structure& structure) {
    for (const auto& [id, one] : state.structures)
        if (id != structure.id && uses(one, structure.name))
            refuse(fmt::format("{} is used by the rule {}; freeze or delete {} first", structure.name, *one.rule, one.name));
}

void check_name_is_free(const State& state, const std::string& name) {
    for (const auto& [id, one] : state.structures)
        if (one.rule && (one.name == name || uses(one, name)))
            refuse(fmt::format("{} is a name in the rule {}; give this structure another one", name, *one.rule));
}

}  // namespace kontur::viewer
